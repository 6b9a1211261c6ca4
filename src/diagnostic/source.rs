//! The texts of a scene, and places in them.

use std::path::PathBuf;

/// One text of a scene: its file, or one `--set` argument.
#[derive(Clone, Debug)]
pub struct Source {
    /// The name shown in front of line and column: the file's path as it was given, or `--set`.
    pub name: String,
    /// The whole text.
    pub text: String,
    /// The first byte of each line.
    lines: Vec<usize>,
}

/// The texts of one scene. The scene's own file is the first.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    texts: Vec<Source>,
    files: Vec<PathBuf>,
}

/// The number of a text within its [`Sources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceId(usize);

/// A range of bytes in one of the [`Sources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// The text that the range lies in.
    pub source: SourceId,
    /// The first byte.
    pub start: usize,
    /// The byte after the last one.
    pub end: usize,
}

/// A line and a column in the convention of people and editors: from 1, columns in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1.
    pub column: usize,
}

impl Sources {
    /// Adds a text and returns its number.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<String>) -> SourceId {
        let text = text.into();
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(newline, _)| newline + 1));
        self.texts.push(Source { name: name.into(), lines: lines.collect(), text });
        SourceId(self.texts.len() - 1)
    }

    /// Records a file that was read, or that would have been read if it existed.
    pub fn note_file(&mut self, path: impl Into<PathBuf>) {
        let path = path.into();
        if !self.files.contains(&path) {
            self.files.push(path);
        }
    }

    /// The files that determine the scene, including missing ones.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// The text with the given number.
    pub fn get(&self, id: SourceId) -> &Source {
        &self.texts[id.0]
    }

    /// The line and column of a byte in a text.
    pub fn position(&self, source: SourceId, byte: usize) -> Position {
        let Source { text, lines, .. } = self.get(source);
        let byte = byte.min(text.len());
        let line = lines.partition_point(|&start| start <= byte);
        let start = lines[line - 1];
        // Every character has exactly one byte that is not a continuation byte.
        let column = text.as_bytes()[start..byte].iter().filter(|&&b| b & 0xC0 != 0x80).count();
        Position { line, column: 1 + column }
    }

    /// The text of a line, counted from 1.
    pub fn line(&self, source: SourceId, line: usize) -> &str {
        let Source { text, lines, .. } = self.get(source);
        let start = |line: usize| lines.get(line).copied().unwrap_or(text.len());
        &text[start(line.saturating_sub(1))..start(line)]
    }
}

impl Span {
    /// The range `start..end` of a text.
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
