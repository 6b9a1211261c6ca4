//! Finds errors in brackets, quotes and dotted keys that the TOML parser does not report well.
//!
//! The parser accepts TOML 1.1. This module refuses what TOML 1.1 adds to TOML 1.0, because most editors do not support it yet. If a
//! bracket is never closed, the parser reads on to the end of the file and reports many lines; the only useful position is that of the
//! bracket. The parser also refuses a key with too many parts, but does not report its position.

use toml_parser::decoder::Encoding;
use toml_parser::parser::{Event, EventKind, RecursionGuard, parse_document};

use crate::diagnostic::{Code, Diagnostic, SourceId, Span};

/// The maximum nesting depth of lists and tables, as in the crate `toml`.
const MAX_DEPTH: u32 = 80;

/// The errors that were found in the brackets, quotes and dotted keys of a text.
pub(super) struct Brackets {
    /// The errors for syntax that only TOML 1.1 allows.
    pub(super) too_new: Vec<Diagnostic>,
    /// The error for the first bracket or quote that is never closed. The parsed values after it are unreliable.
    pub(super) unclosed: Option<Diagnostic>,
    /// The errors for dotted keys with too many parts.
    pub(super) deep_keys: Vec<Diagnostic>,
}

/// Finds the errors in the brackets, quotes and dotted keys of a text.
pub(super) fn look(text: &str, source: SourceId) -> Brackets {
    let tokens = toml_parser::Source::new(text).lex().into_vec();
    let found = Brackets { too_new: Vec::new(), unclosed: None, deep_keys: Vec::new() };
    let mut looker = BracketChecker { text, source, open: Vec::new(), key: None, found };
    let mut see = |event: Event| looker.see(event);
    parse_document(&tokens, &mut RecursionGuard::new(&mut see, MAX_DEPTH), &mut ());
    looker.found
}

/// A list or an inline table that is still open during the parse.
struct Open {
    start: usize,
    is_list: bool,
    /// The most recent comma in the list or table. `None` if a value follows the comma.
    comma: Option<toml_parser::Span>,
    /// True if the list or table contains a line break that is not within an inner list or table.
    several_lines: bool,
}

/// A dotted key that is being read.
struct DottedKey {
    start: usize,
    parts: u32,
    /// True if the last token was a dot, so that another part of the key must follow.
    goes_on: bool,
}

struct BracketChecker<'a> {
    text: &'a str,
    source: SourceId,
    open: Vec<Open>,
    key: Option<DottedKey>,
    found: Brackets,
}

impl BracketChecker<'_> {
    fn see(&mut self, event: Event) {
        let span = event.span();
        match event.kind() {
            kind @ (EventKind::ArrayOpen | EventKind::InlineTableOpen) => {
                self.no_comma();
                let is_list = kind == EventKind::ArrayOpen;
                self.open.push(Open { start: span.start(), is_list, comma: None, several_lines: false });
            }
            // After unreadable text, the parser may report closing brackets without opening ones.
            EventKind::ArrayClose if self.open.last().is_some_and(|open| open.is_list) => {
                self.close(span, "list", "]");
            }
            EventKind::InlineTableClose if self.open.last().is_some_and(|open| !open.is_list) => {
                if let (Some(table), false) = (self.open.last(), span.is_empty()) {
                    let (lines, comma, start) = (table.several_lines, table.comma, table.start);
                    if lines {
                        let help = "write it on one line, or as a `[table]` of its own";
                        self.too_new("a table in braces has to end on its line", start..start + 1, help);
                    }
                    if let Some(comma) = comma {
                        let place = comma.start()..comma.end();
                        self.too_new("a table in braces cannot end with a comma", place, "leave it out");
                    }
                }
                self.close(span, "table", "}");
            }
            EventKind::ValueSep => {
                if let Some(open) = self.open.last_mut() {
                    open.comma = Some(span);
                }
            }
            EventKind::Newline => {
                if let Some(open) = self.open.last_mut() {
                    open.several_lines = true;
                }
            }
            EventKind::Scalar => {
                self.no_comma();
                self.string(span, event.encoding());
            }
            EventKind::SimpleKey => {
                self.no_comma();
                self.string(span, event.encoding());
                self.part_of_key(span);
            }
            EventKind::KeySep => {
                if let Some(key) = &mut self.key {
                    key.goes_on = true;
                }
            }
            _ => {}
        }
    }

    fn part_of_key(&mut self, span: toml_parser::Span) {
        let before = self.key.take().filter(|key| key.goes_on);
        let (start, parts) = before.map_or((span.start(), 1), |key| (key.start, key.parts + 1));
        self.key = Some(DottedKey { start, parts, goes_on: false });
        if parts == MAX_DEPTH + 1 {
            let place = Span::new(self.source, start..span.end());
            let error = Diagnostic::error(Code::TomlSyntax, format!("a key has more than {MAX_DEPTH} parts"));
            self.found.deep_keys.push(error.at(place, "").help("no key of a scene is so deep"));
        }
    }

    fn no_comma(&mut self) {
        if let Some(open) = self.open.last_mut() {
            open.comma = None;
        }
    }

    /// Handles the end of a list or an inline table. For a missing closing bracket, the parser gives an empty span. Then the list or table
    /// is reported as never closed.
    fn close(&mut self, span: toml_parser::Span, noun: &str, bracket: &str) {
        if let (Some(open), true) = (self.open.pop(), span.is_empty()) {
            self.unclosed(open.start..open.start + 1, noun, bracket);
        }
    }

    fn unclosed(&mut self, range: std::ops::Range<usize>, noun: &str, closing: &str) {
        // The parser reports open brackets from the inside out. The error that is kept is the one for the outermost bracket, the first in
        // the text.
        if self
            .found
            .unclosed
            .as_ref()
            .and_then(Diagnostic::span)
            .is_none_or(|span| Span::new(self.source, range.clone()) < span)
        {
            let error = Diagnostic::error(Code::TomlUnclosed, format!("the {noun} is never closed"));
            let label = format!("its `{closing}` is missing");
            self.found.unclosed = Some(error.at(Span::new(self.source, range), label));
        }
    }

    fn string(&mut self, span: toml_parser::Span, encoding: Option<Encoding>) {
        let raw = self.text.get(span.start()..span.end()).unwrap_or_default();
        let quotes = match encoding {
            Some(Encoding::MlBasicString) => "\"\"\"",
            Some(Encoding::MlLiteralString) => "'''",
            _ => "",
        };
        if !quotes.is_empty() && (raw.len() < 6 || !raw.ends_with(quotes)) {
            self.unclosed(span.start()..span.start() + quotes.len(), "string", quotes);
        }
        if matches!(encoding, Some(Encoding::BasicString | Encoding::MlBasicString)) {
            self.escapes(raw, span.start());
        }
    }

    fn escapes(&mut self, raw: &str, start: usize) {
        let mut bytes = raw.bytes().enumerate();
        while let Some((at, byte)) = bytes.next() {
            if byte == b'\\'
                && let Some((_, escaped @ (b'e' | b'x'))) = bytes.next()
            {
                let message = format!("a string cannot contain the escape `\\{}`", char::from(escaped));
                let help = "write `\\u` and four hexadecimal digits, or `\\\\` for a backslash";
                self.too_new(&message, start + at..start + at + 2, help);
            }
        }
    }

    fn too_new(&mut self, message: &str, range: std::ops::Range<usize>, help: &str) {
        let error = Diagnostic::error(Code::Toml11, message);
        let error = error.at(Span::new(self.source, range), "only TOML 1.1 has this; a scene is TOML 1.0");
        self.found.too_new.push(error.help(help));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Sources;

    fn places(text: &str) -> (Vec<usize>, Option<usize>) {
        let mut sources = Sources::default();
        let found = look(text, sources.add("scene.toml", text));
        let start = |diagnostic: &Diagnostic| sources.before(diagnostic.span().unwrap()).len();
        (found.too_new.iter().map(start).collect(), found.unclosed.as_ref().map(start))
    }

    #[test]
    fn what_is_new_in_toml_1_1_is_found() {
        for (text, place) in [
            ("a = {\nb = 1 }", 4),
            ("a = { b = 1, }", 11),
            ("a = { b = [1], # c\n }", 4),
            ("a = \"\\e\"", 5),
            ("a = \"\"\"\\\\\\x41\"\"\"", 9),
            ("\"\\e\" = 1", 1),
            ("a = [{ b = { c = 1, } }]", 18),
        ] {
            assert_eq!(places(text).0.first(), Some(&place), "{text}");
        }
    }

    #[test]
    fn toml_1_0_that_looks_like_it_passes() {
        for text in [
            "a = {}",
            "a = { b = [\n1,\n], c = '\\e' }",
            "a = \"\\\\e { , }\" # { \\e , }",
            "a = { b = \"\"\"\n\"\"\" }",
            "a = [1,\n]",
        ] {
            assert_eq!(places(text), (vec![], None), "{text}");
        }
    }

    #[test]
    fn the_first_bracket_that_is_never_closed_is_found() {
        for (text, place) in [
            ("a = [1", 4),
            ("a = [[1]\nb = [2]", 4),
            ("a = { b = [", 4),
            ("a = [1]\nb = {", 12),
            ("a = '''b", 4),
        ] {
            assert_eq!(places(text).1, Some(place), "{text}");
        }
    }
}
