//! Corrects keys that stand one table too deep, such as `repeat` in the `rod` of a joint instead of the joint itself.

use super::super::Context;
use super::key_of;
use super::missing::insertion;
use super::text::{header_end, raw, removal, whole};
use crate::diagnostic::{Code, Span};
use crate::scene::grammar::{KeySpec, TableSpec};
use crate::scene::source::{Entry, Table};

/// A named table, such as a body, a force or a joint, to which a misplaced key of an inner table may belong.
pub(in crate::scene::check) struct Owner<'a> {
    pub(in crate::scene::check) table: &'a Table,
    pub(in crate::scene::check) spec: &'static TableSpec,
    /// The span of the table's name.
    pub(in crate::scene::check) at: Span,
    /// The header of the table, such as `[joint.string]`.
    pub(in crate::scene::check) path: &'a str,
}

impl Owner<'_> {
    /// Finds unknown keys of inner tables that are keys of this table, and adds fixes that move them. Changes only the diagnostics from
    /// index `before` on.
    pub(in crate::scene::check) fn correct_deep(&self, before: usize, context: &mut Context<'_>) {
        for number in before..context.diagnostics.len() {
            let error = &context.diagnostics[number];
            if error.code != Code::UnknownKey || error.fix.is_some() || error.labels.len() != 1 {
                continue;
            }
            let Some(entry) = self.table.entries.iter().find_map(|entry| find(entry, error.labels[0].span))
            else {
                continue;
            };
            let Some(key) = key_of(&entry.name.text, self.spec) else { continue };
            if !key.kind.takes(&entry.node.value) {
                continue;
            }
            let edits = self.edits(entry, key, context);
            let error = &mut context.diagnostics[number];
            error.labels[0].text = format!("`{}` belongs in {}", key.name, self.path);
            error.help = None;
            let edits = edits.into_iter().flatten();
            *error = edits.fold(error.clone(), |error, (span, text)| error.fix(span, text));
        }
    }

    /// Returns the edits that move an entry to this table. `None` if the table has this key already, or if the position for the entry is
    /// unclear.
    fn edits(&self, entry: &Entry, key: &KeySpec, context: &Context<'_>) -> Option<[(Span, String); 2]> {
        if self.table.get(key.name).is_some() || entry.name.span.source() != self.at.source() {
            return None;
        }
        let line = format!("{} = {}", key.name, raw(entry.node.span, context));
        let place = insertion(self.at, &line, context).or_else(|| self.header_above(&line, context))?;
        Some([(removal(whole(entry)?, context)?, String::new()), place])
    }

    /// Returns an edit that inserts a new header for this table, with `line` below it, above the header of the inner table. `None` if the
    /// table has a header.
    fn header_above(&self, line: &str, context: &Context<'_>) -> Option<(Span, String)> {
        let text = &context.sources.get(self.at.source()).text;
        header_end(self.at, context)?;
        let has_header = text.lines().any(|line| line.trim_start().starts_with(self.path));
        let place = self.at.place_before(context.sources.line_before(self.at).len());
        (!has_header).then(|| (place, format!("{}\n{line}\n\n", self.path)))
    }
}

/// Finds the entry whose key has the span `at`, in the tables below `entry`.
fn find(entry: &Entry, at: Span) -> Option<&Entry> {
    let inner = entry.node.as_table()?;
    inner.entries.iter().find_map(|entry| if entry.name.span == at { Some(entry) } else { find(entry, at) })
}
