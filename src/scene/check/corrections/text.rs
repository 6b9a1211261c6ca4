//! Finds lines, table headers and entries in the text of a scene.

use super::super::Context;
use crate::diagnostic::{SourceId, Span};
use crate::scene::source::Entry;
use crate::scene::units;

/// Returns the source text of a span.
pub(super) fn raw<'a>(span: Span, context: &'a Context<'_>) -> &'a str {
    context.sources.get(span.source).text.get(span.start..span.end).unwrap_or_default()
}

/// Returns whether a source text is a file. False for a `--set` argument.
pub(in crate::scene::check) fn is_file(source: SourceId, context: &Context<'_>) -> bool {
    context.sources.get(source).name != "--set"
}

/// Returns the span of an entry from its key to the end of its value.
pub(super) fn whole(entry: &Entry) -> Span {
    Span { end: entry.node.span.end, ..entry.name.span }
}

/// Returns the end of the line that contains a table's name, if that line is the table's header. `None` if the line is no header.
pub(super) fn header_end(at: Span, context: &Context<'_>) -> Option<usize> {
    let text = &context.sources.get(at.source).text;
    let start = text[..at.start].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[at.end..].find('\n').map_or(text.len(), |newline| at.end + newline);
    text[start..end].trim_start().starts_with('[').then_some(end)
}

/// Returns the span of the line that contains an entry, with its line break. `None` if the line has other content.
pub(super) fn whole_line(entry: Span, context: &Context<'_>) -> Option<Span> {
    let text = &context.sources.get(entry.source).text;
    let start = text[..entry.start].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[entry.end..].find('\n').map_or(text.len(), |newline| entry.end + newline + 1);
    let after = text[entry.end..end].trim();
    let is_key = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.' | '"' | ' ' | '\t');
    let alone = text[start..entry.start].chars().all(is_key) && (after.is_empty() || after.starts_with('#'));
    alone.then_some(Span { start, end, ..entry })
}

/// Returns the span that must be removed to remove an entry: its whole line, or, in an inline table, the entry and one comma.
pub(super) fn removal(entry: Span, context: &Context<'_>) -> Option<Span> {
    whole_line(entry, context).or_else(|| {
        let text = &context.sources.get(entry.source).text;
        let before = text[..entry.start].trim_end();
        if before.ends_with(',') {
            return Some(Span { start: before.len() - 1, ..entry });
        }
        let after = text[entry.end..].trim_start().strip_prefix(',')?.trim_start();
        before.ends_with('{').then(|| Span { end: text.len() - after.len(), ..entry })
    })
}

/// Returns the text of a number or a formula in the given unit, for use as an operand in a larger formula. `None` for other values.
pub(super) fn operand(entry: &Entry, unit: &str, context: &Context<'_>) -> Option<String> {
    let text = match entry.node.as_str() {
        Some(text) => text.trim(),
        None if entry.node.as_number().is_some() => raw(entry.node.span, context),
        None => return None,
    };
    if let Some((number, of)) = units::quantity(text) {
        return units::converted(number, of, unit);
    }
    let is_plain = text.chars().all(|c| c.is_alphanumeric() || matches!(c, '.' | '_'));
    Some(if is_plain { text.to_owned() } else { format!("({text})") })
}

/// Returns the source position before an entry, and the text that inserts another entry of the same table at that position.
pub(in crate::scene::check) fn before(name: Span, entry: &str, context: &Context<'_>) -> (Span, String) {
    let text = &context.sources.get(name.source).text;
    let start = text[..name.start].rfind('\n').map_or(0, |newline| newline + 1);
    let prefix = &text[start..name.start];
    let place = Span { end: name.start, ..name };
    let after = if prefix.contains('{') { ", ".to_owned() } else { format!("\n{prefix}") };
    (place, format!("{entry}{after}"))
}
