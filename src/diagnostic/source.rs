//! The texts of a scene, and positions in them.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

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

/// All texts of one scene: its files and its `--set` arguments. The scene's own file is the first text. Clones share the texts.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    texts: Vec<Arc<Source>>,
    files: Vec<PathBuf>,
}

/// The index of a text within its [`Sources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceId(usize);

/// A byte range in one of the texts of a scene ([`Sources`]).
///
/// The offsets are not public: an offset alone does not say in which text it counts. Other spans are made from a span by lengths relative to
/// it, so they are always in the same text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// The text that contains the range.
    pub(super) source: SourceId,
    /// The offset of the first byte of the range.
    pub(super) start: usize,
    /// The offset after the last byte of the range.
    pub(super) end: usize,
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
        self.texts.push(Arc::new(Source { name: name.into(), lines: lines.collect(), text }));
        SourceId(self.texts.len() - 1)
    }

    /// Returns whether a word stands in one of the texts.
    pub(crate) fn mentions(&self, word: &str) -> bool {
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let stands_in = |text: &str| {
            text.match_indices(word).any(|(at, _)| {
                !text[..at].ends_with(is_part) && !text[at + word.len()..].starts_with(is_part)
            })
        };
        self.texts.iter().any(|source| stands_in(&source.text))
    }

    /// Replaces the path of each file by its name, for readers on other machines.
    #[cfg(feature = "render")]
    pub(crate) fn forget_folders(&mut self) {
        for source in &mut self.texts {
            if let Some(name) = std::path::Path::new(&source.name).file_name() {
                let name = name.to_string_lossy().into_owned();
                *source = Arc::new(Source { name, ..(**source).clone() });
            }
        }
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

    /// Returns the text of the scene's own file, not of a file that it includes. `None` if it could not be read.
    pub fn of_scene(&self) -> Option<&Source> {
        self.texts.first().map(|source| &**source)
    }

    /// Returns the text with the given id.
    pub fn get(&self, id: SourceId) -> &Source {
        &self.texts[id.0]
    }

    /// Returns true if a span is a range of whole characters of its text.
    pub(super) fn has(&self, span: Span) -> bool {
        self.get(span.source).text.get(span.start..span.end).is_some()
    }

    /// Returns the text of a span, as it is written in the scene.
    pub fn raw(&self, span: Span) -> &str {
        self.get(span.source).text.get(span.start..span.end).unwrap_or_default()
    }

    /// Returns all of the text before a span.
    pub fn before(&self, span: Span) -> &str {
        self.get(span.source).text.get(..span.start).unwrap_or_default()
    }

    /// Returns all of the text after a span.
    pub fn after(&self, span: Span) -> &str {
        self.get(span.source).text.get(span.end..).unwrap_or_default()
    }

    /// Returns the range of a span, as editors write it.
    pub fn range(&self, span: Span) -> super::Range<'_> {
        super::json::range(span, self)
    }

    /// Returns the text between the beginning of the line in which a span begins, and the span.
    pub fn line_before(&self, span: Span) -> &str {
        let before = self.before(span);
        before.rfind('\n').map_or(before, |newline| &before[newline + 1..])
    }

    /// Returns the text between a span and the end of the line in which it ends, without the line break.
    pub fn line_after(&self, span: Span) -> &str {
        let after = self.after(span);
        after.find('\n').map_or(after, |newline| &after[..newline])
    }

    /// Returns the line and the column at which a span begins.
    pub fn start(&self, span: Span) -> Position {
        self.position(span.source, span.start)
    }

    /// Returns the line and the column at which a span ends.
    pub fn end(&self, span: Span) -> Position {
        self.position(span.source, span.end)
    }

    /// Converts a byte offset in a text to a line and a column.
    pub(super) fn position(&self, source: SourceId, byte: usize) -> Position {
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
    /// Makes a span from a text and a byte range in it.
    pub fn new(source: SourceId, range: Range<usize>) -> Span {
        Span { source, start: range.start, end: range.end }
    }

    /// Returns the text that contains the span.
    pub fn source(self) -> SourceId {
        self.source
    }

    /// Returns the number of bytes.
    pub fn len(self) -> usize {
        self.end.saturating_sub(self.start)
    }

    /// Returns true if the span is a position between two bytes.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// Returns the span from the start of this span to the end of a later one. `None` if the other one is in another text or ends before.
    pub fn to(self, later: Span) -> Option<Span> {
        (self.source == later.source && self.start <= later.end).then_some(Span { end: later.end, ..self })
    }

    /// Returns the span moved by `by` bytes towards the end of the text.
    #[must_use]
    pub(crate) fn moved(self, by: usize) -> Span {
        Span { start: self.start + by, end: self.end + by, ..self }
    }

    /// Returns a part of the span. The range counts from the start of the span.
    #[must_use]
    pub fn part(self, range: Range<usize>) -> Span {
        Span { start: self.start + range.start, end: self.start + range.end, ..self }
    }

    /// Returns the span together with `before` bytes before it and `after` bytes after it.
    #[must_use]
    pub fn grown(self, before: usize, after: usize) -> Span {
        Span { start: self.start.saturating_sub(before), end: self.end + after, ..self }
    }

    /// Returns the empty span `bytes` before the start of the span.
    #[must_use]
    pub fn place_before(self, bytes: usize) -> Span {
        let start = self.start.saturating_sub(bytes);
        Span { start, end: start, ..self }
    }

    /// Returns the empty span `bytes` after the end of the span.
    #[must_use]
    pub fn place_after(self, bytes: usize) -> Span {
        let end = self.end + bytes;
        Span { start: end, end, ..self }
    }

    /// Returns the empty span at the beginning of the text that contains the span.
    #[must_use]
    pub fn top_of_text(self) -> Span {
        Span { start: 0, end: 0, ..self }
    }

    /// Returns true if the other span is in the same text and within this span.
    pub fn contains(self, other: Span) -> bool {
        self.source == other.source && self.start <= other.start && other.end <= self.end
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
