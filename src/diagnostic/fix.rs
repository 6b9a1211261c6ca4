//! Corrections of errors that an editor or a script can apply.

use super::{Report, SourceId, Sources, Span};

/// A suggested correction of an error, given as replacements of text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fix {
    /// The replacements, which do not overlap. All of them must be applied together.
    pub edits: Vec<Edit>,
    /// True if a label of the diagnostic already shows the correction, so that it is not printed twice.
    pub is_said: bool,
}

impl Fix {
    /// Adds an edit. An insertion at an end of another edit becomes part of it, so that the order of edits does not matter to programs that
    /// apply them one by one.
    pub(super) fn add(&mut self, edit: Edit) {
        let Edit { span, text } = edit;
        let touches = |known: &&mut Edit| {
            known.span.source == span.source && (known.span.is_empty() || span.is_empty())
        };
        for known in self.edits.iter_mut().filter(touches) {
            if known.span.end == span.start {
                known.span.end = span.end;
                known.text.push_str(&text);
                return;
            }
            if span.end == known.span.start {
                known.span.start = span.start;
                known.text.insert_str(0, &text);
                return;
            }
        }
        self.edits.push(Edit { span, text });
    }

    /// Returns true if there are edits, all of them belong to the same text, and none of them overlap.
    pub fn is_applicable(&self, sources: &Sources) -> bool {
        let Some(first) = self.edits.first() else { return false };
        let is_apart = |number: usize, edit: &Edit| {
            self.edits.get(number + 1..).unwrap_or_default().iter().all(|other| !edit.overlaps(other))
        };
        self.edits.iter().enumerate().all(|(number, edit)| {
            edit.span.source == first.span.source && sources.has(edit.span) && is_apart(number, edit)
        })
    }

    /// Returns the fix with the edits of another one. `None` if some of their edits overlap without being equal.
    pub fn with(&self, other: &Fix) -> Option<Fix> {
        let mut both = self.clone();
        for edit in other.edits.iter().filter(|edit| !self.edits.contains(edit)) {
            if self.edits.iter().any(|own| own.overlaps(edit)) {
                return None;
            }
            both.add(edit.clone());
        }
        Some(both)
    }

    /// Returns the whole text after the edits, with the id of the text. `None` if the fix is not [applicable](Fix::is_applicable).
    pub fn applied(&self, sources: &Sources) -> Option<(SourceId, String)> {
        let source = self.edits.first().filter(|_| self.is_applicable(sources))?.span.source;
        Some((source, edited(&sources.get(source).text, self.edits.iter().collect())))
    }
}

/// The replacement of a range of text by new text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// The range to replace. An empty range is a position where text is inserted.
    pub span: Span,
    /// The new text for the range.
    pub text: String,
}

impl Report {
    /// Returns the text of `source` after applying all fixes in the report. If two fixes overlap, only the first one is applied.
    pub fn fixed(&self, source: SourceId) -> String {
        let mut edits: Vec<&Edit> = Vec::new();
        for fix in self.diagnostics.iter().filter_map(|diagnostic| diagnostic.fix.as_ref()) {
            // Two fixes may have an edit in common.
            let apart = |edit: &Edit| edits.iter().all(|other| *other == edit || !edit.overlaps(other));
            let is_here = fix.edits.iter().all(|edit| edit.span.source == source && apart(edit));
            if is_here && fix.is_applicable(&self.sources) {
                let further = fix.edits.iter().filter(|edit| !edits.contains(edit)).collect::<Vec<_>>();
                edits.extend(further);
            }
        }
        edited(&self.sources.get(source).text, edits)
    }
}

/// Returns a text after edits that do not overlap.
fn edited(text: &str, mut edits: Vec<&Edit>) -> String {
    edits.sort_by_key(|edit| edit.span);
    let mut text = text.to_owned();
    for edit in edits.iter().rev() {
        text.replace_range(edit.span.start..edit.span.end, &edit.text);
    }
    text
}

impl Edit {
    fn overlaps(&self, other: &Edit) -> bool {
        let (a, b) = (self.span, other.span);
        a == b || a.source == b.source && a.start < b.end && b.start < a.end
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Code, Diagnostic, Sources};
    use super::*;

    #[test]
    fn fixes_are_applied_together_and_of_two_that_overlap_the_first() {
        let mut sources = Sources::default();
        let id = sources.add("scene.toml", "a = 1\nb = 22\n");
        let error = |range, text: &str| {
            Diagnostic::error(Code::UnknownKey, "wrong")
                .at(Span::new(id, 0..1), "")
                .fix(Span::new(id, range), text)
        };
        let diagnostics =
            vec![error(10..12, "333"), error(4..5, "0"), error(10..11, "9"), error(13..13, "c = 4\n")];
        let report = Report { sources, diagnostics };
        assert_eq!(report.fixed(id), "a = 0\nb = 333\nc = 4\n");
    }
}
