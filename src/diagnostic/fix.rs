//! Corrections of errors that an editor or a script can apply.

use super::{Report, SourceId, Span};

/// A suggested correction of an error, given as replacements of text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fix {
    /// The replacements, which do not overlap. All of them must be applied together.
    pub edits: Vec<Edit>,
    /// True if a label of the diagnostic already shows the correction, so that it is not printed twice.
    pub is_said: bool,
}

impl Fix {
    /// Returns true if there are edits, and all of them belong to the same text.
    pub(super) fn is_in_one_text(&self) -> bool {
        let first = self.edits.first();
        first.is_some_and(|first| self.edits.iter().all(|edit| edit.span.source == first.span.source))
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
            let apart = |edit: &Edit| edits.iter().all(|other| !edit.overlaps(other));
            if fix.edits.iter().all(|edit| edit.span.source == source && apart(edit)) {
                edits.extend(&fix.edits);
            }
        }
        edits.sort_by_key(|edit| edit.span);
        let mut text = self.sources.get(source).text.clone();
        for edit in edits.iter().rev() {
            text.replace_range(edit.span.start..edit.span.end, &edit.text);
        }
        text
    }
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
