//! The description of the language as a page of the documentation.

use std::fmt::Write as _;

use super::{Key, Kind, Rule, SCENE, TableSpec, quoted};

/// All keys of the scene language, as Markdown.
pub fn reference() -> String {
    let mut page = String::from(
        "# The scene language, key by key\n\n\
         This page is made from the description of the keys that also reads and checks scenes; the test\n\
         `tests/reference.rs` keeps it so. Coordinates are right-handed: x right, y up, z towards the viewer.\n",
    );
    section(&mut page, "", &SCENE);
    page
}

fn section(page: &mut String, path: &str, table: &'static TableSpec) {
    let title = if path.is_empty() { "The scene".to_owned() } else { format!("`{path}`") };
    let _ = write!(page, "\n## {title}\n\n");
    match &table.rule {
        Rule::Any => {}
        Rule::AtMostOne(groups) => {
            for names in *groups {
                let _ = writeln!(page, "At most one of {}.", quoted(names));
            }
            page.push('\n');
        }
        Rule::ExactlyOne(names) => {
            let _ = write!(page, "Exactly one of {}.\n\n", quoted(names));
        }
    }
    page.push_str("| key | value | unit | without it | meaning |\n| --- | --- | --- | --- | --- |\n");
    table.keys.iter().for_each(|key| row(page, key));
    for key in table.keys {
        inner(page, path, key.name, &key.kind);
    }
}

fn row(page: &mut String, key: &Key) {
    let Key { name, kind, unit, default, meaning, required, .. } = key;
    let default = if *required { "**must be there**" } else { default };
    let value = in_short(kind).replace('|', "\\|");
    let _ = writeln!(page, "| `{name}` | {value} | {unit} | {default} | {meaning} |");
}

fn in_short(kind: &Kind) -> String {
    match kind {
        Kind::Table(_) => "table".to_owned(),
        Kind::Named(_) => "tables with names".to_owned(),
        Kind::Either(kinds) => kinds.iter().map(in_short).collect::<Vec<_>>().join(", or "),
        kind => kind.in_words(),
    }
}

fn inner(page: &mut String, path: &str, name: &str, kind: &'static Kind) {
    match kind {
        Kind::Named(table) => section(page, &format!("[{name}.NAME]"), table),
        Kind::Table(table) if path.is_empty() => section(page, &format!("[{name}]"), table),
        Kind::Table(table) => {
            let dot = if path.ends_with(']') { " " } else { "." };
            section(page, &format!("{path}{dot}{name}"), table);
        }
        Kind::Either(kinds) => kinds.iter().for_each(|kind| inner(page, path, name, kind)),
        _ => {}
    }
}
