//! Finds lines, table headers and entries in the text of a scene.

use super::super::Context;
use crate::diagnostic::{SourceId, Sources, Span};
use crate::scene::source::Entry;
use crate::scene::units;

/// Returns the source text of a span.
pub(super) fn raw<'a>(span: Span, context: &'a Context<'_>) -> &'a str {
    context.sources.raw(span)
}

/// Returns whether a source text is a file. False for a `--set` argument.
pub(in crate::scene::check) fn is_file(source: SourceId, sources: &Sources) -> bool {
    sources.get(source).name != "--set"
}

/// Returns the span of an entry from its key to the end of its value. `None` if they do not follow each other in one text.
pub(super) fn whole(entry: &Entry) -> Option<Span> {
    entry.name.span.to(entry.node.span)
}

/// Returns the end of the line that contains a table's name, if that line is the table's header. `None` if the line is no header.
pub(super) fn header_end(at: Span, context: &Context<'_>) -> Option<Span> {
    let is_header = context.sources.line_before(at).trim_start().starts_with('[');
    is_header.then(|| at.place_after(context.sources.line_after(at).len()))
}

/// Returns the span of the line that contains an entry, with its line break. `None` if the line has other content.
pub(super) fn whole_line(entry: Span, context: &Context<'_>) -> Option<Span> {
    let (before, rest) = (context.sources.line_before(entry), context.sources.after(entry));
    let length = rest.find('\n').map_or(rest.len(), |newline| newline + 1);
    let after = rest[..length].trim();
    let is_key = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.' | '"' | ' ' | '\t');
    let alone = before.chars().all(is_key) && (after.is_empty() || after.starts_with('#'));
    alone.then_some(entry.grown(before.len(), length))
}

/// Returns the span that must be removed to remove an entry: its whole line, or, in an inline table, the entry and one comma.
pub(super) fn removal(entry: Span, context: &Context<'_>) -> Option<Span> {
    whole_line(entry, context).or_else(|| {
        let (all, rest) = (context.sources.before(entry), context.sources.after(entry));
        let before = all.trim_end();
        if before.ends_with(',') {
            return Some(entry.grown(all.len() - before.len() + 1, 0));
        }
        let after = rest.trim_start().strip_prefix(',')?.trim_start();
        before.ends_with('{').then(|| entry.grown(0, rest.len() - after.len()))
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
    let prefix = context.sources.line_before(name);
    let after = if prefix.contains('{') { ", ".to_owned() } else { format!("\n{prefix}") };
    (name.place_before(0), format!("{entry}{after}"))
}
