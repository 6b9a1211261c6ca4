//! Parses TOML into the tree of a scene.

use std::num::IntErrorKind;

use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

use super::{Entry, Name, Node, Table, Value, brackets, corrections, foreign, syntax};
use crate::diagnostic::{Code, Diagnostic, SourceId, Span};

/// Parses a text. Reports syntax errors as diagnostics, and returns a tree of the readable values.
pub fn parse(text: &str, source: SourceId, diagnostics: &mut Vec<Diagnostic>) -> Node {
    let (document, mut errors) = DeTable::parse_recoverable(text);
    errors.retain(|error| error.message() != syntax::DEEP_KEY);
    if let (Some(error), Some(foreign)) = (errors.first(), foreign::recognize(text)) {
        diagnostics.push(not_toml(error, foreign, text, source));
        return Node { span: Span::new(source, 0..text.len()), value: Value::Table(Table::default()) };
    }
    errors.sort_by_key(|error| error.span().map(|range| range.start));
    let brackets = brackets::look(text, source);
    let span = Span::new(source, 0..text.len());
    let mut reader = Reader {
        source,
        wrong: errors.iter().filter_map(|error| Some(error.span()?.start)).collect(),
        diagnostics,
    };
    let root = Node { span, value: Value::Table(reader.table(document.get_ref())) };

    // Errors after a bracket that is never closed are consequences of it.
    let unclosed = brackets.unclosed.as_ref().and_then(Diagnostic::span);
    let is_before = |range: std::ops::Range<usize>| {
        unclosed.is_none_or(|unclosed| Span::new(source, range.start..range.start) < unclosed.place_before(0))
    };
    let mut last_line = None;
    for error in errors.iter().filter(|error| error.span().is_none_or(is_before)) {
        // A second syntax error in the same line is usually a consequence of the first, so it is dropped.
        let before = |range: std::ops::Range<usize>| text.as_bytes().get(..range.start).unwrap_or_default();
        let line = error.span().map(|range| before(range).iter().rposition(|&byte| byte == b'\n'));
        if line.is_none() || line != last_line {
            let diagnostic = syntax::diagnose(error, text, source);
            diagnostics.push(match error.span() {
                Some(range) => corrected(diagnostic, range.start, text, source),
                None => diagnostic,
            });
        }
        last_line = line;
    }
    diagnostics.extend(brackets.unclosed);
    diagnostics.extend(brackets.too_new);
    diagnostics.extend(brackets.deep_keys);
    root
}

/// Creates the error for a text in YAML or JSON. Its fix replaces the text by the equivalent TOML.
fn not_toml(error: &Error, foreign: foreign::Foreign, text: &str, source: SourceId) -> Diagnostic {
    let line = line_at(text, error.span().map_or(0, |range| range.start));
    let (start, end) = (line.start, line.end);
    let message = format!("this is {}; a scene is TOML", foreign.format);
    let error = Diagnostic::error(Code::TomlSyntax, message);
    let error =
        error.at(Span::new(source, start..end), "TOML writes `key = value`, below headers in brackets");
    match foreign.toml {
        Some(toml) => error.fix(Span::new(source, 0..text.len()), toml),
        None => error,
    }
}

/// Adds a fix with the corrected line, if the intended text is clear. `at` is the byte offset of the error.
fn corrected(mut diagnostic: Diagnostic, at: usize, text: &str, source: SourceId) -> Diagnostic {
    let line = line_at(text, at);
    let is_duplicate = diagnostic.code == Code::DuplicateKey;
    let Some(corrected) = corrections::correct(&text[line.clone()]).filter(|_| !is_duplicate) else {
        return diagnostic;
    };
    diagnostic.help = Some(corrected.why.to_owned());
    let (start, end) = (line.start + corrected.range.start, line.start + corrected.range.end);
    diagnostic.fix(Span::new(source, start..end), corrected.text)
}

/// Returns the byte range of the line that contains the byte `at`, without its line break.
fn line_at(text: &str, at: usize) -> std::ops::Range<usize> {
    let bytes = text.as_bytes();
    let at = at.min(bytes.len());
    let start = bytes[..at].iter().rposition(|&byte| byte == b'\n').map_or(0, |newline| newline + 1);
    let end =
        bytes[start..].iter().position(|&byte| byte == b'\n').map_or(bytes.len(), |length| start + length);
    start..end
}

/// Parses a single TOML value, such as the text after `key = `.
pub(super) fn parse_value(text: &str, source: SourceId) -> Result<(Node, Vec<Diagnostic>), Error> {
    let value = DeValue::parse(text)?;
    let mut diagnostics = Vec::new();
    let node = Reader { source, wrong: Vec::new(), diagnostics: &mut diagnostics }.node(&value);
    Ok((node, diagnostics))
}

struct Reader<'a> {
    source: SourceId,
    /// The byte offsets of syntax errors, in increasing order. A value that contains one of them is unreliable.
    wrong: Vec<usize>,
    diagnostics: &'a mut Vec<Diagnostic>,
}

impl Reader<'_> {
    fn table(&mut self, table: &DeTable<'_>) -> Table {
        let entry = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| {
            let text: &std::borrow::Cow<'_, str> = key.get_ref();
            let name = Name { span: Span::new(self.source, key.span()), text: text.as_ref().into() };
            Entry { name, node: self.node(value) }
        };
        // The parser sorts a table by its keys; sorting by position restores the order of the file.
        let mut in_order: Vec<_> = table.iter().collect();
        in_order.sort_by_key(|(key, _)| key.span().start);
        Table { entries: in_order.into_iter().map(entry).collect() }
    }

    fn node(&mut self, value: &Spanned<DeValue<'_>>) -> Node {
        let span = Span::new(self.source, value.span());
        let value = match value.get_ref() {
            DeValue::Array(items) => self.list(items),
            DeValue::Table(table) => Value::Table(self.table(table)),
            // For a missing value, the parser inserts a placeholder with an empty span.
            _ if span.is_empty() || self.is_wrong(value.span()) => Value::Invalid,
            DeValue::String(text) => Value::String(text.as_ref().into()),
            DeValue::Integer(digits) => match i64::from_str_radix(digits.as_str(), digits.radix()) {
                Ok(number) => Value::Integer(number),
                Err(error) => match error.kind() {
                    IntErrorKind::PosOverflow | IntErrorKind::NegOverflow => self.too_large(span),
                    _ => Value::Invalid,
                },
            },
            DeValue::Float(digits) => match digits.as_str().parse::<f64>() {
                // A number such as `1e999` is reported as too large. A literal `inf` may be intended, and the later check of the key
                // reports it.
                Ok(number) if number.is_infinite() && !digits.as_str().contains("inf") => {
                    self.too_large(span)
                }
                Ok(number) => Value::Float(number),
                Err(_) => Value::Invalid,
            },
            DeValue::Boolean(value) => Value::Boolean(*value),
            DeValue::Datetime(_) => Value::Datetime,
        };
        Node { span, value }
    }

    /// Reads a list. If an item is invalid, the whole list becomes [`Value::Invalid`].
    fn list(&mut self, items: &[Spanned<DeValue<'_>>]) -> Value {
        let items: Vec<Node> = items.iter().map(|item| self.node(item)).collect();
        if items.iter().any(|item| matches!(item.value, Value::Invalid)) {
            return Value::Invalid;
        }
        Value::Array(items.into())
    }

    fn is_wrong(&self, range: std::ops::Range<usize>) -> bool {
        let next = self.wrong.partition_point(|&place| place < range.start);
        self.wrong.get(next).is_some_and(|&place| place <= range.end)
    }

    fn too_large(&mut self, span: Span) -> Value {
        let message = "this number is too large";
        let help = "the largest whole number is 2^63 - 1, the largest other number about 1.8e308";
        self.diagnostics.push(Diagnostic::error(Code::NumberTooLarge, message).at(span, "").help(help));
        Value::Invalid
    }
}
