//! A document that is open in the editor, and its places.

use std::path::PathBuf;

use serde_json::{Value, json};

/// The text of a scene as the editor has it.
pub(super) struct Document {
    /// The identifier that the editor gives to the document.
    pub(super) uri: String,
    /// The whole text.
    pub(super) text: String,
}

impl Document {
    pub(super) fn new(uri: &str, text: &str) -> Document {
        Document { uri: uri.to_owned(), text: text.to_owned() }
    }

    /// Returns the path of the document. `None` if it is no file, such as a new text without a name.
    pub(super) fn path(&self) -> Option<PathBuf> {
        let encoded = self.uri.strip_prefix("file://")?;
        let decoded = percent_decoded(encoded)?;
        // On Windows, a slash comes before the letter of the drive: `file:///c:/scenes/ball.toml`.
        let drive = decoded.strip_prefix('/').filter(|rest| rest.as_bytes().get(1) == Some(&b':'));
        Some(PathBuf::from(drive.unwrap_or(&decoded)))
    }

    /// Returns whether the text looks like a scene. Editors open other files in TOML, too, such as `Cargo.toml`.
    pub(super) fn is_scene(&self) -> bool {
        let is_of_scene = |line: &str| {
            let line = line.trim_start();
            ["[simulation", "[body.", "simulation.", "body."].iter().any(|start| line.starts_with(start))
        };
        self.text.lines().any(is_of_scene)
    }

    /// Returns a line, counted from 0. Beyond the end of the text, it is empty.
    pub(super) fn line(&self, number: usize) -> &str {
        self.text.split('\n').nth(number).map_or("", |line| line.trim_end_matches('\r'))
    }

    /// Reads a place of the protocol: a line, and a column in UTF-16 units, which both count from 0. Returns the line and the byte offset in it.
    pub(super) fn place(&self, place: &Value) -> Option<(usize, usize)> {
        let number = |key: &str| usize::try_from(place[key].as_u64()?).ok();
        let (line, column) = (number("line")?, number("character")?);
        let mut units = 0;
        let text = self.line(line);
        let ends = text.char_indices().find(|(_, letter)| {
            let is_at = units >= column;
            units += letter.len_utf16();
            is_at
        });
        Some((line, ends.map_or(text.len(), |(offset, _)| offset)))
    }

    /// Converts a line and a column, which both count from 1 and in characters, to a place of the protocol.
    pub(super) fn to_place(&self, line: u64, column: u64) -> Value {
        let line = line.saturating_sub(1);
        let before = usize::try_from(column).unwrap_or(usize::MAX).saturating_sub(1);
        let text = self.line(usize::try_from(line).unwrap_or(usize::MAX));
        let units: usize = text.chars().take(before).map(char::len_utf16).sum();
        json!({ "line": line, "character": units })
    }

    /// Returns the keys of the table in which a line stands: `["body", "ball"]` below `[body.ball]`.
    pub(super) fn table(&self, line: usize) -> Vec<String> {
        let lines: Vec<&str> = self.text.split('\n').take(line + 1).collect();
        let header = lines.iter().rev().find_map(|line| {
            let inner = line.trim_start().strip_prefix('[')?;
            Some(inner.trim_start_matches('[').split(']').next().unwrap_or_default())
        });
        header.map_or_else(Vec::new, keys)
    }
}

/// Splits a path of keys: `body."ball".mass`.
pub(super) fn keys(path: &str) -> Vec<String> {
    path.split('.').map(|key| key.trim().trim_matches(['"', '\'']).to_owned()).collect()
}

/// Replaces `%20` and the like by what they stand for. `None` if the result is no text.
fn percent_decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let code = (*first == b'%').then(|| after.get(..2)).flatten();
        let code = code.and_then(|digits| u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok());
        bytes.push(code.unwrap_or(*first));
        rest = if code.is_some() { &after[2..] } else { after };
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_utf_16_units_from_zero() {
        let document = Document::new("file:///a%20b.toml", "# 🎾é\r\nx = 1\n");
        assert_eq!(document.path().unwrap(), PathBuf::from("/a b.toml"));
        assert_eq!(document.to_place(1, 4), json!({ "line": 0, "character": 4 }));
        assert_eq!(document.place(&json!({ "line": 0, "character": 4 })), Some((0, 6)));
        assert_eq!(document.place(&json!({ "line": 0, "character": 99 })), Some((0, 8)));
        assert_eq!(document.to_place(2, 3), json!({ "line": 1, "character": 2 }));
        assert_eq!(Document::new("file:///c%3A/x.toml", "").path().unwrap(), PathBuf::from("c:/x.toml"));
        assert_eq!(Document::new("untitled:1", "").path(), None);
    }

    #[test]
    fn a_line_belongs_to_the_table_above_it() {
        let document = Document::new("", "a = 1\n[body.\"my ball\"]\nmass = 1\n[[x]]\n");
        assert_eq!(document.table(0), Vec::<String>::new());
        assert_eq!(document.table(2), ["body", "my ball"]);
        assert_eq!(document.table(3), ["x"]);
    }
}
