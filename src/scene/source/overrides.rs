//! The argument `--set KEY=VALUE`, which overrides a value of the scene file.

use ::toml::de::Error;

use super::{Entry, Name, Node, Table, Value, brackets, corrections, syntax, toml};
use crate::diagnostic::{Code, Diagnostic, SourceId, Sources, Span};

/// A value from the command line that overrides a value of the scene, such as `simulation.step=0.001`.
#[derive(Clone, Debug)]
pub struct Override(String);

impl Override {
    /// Makes an override from a command-line argument: a dotted key, `=`, and a TOML value or a string without quotes.
    pub fn new(argument: impl Into<String>) -> Override {
        Override(argument.into())
    }

    /// Returns the override as the user wrote it.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Returns true if the argument is a key and a value, whether or not a scene has this key.
    pub fn is_setting(&self) -> bool {
        self.parse(Sources::default().add("--set", "")).is_ok()
    }

    /// Sets the overriding value in the tree of the scene. Errors are added to `diagnostics`.
    pub(crate) fn apply(&self, root: &mut Table, sources: &mut Sources, diagnostics: &mut Vec<Diagnostic>) {
        let source = sources.add("--set", self.0.clone());
        match self.parse(source) {
            Ok((path, value)) => put(root, &path, value, diagnostics),
            Err(diagnostic) => diagnostics.push(diagnostic),
        }
    }

    fn parse(&self, source: SourceId) -> Result<(Vec<Name>, Node), Diagnostic> {
        let whole = Span::new(source, 0..self.0.len());
        let wrong = |message: &str| {
            Diagnostic::error(Code::BadSet, message)
                .at(whole, "")
                .help("write it as KEY=VALUE, as in simulation.step=0.001")
        };
        let (key, value) = self.0.split_once('=').ok_or_else(|| wrong("`--set` needs a `=`"))?;
        // With a line break or a second `=`, the text would not parse as a single key.
        let mut errors = Vec::new();
        let document = toml::parse(&format!("{key}=0"), source, &mut errors);
        let path = document.as_table().and_then(|table| path(table, Vec::new()));
        let path = match path {
            Some(path) if errors.is_empty() => path,
            _ => return Err(wrong(&format!("`{}` is not a key", key.trim()))),
        };
        let span = Span::new(source, key.len() + 1..self.0.len());
        let node = match toml::parse_value(value.trim(), source) {
            Ok((node, said)) => {
                let by = key.len() + 1 + (value.len() - value.trim_start().len());
                // The value of a number that is too large is lost in the tree, so the later check could not report it.
                if let Some(mut error) = said.into_iter().next() {
                    error.labels.iter_mut().for_each(|label| label.span = label.span.moved(by));
                    return Err(error);
                }
                moved(node, by)
            }
            // A value that begins with a bracket or a quote is faulty TOML, not a string.
            Err(error) if value.trim_start().starts_with(['[', '{', '"']) => {
                return Err(not_toml(&error, &self.0, key, source));
            }
            Err(_) => Node { span, value: Value::String(value.into()) },
        };
        Ok((path, node))
    }
}

/// Creates the error for the value of a `--set` argument that begins like TOML but is not valid TOML. Its fix is the corrected value, if the
/// intended one is clear. `key` is the text before the first `=`.
fn not_toml(error: &Error, argument: &str, key: &str, source: SourceId) -> Diagnostic {
    let value = &argument[key.len() + 1..];
    let text = value.trim();
    let by = key.len() + 1 + (value.len() - value.trim_start().len());
    let unclosed = brackets::look(argument, source).unclosed;
    let mut diagnostic = unclosed.unwrap_or_else(|| {
        let mut diagnostic = syntax::diagnose(error, text, source);
        diagnostic.labels.iter_mut().for_each(|label| label.span = label.span.moved(by));
        diagnostic
    });
    diagnostic.code = Code::BadSet;
    diagnostic.message = format!("the value is not valid TOML: {}", diagnostic.message);
    let cause = diagnostic.help.take().map_or(String::new(), |help| format!("{help}; "));
    let shell = "a shell may need the whole setting in quotes: --set 'a.b=[1, 2, 3]'";
    let diagnostic = diagnostic.help(format!("{cause}{shell}"));
    match corrected(key.trim(), text, source) {
        Some(better) => diagnostic.fix(Span::new(source, by..by + text.len()), better),
        None => diagnostic,
    }
}

/// Returns the corrected value of a key as valid TOML. `None` if the intended value is unclear.
fn corrected(key: &str, value: &str, source: SourceId) -> Option<String> {
    let line = corrections::correct(&format!("{key} = {value}"))?.text;
    let better = line.strip_prefix(key)?.strip_prefix(" = ")?;
    toml::parse_value(better, source).is_ok().then(|| better.to_owned())
}

/// Returns the keys that lead through nested tables to their only value. `None` if a table has more or fewer entries than one.
fn path(table: &Table, mut names: Vec<Name>) -> Option<Vec<Name>> {
    let [entry] = table.entries.as_slice() else { return None };
    names.push(entry.name.clone());
    match &entry.node.value {
        Value::Table(inner) => path(inner, names),
        _ => Some(names),
    }
}

/// Moves all source spans in a node by `by` bytes.
fn moved(mut node: Node, by: usize) -> Node {
    node.span = node.span.moved(by);
    node.value = match node.value {
        Value::Array(items) => Value::Array(items.into_iter().map(|item| moved(item, by)).collect()),
        Value::Table(table) => {
            let entry = |entry: Entry| Entry {
                name: Name { span: entry.name.span.moved(by), text: entry.name.text },
                node: moved(entry.node, by),
            };
            Value::Table(Table { entries: table.entries.into_iter().map(entry).collect() })
        }
        value => value,
    };
    node
}

fn put(table: &mut Table, path: &[Name], value: Node, diagnostics: &mut Vec<Diagnostic>) {
    let Some((name, rest)) = path.split_first() else { return };
    if table.get(&name.text).is_none() {
        let node = Node { span: value.span, value: Value::Table(Table::default()) };
        table.entries.push(Entry { name: name.clone(), node });
    }
    let Some(entry) = table.get_mut(&name.text) else { return };
    if rest.is_empty() {
        // The name is replaced as well, so that later errors refer to the `--set` argument.
        *entry = Entry { name: name.clone(), node: value };
        return;
    }
    match &mut entry.node.value {
        Value::Table(inner) => put(inner, rest, value, diagnostics),
        _ => diagnostics.push(
            Diagnostic::error(
                Code::BadSet,
                format!("`{}` is not a table, so nothing in it can be set", name.text),
            )
            .at(name.span, "")
            .at(entry.node.span, "it is a value here"),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Edit;

    fn set(text: &str, argument: &str) -> (Table, Vec<Diagnostic>) {
        let (mut sources, mut diagnostics) = (Sources::default(), Vec::new());
        let id = sources.add("scene.toml", text);
        let node = toml::parse(text, id, &mut diagnostics);
        let mut root = node.as_table().cloned().unwrap();
        Override::new(argument).apply(&mut root, &mut sources, &mut diagnostics);
        (root, diagnostics)
    }

    fn value<'a>(root: &'a Table, path: &[&str]) -> &'a Value {
        let entry = root.get(path[0]).unwrap();
        if path.len() == 1 { &entry.node.value } else { value(entry.node.as_table().unwrap(), &path[1..]) }
    }

    #[test]
    fn a_value_is_toml_or_else_a_string() {
        let (root, _) = set("[s]\nstep = 1", "s.step=0.5");
        assert!(matches!(value(&root, &["s", "step"]), Value::Float(0.5)));
        let (root, _) = set("", "s.integrator=rk4");
        assert!(matches!(value(&root, &["s", "integrator"]), Value::String(s) if &**s == "rk4"));
        let (root, _) = set("", "a.\"b.c\" = [1, 2]");
        assert!(matches!(value(&root, &["a", "b.c"]), Value::Array(items) if items.len() == 2));
        let (root, _) = set("", "title=a = b");
        assert!(matches!(value(&root, &["title"]), Value::String(s) if &**s == "a = b"));
    }

    #[test]
    fn a_value_knows_where_it_stands_in_the_argument() {
        let (root, _) = set("", "s.size= [1, 22]");
        let Value::Array(items) = value(&root, &["s", "size"]) else { panic!("not a list") };
        assert_eq!(items[1].span, Span::new(items[1].span.source(), 12..14));
    }

    #[test]
    fn a_number_that_is_too_large_is_refused_at_its_place() {
        let (root, diagnostics) = set("", "s.step= 1e999");
        assert!(root.get("s").is_none());
        let [error] = diagnostics.as_slice() else { panic!("{diagnostics:?}") };
        assert_eq!(error.span(), error.span().map(|span| Span::new(span.source(), 8..13)), "{error:?}");
    }

    #[test]
    fn what_is_no_setting_is_refused() {
        for argument in ["", "a", "=1", "a b=1", "a.=1", "a=1\nb"] {
            let (_, diagnostics) = set("", argument);
            let expected = usize::from(argument != "a=1\nb");
            assert_eq!(diagnostics.len(), expected, "{argument:?}");
        }
        let (_, diagnostics) = set("title = 'x'", "title.y=1");
        assert_eq!(diagnostics.len(), 1);
        for argument in ["a=[1, 2", "a={ b = 1", "a=\"b", "a=[1 2]"] {
            let (_, diagnostics) = set("", argument);
            assert!(diagnostics[0].message.starts_with("the value is not valid TOML: "), "{argument}");
        }
    }

    #[test]
    fn a_faulty_value_is_corrected() {
        for (argument, cause, fixed) in [
            (
                "a=[.35,.35,0]",
                "a digit is missing beside the decimal point",
                Some((2..13, "[0.35, 0.35, 0]")),
            ),
            ("a= [1 2 3]", "`1 2 3` is not a value", Some((3..10, "[1, 2, 3]"))),
            ("a=[1, 2", "the list is never closed", None),
        ] {
            let (root, diagnostics) = set("", argument);
            let [error] = diagnostics.as_slice() else { panic!("{diagnostics:?}") };
            assert!(root.get("a").is_none(), "{argument}");
            assert_eq!(error.message, format!("the value is not valid TOML: {cause}"));
            let source = error.labels[0].span.source();
            let edit = |(range, text): (_, &str)| Edit { span: Span::new(source, range), text: text.into() };
            let edits = error.fix.as_ref().map(|fix| fix.edits.clone());
            assert_eq!(edits, fixed.map(|fixed| vec![edit(fixed)]), "{argument}");
        }
    }
}
