//! Guesses the kind of a shape, a force or a joint, such as `sphere`, if the keys of the kind, such as `radius`, stand outside of the
//! kind's table.

use super::super::Context;
use super::ends::is_end;
use super::joint::kind_in_header;
use super::key_of;
use super::text::{removal, whole};
use crate::diagnostic::{Diagnostic, Span};
use crate::scene::grammar::{KeySpec, Kind, Rule, TableSpec};
use crate::scene::source::{Entry, Table, Value};

/// The kind that the user probably meant for a table, such as the shape `sphere` for a body.
pub(in crate::scene::check) struct MeantKind {
    /// The keys that lead from the table to the inner table of the kind, such as `shape` and `sphere`.
    pub(in crate::scene::check) way: Vec<&'static str>,
    /// The grammar of the kind's inner table, such as the keys of a `sphere`.
    pub(super) spec: &'static TableSpec,
    /// The span of the key that names the kind in a word, such as `type = "sphere"`. `None` if there is no such key.
    pub(in crate::scene::check) word: Option<Span>,
    /// Whether the outer table contains keys that belong into the kind's inner table.
    has_keys: bool,
}

impl MeantKind {
    /// Returns the path of keys from the table to the key `word` in the kind's inner table. `None` if the kind has no such key.
    pub(super) fn path_to(&self, word: &str) -> Option<Vec<&'static str>> {
        let key = key_of(word, self.spec)?;
        Some(self.way.iter().copied().chain([key.name]).collect())
    }
}

/// Guesses the kind of a table from a word such as `type = "sphere"`, from its keys, and from its name.
pub(in crate::scene::check) fn meant_kind(
    table: &Table,
    spec: &'static TableSpec,
    path: &str,
) -> Option<MeantKind> {
    by_word(table, spec).or_else(|| by_keys(table, spec, path))
}

/// Returns the path of keys to the table that names the kind, and the grammar of that table. For a body, this is the table `shape`, which
/// names the kind of its shape. For a force or a joint, the path is empty.
fn kinds_of(spec: &'static TableSpec) -> Option<(Vec<&'static str>, &'static TableSpec)> {
    match (&spec.rule, spec.key("shape").map(|key| &key.kind)) {
        (Rule::ExactlyOne(_), _) => Some((Vec::new(), spec)),
        (_, Some(Kind::Table(kinds))) => Some((vec!["shape"], kinds)),
        _ => None,
    }
}

/// Finds the kind that a table names in a word, such as `shape = "sphere"` or `type = "point"`.
fn by_word(table: &Table, spec: &'static TableSpec) -> Option<MeantKind> {
    let found = table.entries.iter().find_map(|entry| {
        let word = entry.node.as_str()?;
        let name = &*entry.name.text;
        let (mut way, kinds) = match spec.key(name) {
            Some(KeySpec { kind: Kind::Table(kinds), name, .. }) => (vec![*name], *kinds),
            None if matches!(name, "type" | "kind") => kinds_of(spec).unwrap_or((Vec::new(), spec)),
            _ => return None,
        };
        let Rule::ExactlyOne(names) = &kinds.rule else { return None };
        let key = key_of(word, kinds).filter(|key| names.contains(&key.name))?;
        way.push(key.name);
        Some((entry.name.span, way, key.kind.table()?))
    });
    let (word, way, spec) = found?;
    let is_of_it = |name: &str| key_of(name, spec).is_some() || way.len() == 1 && way[0] == name;
    let has_keys = table.entries.iter().any(|entry| is_of_it(&entry.name.text));
    Some(MeantKind { way, spec, word: Some(word), has_keys })
}

/// Finds the kind, such as `sphere`, that has most of the table's unknown keys. If several kinds have equally many, prefers the kind with
/// the name of the table.
fn by_keys(table: &Table, spec: &'static TableSpec, path: &str) -> Option<MeantKind> {
    let (way, kinds) = kinds_of(spec)?;
    let Rule::ExactlyOne(names) = &kinds.rule else { return None };
    // A key of the table itself has priority over an equal key of a kind.
    let is_free = |entry: &&Entry| {
        let word = &*entry.name.text;
        let own = key_of(word, spec);
        spec.key(word).is_none() && own.is_none_or(|own| way.is_empty() && !own.kind.takes(&entry.node.value))
    };
    let words: Vec<&str> = table.entries.iter().filter(is_free).map(|entry| &*entry.name.text).collect();
    if words.is_empty() {
        return None;
    }
    let present = match way.first() {
        Some(shape) => table.get(shape).and_then(|entry| entry.node.as_table()),
        None => Some(table),
    };
    let is_there = |name: &str| present.is_some_and(|table| table.get(name).is_some());
    // If the table has a kind already, exclude other kinds: a table can have only one.
    let is_table = |name: &str| kinds.key(name).is_some_and(|key| key.kind.table().is_some());
    let is_full = names.iter().any(|name| is_there(name) && is_table(name));
    let name = path.rsplit(['.', '[']).next().unwrap_or_default().trim_matches([']', '"']);
    let is_named = |key: &KeySpec| key_of(name, kinds).is_some_and(|named| named.name == key.name);
    // A key of the scene language counts twice as much as a name from other programs.
    let fits = |inner: &'static TableSpec| -> usize {
        let worth = |word: &&str| match inner.key(word) {
            Some(_) => 2,
            None => usize::from(key_of(word, inner).is_some()),
        };
        words.iter().map(worth).sum()
    };
    // Of all forces, only those by formulas have texts in a list: `force = ["-k*x", 0, 0]`.
    let has_text = |entry: &Entry| match &entry.node.value {
        Value::Array(items) => items.iter().any(|item| item.as_str().is_some()),
        _ => false,
    };
    let has_formulas = table.entries.iter().filter(is_free).any(has_text);
    let candidates = kinds
        .keys
        .iter()
        .filter(|key| names.contains(&key.name) && !(has_formulas && key.name == "constant"));
    let (_, key, spec) = candidates
        .filter_map(|key| Some((key, key.kind.table()?)))
        .map(|(key, inner)| ((is_there(key.name), fits(inner), is_named(key)), key, inner))
        .filter(|((_, fits, _), ..)| *fits > 0)
        // Accept a kind, such as `sphere`, only if the table contains a key of this name, has this name itself, or has one of the kind's
        // required keys.
        .filter(|((is_there, _, is_named), _, inner)| {
            *is_there || !is_full && (*is_named || is_begun(inner, table))
        })
        .rev()
        .max_by_key(|(worth, ..)| *worth)?;
    let has_keys = true;
    Some(MeantKind { way: way.into_iter().chain([key.name]).collect(), spec, word: None, has_keys })
}

/// Returns whether a table has at least one of the required keys of a kind. Also true if the kind has no required keys.
pub(super) fn is_begun(spec: &'static TableSpec, table: &Table) -> bool {
    let mut required = spec.keys().filter(|key| key.required).peekable();
    let is_it =
        |entry: &Entry, key: &KeySpec| key_of(&entry.name.text, spec).is_some_and(|it| it.name == key.name);
    let is_said = |key: &KeySpec| table.entries.iter().any(|entry| is_it(entry, key));
    let has_ends = spec.key("between").is_some_and(|key| key.required) && table.entries.iter().any(is_end);
    required.peek().is_none() || has_ends || required.any(is_said)
}

/// Adds the fix for a word that names a kind, such as `type = "sphere"`, to the diagnostics from index `before` on.
pub(in crate::scene::check) fn correct_word(
    meant: &MeantKind,
    table: &Table,
    at: Option<Span>,
    before: usize,
    context: &mut Context<'_>,
) {
    let Some(entry) = table.entries.iter().find(|entry| Some(entry.name.span) == meant.word) else { return };
    if let [kind] = meant.way[..]
        && let Some(found) = kind_in_header(entry, kind, meant.spec, table, at, context)
    {
        let mut said = context.diagnostics.split_off(before);
        said.retain(|diagnostic| !diagnostic.span().is_some_and(|span| found.keys.contains(&span)));
        for diagnostic in said.iter_mut().filter(|it| it.span() == Some(entry.name.span)) {
            let error = Diagnostic { labels: Vec::new(), help: None, fix: None, ..diagnostic.clone() }
                .at(entry.name.span, format!("the header says the kind, as `.{kind}`"));
            *diagnostic =
                found.edits.iter().cloned().fold(error, |error, (span, text)| error.fix(span, text));
        }
        context.diagnostics.append(&mut said);
        return;
    }
    let example = if meant.has_keys {
        whole(entry).and_then(|it| removal(it, context)).map(|line| (line, String::new()))
    } else {
        super::missing::example(&meant.way, meant.spec, context).and_then(|text| Some((whole(entry)?, text)))
    };
    let is_of_it = |diagnostic: &&mut Diagnostic| {
        diagnostic.span().is_some_and(|span| span == entry.name.span || span == entry.node.span)
    };
    if let (Some(diagnostic), Some((span, text))) =
        (context.diagnostics[before..].iter_mut().find(is_of_it), example)
    {
        *diagnostic = Diagnostic { fix: None, ..diagnostic.clone() }.fix(span, text);
        let way = meant.way.join(".");
        if let (true, Some(label)) = (meant.has_keys, diagnostic.labels.first_mut()) {
            label.text = format!("leave this line out: the keys below `{way}` name the kind");
            diagnostic.help = None;
        }
    }
}
