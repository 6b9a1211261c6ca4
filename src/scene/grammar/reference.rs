//! The description of the language as a page of the documentation.

use std::fmt::Write as _;

use super::{Key, Kind, Rule, SCENE, TableSpec, quoted};

/// All keys of the scene language, as Markdown.
pub fn reference() -> String {
    let text = String::from(
        "# The scene language, key by key\n\n\
         This page is made from the description of the keys that also reads and checks scenes; the test\n\
         `tests/reference.rs` keeps it so. Coordinates are right-handed: x right, y up, z towards the viewer.\n",
    );
    let mut page = Page { text, sections: Vec::new() };
    page.section("", &SCENE);
    page.text
}

/// The page as far as it is written.
struct Page {
    text: String,
    /// The tables that have a section, each with its title.
    sections: Vec<(&'static TableSpec, String)>,
}

impl Page {
    fn section(&mut self, path: &str, table: &'static TableSpec) {
        let title = if path.is_empty() { "The scene".to_owned() } else { format!("`{path}`") };
        let _ = write!(self.text, "\n## {title}\n\n");
        self.sections.push((table, title));
        match &table.rule {
            Rule::Any => {}
            Rule::AtMostOne(groups) => {
                for names in *groups {
                    let _ = writeln!(self.text, "At most one of {}.", quoted(names));
                }
                self.text.push('\n');
            }
            Rule::ExactlyOne(names) => {
                let _ = write!(self.text, "Exactly one of {}.\n\n", quoted(names));
            }
        }
        self.text
            .push_str("| key | value | unit | without it | meaning |\n| --- | --- | --- | --- | --- |\n");
        table.keys.iter().for_each(|key| self.row(key));
        for key in table.keys {
            self.inner(path, key.name, &key.kind);
        }
    }

    fn row(&mut self, key: &Key) {
        let Key { name, kind, unit, default, meaning, required, .. } = key;
        let default = if *required { "**must be there**" } else { default };
        let value = self.in_short(kind).replace('|', "\\|");
        let _ = writeln!(self.text, "| `{name}` | {value} | {unit} | {default} | {meaning} |");
    }

    /// The title of the section of a table, if it has been written.
    fn title(&self, table: &TableSpec) -> Option<&str> {
        let written = self.sections.iter().find(|(spec, _)| std::ptr::eq(*spec, table));
        written.map(|(_, title)| title.as_str())
    }

    fn in_short(&self, kind: &Kind) -> String {
        match kind {
            Kind::Table(table) => match self.title(table) {
                Some(title) => format!("as {title}"),
                None => "table".to_owned(),
            },
            Kind::Named(_) => "tables with names".to_owned(),
            Kind::Either(kinds) => {
                kinds.iter().map(|kind| self.in_short(kind)).collect::<Vec<_>>().join(", or ")
            }
            kind => kind.in_words(),
        }
    }

    fn inner(&mut self, path: &str, name: &str, kind: &'static Kind) {
        match kind {
            Kind::Table(table) if self.title(table).is_some() => {}
            Kind::Named(table) => self.section(&format!("[{name}.NAME]"), table),
            Kind::Table(table) if path.is_empty() => self.section(&format!("[{name}]"), table),
            Kind::Table(table) => {
                let dot = if path.ends_with(']') { " " } else { "." };
                self.section(&format!("{path}{dot}{name}"), table);
            }
            Kind::Either(kinds) => kinds.iter().for_each(|kind| self.inner(path, name, kind)),
            Kind::List { of, .. } => self.inner(path, name, of),
            _ => {}
        }
    }
}
