//! Converts a scene in YAML to TOML, for users who confuse the two formats.

use std::fmt::Write as _;

use super::corrections;
use crate::scene::grammar::{Kind, SCENE};

/// A line of YAML: its indentation, its key (`None` for a list item), and its value, which may be empty.
struct Line<'a> {
    indent: usize,
    key: Option<&'a str>,
    value: &'a str,
}

/// Converts simple YAML (keys, values and lists) to TOML. Returns `None` for other YAML and for all other texts.
pub(super) fn to_toml(text: &str) -> Option<String> {
    let lines: Vec<Line<'_>> = text.lines().filter_map(line).collect::<Option<Vec<_>>>()?;
    if lines.is_empty() {
        return None;
    }
    // The keys of the mappings that contain the current line, each with its indentation.
    let mut path: Vec<(usize, &str)> = Vec::new();
    let mut entries: Vec<(Vec<&str>, String)> = Vec::new();
    let mut lists: Vec<(Vec<&str>, Vec<String>)> = Vec::new();
    for (number, line) in lines.iter().enumerate() {
        let Some(key) = line.key else {
            let keys: Vec<&str> = path.iter().map(|(_, key)| *key).collect();
            let item = corrections::scalar(line.value, keys.last()?)?;
            match lists.last_mut().filter(|(path, _)| *path == keys) {
                Some((_, items)) => items.push(item),
                None => lists.push((keys, vec![item])),
            }
            continue;
        };
        path.retain(|(indent, _)| *indent < line.indent);
        path.push((line.indent, key));
        let keys: Vec<&str> = path.iter().map(|(_, key)| *key).collect();
        if !line.value.is_empty() {
            entries.push((keys, corrections::scalar(line.value, key)?));
        } else if lines.get(number + 1).is_some_and(|next| next.key.is_none()) {
            entries.push((keys, String::new()));
        }
    }
    for (path, items) in lists {
        entries.iter_mut().find(|(keys, _)| *keys == path)?.1 = format!("[{}]", items.join(", "));
    }
    Some(write(&entries))
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
        return Some(Some(Line { indent, key: None, value: value.trim() }));
    }
    Some(trimmed.split_once(':').and_then(|(key, value)| {
        let key = key.trim().trim_matches('"');
        let is_bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
        (!key.is_empty() && key.chars().all(is_bare)).then(|| Line {
            indent,
            key: Some(key),
            value: value.trim(),
        })
    }))
}

/// Formats entries as TOML, below the headers of a scene such as `[simulation]` and `[body.ball]`.
fn write(entries: &[(Vec<&str>, String)]) -> String {
    let mut sections: Vec<(String, Vec<String>)> = vec![(String::new(), Vec::new())];
    for (path, value) in entries {
        let is_named = SCENE.key(path[0]).is_some_and(|key| matches!(key.kind, Kind::Named(_)));
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
            to_toml(yaml).as_deref(),
            Some(
                "title = \"A fall\"\n\n[simulation]\nduration = 5\n\n[body.ball]\nshape.sphere.radius = 0.5\n\
                 location = [0, 1, 0]\n\n[body.box]\nvelocity = [1, 2, 3]\n"
            )
        );
    }

    #[test]
    fn what_is_no_yaml_is_nothing() {
        for text in ["", "# nothing", "a b c", "a = 1", "[body.ball]\nx: 1"] {
            assert_eq!(to_toml(text), None, "{text}");
        }
    }
}
