//! The key `include`: fills in values from other scene files.
//!
//! A file's own values override those of the files that it includes. It is an error if two included files give the same key and the
//! including file does not. A file that is included several times is read once.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::merge::{is_replaced, merge};
use crate::diagnostic::{Code, Diagnostic, Sources, Span};
use crate::scene::grammar::{Kind, SCENE, TableSpec};
use crate::scene::source::{self, Entry, Node, Table, Value};
use crate::system;

/// The maximum number of files that include each other in a chain.
const MAX_DEPTH: usize = 50;

/// Fills in values from all included files. `path` is the path of the scene's file, or `None` for a scene that is not in a file. Returns
/// the texts of the included files.
pub(in crate::scene) fn include(
    root: &mut Table,
    path: Option<&Path>,
    trust: bool,
    sources: &mut Sources,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<String> {
    let folder = path.map(folder_of);
    let mut includer = Includer {
        scene: folder.as_ref().and_then(|folder| system::canonicalize(folder).ok()),
        trust,
        way: path.and_then(|path| system::canonicalize(path).ok()).into_iter().collect(),
        done: HashSet::new(),
        texts: Vec::new(),
        sources,
        diagnostics,
    };
    if let Some(items) = root.get("include").and_then(|entry| names(&entry.node)) {
        includer.files(root, &items, folder.as_deref());
    }
    includer.texts
}

/// Returns the folder of a scene file, to which the names of its included files are relative.
fn folder_of(path: &Path) -> PathBuf {
    let folder = path.parent().unwrap_or(path);
    if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_owned() }
}

/// Returns the file names in the value of `include`, with their source spans. `None` if the value is not a list of strings.
fn names(node: &Node) -> Option<Vec<(String, Span)>> {
    let Value::Array(items) = &node.value else { return None };
    items.iter().map(|item| Some((item.as_str()?.to_owned(), item.span))).collect()
}

struct Includer<'a> {
    /// The canonical folder of the scene. Without `--trust`, all included files must be inside this folder.
    scene: Option<PathBuf>,
    trust: bool,
    /// The chain of nested includes: the scene's file first, the file that is being read last.
    way: Vec<PathBuf>,
    done: HashSet<PathBuf>,
    texts: Vec<String>,
    sources: &'a mut Sources,
    diagnostics: &'a mut Vec<Diagnostic>,
}

impl Includer<'_> {
    /// Reads the files named in `items` and fills in the missing keys of `own` from them. `folder` is the folder of the including file.
    fn files(&mut self, own: &mut Table, items: &[(String, Span)], folder: Option<&Path>) {
        let mut all = Table::default();
        for (name, span) in items {
            match self.file(name, *span, folder) {
                Ok(Some(mut table)) => {
                    self.conflicts(&all, &table, own, &SCENE);
                    merge(&mut table, &all, &SCENE);
                    all = table;
                }
                Ok(None) => {}
                Err(error) => self.diagnostics.push(error),
            }
        }
        merge(own, &all, &SCENE);
    }

    /// Reads a file and all files that it includes. Returns `None` if the file has been included before.
    fn file(&mut self, name: &str, span: Span, folder: Option<&Path>) -> Result<Option<Table>, Diagnostic> {
        let cannot = |message: String| Diagnostic::error(Code::CannotInclude, message).at(span, "");
        let Some(folder) = folder else {
            return Err(cannot(format!(
                "there is no `{name}`: a scene that is no file has nothing beside it"
            )));
        };
        let path = folder.join(name);
        self.sources.note_file(&path);
        let real = system::canonicalize(&path).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => {
                let error = cannot(format!("there is no file `{name}`"));
                match name.ends_with(".inc") {
                    true => error.help("include files of POV-Ray's are named in `povray.include`"),
                    false => error.help(
                        "the names of included files start from the folder of the file that they stand in",
                    ),
                }
            }
            _ => cannot(format!("cannot read `{name}`: {error}")),
        })?;
        if !self.trust && self.scene.as_ref().is_none_or(|scene| !real.starts_with(scene)) {
            let message = format!("`{name}` leads out of the scene's folder");
            let error = Diagnostic::error(Code::UntrustedPath, message).at(span, "");
            return Err(error.help("if you know this scene and trust it, say `--trust`"));
        }
        if let Some(first) = self.way.iter().position(|other| *other == real) {
            return Err(self.cycle(first, span));
        }
        if self.way.len() > MAX_DEPTH {
            return Err(cannot(format!("files include each other more than {MAX_DEPTH} deep")));
        }
        if !self.done.insert(real.clone()) {
            return Ok(None);
        }
        let text = source::load(&path).map_err(|report| {
            let why =
                report.diagnostics.first().map_or(String::new(), |diagnostic| diagnostic.message.clone());
            cannot(format!("cannot include `{name}`: {why}"))
        })?;
        self.way.push(real);
        let table = self.read(&path, text);
        self.way.pop();
        Ok(Some(table))
    }

    fn read(&mut self, path: &Path, text: String) -> Table {
        let shown = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let id = self.sources.add(path.display().to_string(), shown);
        let tree = source::parse(shown, id, self.diagnostics);
        self.texts.push(text);
        let Value::Table(mut table) = tree.value else { return Table::default() };
        if let Some(place) = table.entries.iter().position(|entry| &*entry.name.text == "include") {
            let include = table.entries.remove(place);
            match names(&include.node) {
                Some(items) => self.files(&mut table, &items, Some(&folder_of(path))),
                None if matches!(include.node.value, Value::Invalid) => {}
                None => {
                    let message =
                        format!("expected a list of names of files, found {}", include.node.in_words());
                    self.diagnostics
                        .push(Diagnostic::error(Code::WrongType, message).at(include.node.span, ""));
                }
            }
        }
        table
    }

    /// Returns the error for a file that includes itself, directly or through other files.
    fn cycle(&self, first: usize, span: Span) -> Diagnostic {
        let name = |path: &PathBuf| {
            let name = path.file_name().map(std::ffi::OsStr::to_string_lossy).unwrap_or_default();
            format!("`{name}`")
        };
        let cycle = &self.way[first..];
        let message = match cycle {
            [only] => format!("{} includes itself", name(only)),
            cycle => {
                let names: Vec<String> = cycle.iter().chain(cycle.first()).map(name).collect();
                format!("files include each other: {}", names.join(" → "))
            }
        };
        Diagnostic::error(Code::CyclicInclude, message).at(span, "this leads back")
    }

    /// Reports keys that two included files both give, unless the including file gives the key, too.
    fn conflicts(&mut self, first: &Table, second: &Table, own: &Table, spec: &'static TableSpec) {
        for entry in &first.entries {
            let name = &*entry.name.text;
            let decided = own.get(name);
            let both = match second.get(name) {
                Some(other) => other,
                None if is_replaced(name, second, spec)
                    && decided.is_none()
                    && !is_replaced(name, own, spec) =>
                {
                    let replaces = |other: &&Entry| {
                        let alone = Table { entries: vec![Entry::clone(other)].into() };
                        is_replaced(name, &alone, spec)
                    };
                    let Some(other) = second.entries.iter().find(replaces) else { continue };
                    self.conflict(name, entry.name.span, other.name.span);
                    continue;
                }
                None => continue,
            };
            let inner = spec.key(name).map(|key| &key.kind);
            let empty = Table::default();
            match (&entry.node.value, &both.node.value) {
                (Value::Table(first), Value::Table(second)) => {
                    let own = decided.and_then(|entry| entry.node.as_table());
                    if decided.is_some() && own.is_none() {
                        continue;
                    }
                    self.conflicts_inside(first, second, own.unwrap_or(&empty), inner);
                }
                _ if decided.is_none() => self.conflict(name, entry.name.span, both.name.span),
                _ => {}
            }
        }
    }

    fn conflicts_inside(&mut self, first: &Table, second: &Table, own: &Table, kind: Option<&'static Kind>) {
        match kind {
            Some(Kind::Named(spec)) => {
                // A scene may have ten thousand names, so looking them up in a map is faster than searching the table for each.
                let (second, own) = (by_name(second), by_name(own));
                for entry in &first.entries {
                    let name = &*entry.name.text;
                    let tables = (entry.node.as_table(), second.get(name));
                    let (Some(first), Some(other)) = tables else { continue };
                    let Some(second) = other.node.as_table() else { continue };
                    let own = own.get(name).and_then(|entry| entry.node.as_table());
                    self.conflicts(first, second, own.unwrap_or(&Table::default()), spec);
                }
            }
            Some(Kind::Partial(spec)) => self.conflicts(first, second, own, spec),
            Some(Kind::Variables(_)) => {
                let (second, own) = (by_name(second), by_name(own));
                for entry in &first.entries {
                    let name = &*entry.name.text;
                    let other = second.get(name).filter(|_| !own.contains_key(name));
                    if let Some(other) = other {
                        self.conflict(&entry.name.text, entry.name.span, other.name.span);
                    }
                }
            }
            kind => {
                if let Some(spec) = kind.and_then(Kind::table) {
                    self.conflicts(first, second, own, spec);
                }
            }
        }
    }

    fn conflict(&mut self, name: &str, first: Span, second: Span) {
        let message = format!("two included files disagree on `{name}`");
        let error =
            Diagnostic::error(Code::IncludeConflict, message).at(second, "the one that is included later");
        let error = error.at(first, "the other is here");
        self.diagnostics.push(error.help("say it in the file that includes both: that counts"));
    }
}

/// Indexes the entries of a table by name.
fn by_name(table: &Table) -> HashMap<&str, &Entry> {
    table.entries.iter().map(|entry| (&*entry.name.text, entry)).collect()
}
