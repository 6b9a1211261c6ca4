//! The texts of a scene, and positions in them.

use std::path::PathBuf;

/// One text of a scene: the content of a file, or a `--set` argument.
#[derive(Clone, Debug)]
pub struct Source {
    /// The name shown before line and column: the path of the file as the user gave it, or `--set`.
    pub name: String,
    /// The whole content of the file or argument.
    pub text: String,
    /// The byte offset at which each line begins.
    lines: Vec<usize>,
}

/// All texts of one scene: its files and its `--set` arguments. The scene's own file is the first text.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    texts: Vec<Source>,
    files: Vec<PathBuf>,
}

/// The index of a text within its [`Sources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceId(usize);

/// A byte range in one of the texts of a scene ([`Sources`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// The text that contains the range.
    pub source: SourceId,
    /// The offset of the first byte of the range.
    pub start: usize,
    /// The offset after the last byte of the range.
    pub end: usize,
}

/// A line and a column as editors show them: both count from 1, and columns are in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// The number of the line, counted from 1.
    pub line: usize,
    /// The number of the character within its line, counted from 1.
    pub column: usize,
}

impl Sources {
    /// Adds a text with its name, and returns its id.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<String>) -> SourceId {
        let text = text.into();
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(newline, _)| newline + 1));
        self.texts.push(Source { name: name.into(), lines: lines.collect(), text });
        SourceId(self.texts.len() - 1)
    }

    /// Records the path of a file that was read for the scene, or that would have been read if it existed.
    pub fn note_file(&mut self, path: impl Into<PathBuf>) {
        let path = path.into();
        if !self.files.contains(&path) {
            self.files.push(path);
        }
    }

    /// Returns the paths of all files that determine the scene, including files that do not exist.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Returns the text with the given id.
    pub fn get(&self, id: SourceId) -> &Source {
        &self.texts[id.0]
    }

    /// Converts a byte offset in a text to a line and a column.
    pub fn position(&self, source: SourceId, byte: usize) -> Position {
        let Source { text, lines, .. } = self.get(source);
        let byte = byte.min(text.len());
        let line = lines.partition_point(|&start| start <= byte);
        let start = lines[line - 1];
        // In UTF-8, each character has exactly one byte that is not a continuation byte.
        let column = text.as_bytes()[start..byte].iter().filter(|&&b| b & 0xC0 != 0x80).count();
        Position { line, column: 1 + column }
    }

    /// Returns the text of a line, with its line break. Lines count from 1.
    pub fn line(&self, source: SourceId, line: usize) -> &str {
        let Source { text, lines, .. } = self.get(source);
        let start = |line: usize| lines.get(line).copied().unwrap_or(text.len());
        &text[start(line.saturating_sub(1))..start(line)]
    }
}

impl Span {
    /// Makes a span from a text and a byte range.
    pub fn new(source: SourceId, range: std::ops::Range<usize>) -> Span {
        Span { source, start: range.start, end: range.end }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_count_lines_and_characters_from_one() {
        let mut sources = Sources::default();
        let id = sources.add("a.toml", "é = 1\nπr = 2\n");
        assert_eq!(sources.position(id, 0), Position { line: 1, column: 1 });
        assert_eq!(sources.position(id, 2), Position { line: 1, column: 2 });
        assert_eq!(sources.position(id, 9), Position { line: 2, column: 2 });
        assert_eq!(sources.position(id, 999), Position { line: 3, column: 1 });
    }
}
