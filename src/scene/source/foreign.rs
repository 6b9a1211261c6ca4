//! Converts a scene in YAML or JSON to TOML, for users who confuse these formats.

use std::fmt::Write as _;

use serde_json::Value;

use super::corrections;
use crate::scene::grammar::{Kind, SCENE};

/// A text in another format: the name of the format, and the same scene in TOML. `None` if the scene cannot be converted.
pub(super) struct Foreign {
    pub(super) format: &'static str,
    pub(super) toml: Option<String>,
}

/// Recognizes a scene in YAML or JSON. `None` for all other texts.
pub(super) fn recognize(text: &str) -> Option<Foreign> {
    if text.trim_start().starts_with('{') {
        let value = serde_json::from_str::<Value>(text).ok()?;
        return Some(Foreign { format: "JSON", toml: of_json(&value) });
    }
    let is_key = |line: &Line<'_>| line.key.is_some();
    let lines: Vec<Line<'_>> = text.lines().filter_map(line).collect::<Option<Vec<_>>>()?;
    lines.iter().any(is_key).then(|| Foreign { format: "YAML", toml: of_yaml(&lines) })
}

/// The keys that lead to a value, and the value as TOML.
type Leaf = (Vec<String>, String);

/// Converts a scene in JSON. A list of tables becomes tables with names. `None` if there are no values.
fn of_json(value: &Value) -> Option<String> {
    let mut leaves = Vec::new();
    json_leaves(value, &mut Vec::new(), &mut leaves)?;
    (!leaves.is_empty()).then(|| write(&leaves))
}

fn json_leaves(value: &Value, path: &mut Vec<String>, leaves: &mut Vec<Leaf>) -> Option<()> {
    match value {
        Value::Object(entries) if !entries.is_empty() || path.is_empty() => {
            for (key, value) in entries {
                path.push(key_of(key)?);
                json_leaves(value, path, leaves)?;
                path.pop();
            }
        }
        Value::Array(items) if !items.is_empty() && items.iter().all(Value::is_object) => {
            for (number, item) in items.iter().enumerate() {
                let Value::Object(mut entries) = item.clone() else { return None };
                let name = entries.remove("name");
                let name = name.as_ref().and_then(Value::as_str).map(str::to_owned);
                path.push(key_of(&name.unwrap_or_else(|| format!("item{}", number + 1)))?);
                json_leaves(&Value::Object(entries), path, leaves)?;
                path.pop();
            }
        }
        Value::Object(_) => leaves.push((path.clone(), "{}".to_owned())),
        Value::Null => {}
        value => leaves.push((path.clone(), json_value(value)?)),
    }
    Some(())
}

/// Writes a JSON value in one line of TOML.
fn json_value(value: &Value) -> Option<String> {
    let listed = |items: Vec<String>| items.join(", ");
    Some(match value {
        Value::Array(items) => {
            format!("[{}]", listed(items.iter().map(json_value).collect::<Option<_>>()?))
        }
        Value::Object(entries) => {
            let entries =
                entries.iter().map(|(key, value)| Some(format!("{} = {}", key_of(key)?, json_value(value)?)));
            format!("{{ {} }}", listed(entries.collect::<Option<_>>()?))
        }
        // JSON and TOML write numbers, booleans and strings in the same way.
        Value::Number(_) | Value::Bool(_) | Value::String(_) => value.to_string(),
        Value::Null => return None,
    })
}

/// Returns a name as a bare key of TOML: spaces become `_`. `None` if other characters are not allowed in a bare key.
fn key_of(name: &str) -> Option<String> {
    let key = name.trim().replace(' ', "_");
    let is_bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    (!key.is_empty() && key.chars().all(is_bare)).then_some(key)
}

/// A line of YAML: its indentation, its key (`None` for a value of a list), and its value, which may be empty.
struct Line<'a> {
    indent: usize,
    key: Option<&'a str>,
    value: &'a str,
    /// Whether the line begins a table in a list, as in `- name: ball`.
    begins: bool,
}

/// Converts simple YAML (keys, values and lists) to TOML. `None` for other YAML.
fn of_yaml(lines: &[Line<'_>]) -> Option<String> {
    // The keys of the mappings that contain the current line, each with its indentation.
    let mut path: Vec<(usize, String)> = Vec::new();
    let mut leaves: Vec<Leaf> = Vec::new();
    let mut lists: Vec<(Vec<String>, Vec<String>)> = Vec::new();
    let keys_of = |path: &[(usize, String)]| path.iter().map(|(_, key)| key.clone()).collect::<Vec<_>>();
    for (number, line) in lines.iter().enumerate() {
        let Some(key) = line.key else {
            let keys = keys_of(&path);
            let item = corrections::scalar(line.value, keys.last()?)?;
            match lists.last_mut().filter(|(path, _)| *path == keys) {
                Some((_, items)) => items.push(item),
                None => lists.push((keys, vec![item])),
            }
            continue;
        };
        if line.begins {
            // The keys of a table in a list stand two columns to the right of its hyphen, where its name is in TOML.
            path.retain(|(indent, _)| *indent + 2 <= line.indent);
            if path.is_empty() {
                path.push((0, "body".to_owned()));
            }
            path.push((line.indent - 1, name_of(&lines[number..])?));
        }
        path.retain(|(indent, _)| *indent < line.indent);
        let is_item = path.last().is_some_and(|(indent, _)| *indent + 1 == line.indent);
        if is_item && key == "name" {
            continue;
        }
        path.push((line.indent, key.to_owned()));
        if !line.value.is_empty() {
            leaves.push((keys_of(&path), corrections::scalar(line.value, key)?));
        } else if lines.get(number + 1).is_some_and(|next| next.key.is_none()) {
            leaves.push((keys_of(&path), String::new()));
        }
    }
    for (path, items) in lists {
        leaves.iter_mut().find(|(keys, _)| *keys == path)?.1 = format!("[{}]", items.join(", "));
    }
    Some(write(&leaves))
}

/// Returns the name of the table in a list that begins in the first of these lines. `None` if it has no name.
fn name_of(lines: &[Line<'_>]) -> Option<String> {
    let indent = lines.first()?.indent;
    let mut own = lines
        .iter()
        .enumerate()
        .take_while(|(number, line)| *number == 0 || line.indent >= indent && !line.begins);
    let (_, name) = own.find(|(_, line)| line.indent == indent && line.key == Some("name"))?;
    key_of(name.value.trim_matches(['"', '\'']))
}

/// Reads a line of YAML. Returns `None` for a line without content, and `Some(None)` for an unreadable line.
#[allow(
    clippy::option_option,
    reason = "a line that says nothing and one that is not understood are two things"
)]
fn line(text: &str) -> Option<Option<Line<'_>>> {
    let content = match text.find(" #") {
        Some(at) => &text[..at],
        None => text,
    };
    let trimmed = content.trim();
    if trimmed.is_empty() || trimmed.starts_with('#') || trimmed == "---" {
        return None;
    }
    let indent = content.len() - content.trim_start().len();
    if let Some(value) = trimmed.strip_prefix("- ") {
        let value = value.trim();
        let entry = entry(value, indent + 2).filter(|_| !value.starts_with(['[', '{', '"', '\'']));
        let item = Line { indent, key: None, value, begins: false };
        return Some(Some(entry.map_or(item, |entry| Line { begins: true, ..entry })));
    }
    Some(entry(trimmed, indent))
}

/// Reads a key and its value. `None` for other text.
fn entry(text: &str, indent: usize) -> Option<Line<'_>> {
    let (key, value) = text.split_once(':')?;
    let key = key.trim().trim_matches('"');
    let is_bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    let is_key = !key.is_empty() && key.chars().all(is_bare);
    is_key.then(|| Line { indent, key: Some(key), value: value.trim(), begins: false })
}

/// Formats values as TOML, below the headers of a scene such as `[simulation]` and `[body.ball]`.
fn write(leaves: &[Leaf]) -> String {
    let mut sections: Vec<(String, Vec<String>)> = vec![(String::new(), Vec::new())];
    for (path, value) in leaves {
        let known = SCENE.keys().find(|key| key.name == path[0] || key.also.contains(&path[0].as_str()));
        let first = known.map_or(path[0].as_str(), |key| key.name);
        let path: Vec<&str> = std::iter::once(first).chain(path[1..].iter().map(String::as_str)).collect();
        let is_named = known.is_some_and(|key| matches!(key.kind, Kind::Named(_)));
        let depth = path.len().saturating_sub(1).min(if is_named { 2 } else { 1 });
        let header = path[..depth].join(".");
        let entry = format!("{} = {value}", path[depth..].join("."));
        match sections.iter_mut().find(|(other, _)| *other == header) {
            Some((_, lines)) => lines.push(entry),
            None => sections.push((header, vec![entry])),
        }
    }
    let mut text = String::new();
    for (header, lines) in sections.iter().filter(|(_, lines)| !lines.is_empty()) {
        if !text.is_empty() {
            text.push('\n');
        }
        if !header.is_empty() {
            let _ = writeln!(text, "[{header}]");
        }
        lines.iter().for_each(|line| text.extend([line, "\n"]));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_values_and_lists_of_yaml_become_toml() {
        let yaml = "---\n# a fall\ntitle: A fall\nsimulation:\n  duration: 5 s\nbody:\n  ball:\n    shape:\n      sphere:\n        \
                    radius: .5\n    location: [0, 1, 0]  # m\n  box:\n    velocity:\n      - 1\n      - 2\n      - 3\n";
        assert_eq!(
            recognize(yaml).and_then(|scene| scene.toml).as_deref(),
            Some(
                "title = \"A fall\"\n\n[simulation]\nduration = 5\n\n[body.ball]\nshape.sphere.radius = 0.5\n\
                 location = [0, 1, 0]\n\n[body.box]\nvelocity = [1, 2, 3]\n"
            )
        );
    }

    #[test]
    fn tables_in_a_list_of_yaml_get_their_names() {
        let yaml = "simulation:\n  duration: 2\nbodies:\n  - name: ball\n    shape:\n      sphere:\n        radius: 1\n  - mass: 2\n    \
                    name: my box\n    velocity:\n      - 1\n      - 2\n      - 3\n";
        let toml = "[simulation]\nduration = 2\n\n[body.ball]\nshape.sphere.radius = 1\n\n[body.my_box]\nmass = 2\n\
                    velocity = [1, 2, 3]\n";
        assert_eq!(recognize(yaml).and_then(|scene| scene.toml).as_deref(), Some(toml));
        let top = "- name: ball\n  mass: 1\n- name: box\n  mass: 2\n";
        let toml = "[body.ball]\nmass = 1\n\n[body.box]\nmass = 2\n";
        assert_eq!(recognize(top).and_then(|scene| scene.toml).as_deref(), Some(toml));
        let nameless = "bodies:\n  - mass: 1\n";
        assert!(recognize(nameless).is_some_and(|scene| scene.format == "YAML" && scene.toml.is_none()));
    }

    #[test]
    fn json_becomes_toml() {
        let json = r#"{ "body": { "ball": { "shape": { "sphere": { "radius": 1.5 } }, "location": [0, 1, 0] } },
            "simulation": { "duration": 2 } }"#;
        let toml =
            "[body.ball]\nlocation = [0, 1, 0]\nshape.sphere.radius = 1.5\n\n[simulation]\nduration = 2\n";
        let sorted = |text: &str| {
            let mut lines: Vec<&str> = text.lines().collect();
            lines.sort_unstable();
            lines.join("\n")
        };
        let found = recognize(json).and_then(|scene| scene.toml).unwrap();
        assert_eq!(sorted(&found), sorted(toml));
        let listed = r#"{ "bodies": [{ "name": "ball", "mass": 2, "motion": null }] }"#;
        assert_eq!(
            recognize(listed).and_then(|scene| scene.toml).as_deref(),
            Some("[body.ball]\nmass = 2\n")
        );
        for nothing in ["{}", " { } ", r#"{ "body": null }"#, r#"{ "bodies": [{}] }"#] {
            assert!(recognize(nothing).is_some_and(|scene| scene.format == "JSON"), "{nothing}");
        }
    }

    #[test]
    fn what_is_no_yaml_is_nothing() {
        for text in ["", "# nothing", "a b c", "a = 1", "[body.ball]\nx: 1"] {
            assert!(recognize(text).is_none(), "{text}");
        }
    }
}
