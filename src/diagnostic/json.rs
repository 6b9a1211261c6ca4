//! Converts diagnostics to data that editors read, such as JSON.

use serde::Serialize;

use super::{Diagnostic, Edit, Label, Report, Severity, Sources, Span};

/// A diagnostic in the format of editors. The first labeled range is that of the error; all further ranges are `related`.
#[derive(Serialize)]
pub struct Entry<'a> {
    /// The path of the scene, if [`Entry::set_scene`] has set it.
    #[serde(skip_serializing_if = "Option::is_none")]
    scene: Option<String>,
    severity: &'static str,
    code: &'static str,
    message: &'a str,
    help: Option<&'a str>,
    #[serde(flatten)]
    place: Option<LabeledRange<'a>>,
    related: Vec<LabeledRange<'a>>,
    /// The replacements that correct the error. Empty if no correction is known.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    fix: Vec<Replacement<'a>>,
}

impl Entry<'_> {
    /// Sets the path of the scene. It identifies the file of a diagnostic that has no range in a text.
    pub fn set_scene(&mut self, scene: String) {
        self.scene = Some(scene);
    }
}

#[derive(Serialize)]
struct LabeledRange<'a> {
    #[serde(flatten)]
    range: Range<'a>,
    label: &'a str,
}

/// A range of text and the new text that replaces it.
#[derive(Serialize)]
struct Replacement<'a> {
    #[serde(flatten)]
    range: Range<'a>,
    text: &'a str,
}

/// A range of a text. Lines and columns count from 1, columns are in characters, and the end is exclusive.
#[derive(Serialize)]
pub struct Range<'a> {
    file: &'a str,
    line: usize,
    column: usize,
    end_line: usize,
    end_column: usize,
}

pub(super) fn entries<'a>(report: &'a Report) -> Vec<Entry<'a>> {
    let entry = |diagnostic: &'a Diagnostic| Entry {
        scene: None,
        severity: match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        },
        code: diagnostic.code.name(),
        message: &diagnostic.message,
        help: diagnostic.help.as_deref(),
        place: diagnostic.labels.first().map(|label| place(label, &report.sources)),
        related: diagnostic.labels.iter().skip(1).map(|label| place(label, &report.sources)).collect(),
        fix: diagnostic
            .fix
            .iter()
            .flat_map(|fix| &fix.edits)
            .map(|edit| replacement(edit, &report.sources))
            .collect(),
    };
    report.diagnostics.iter().map(entry).collect()
}

fn place<'a>(label: &'a Label, sources: &'a Sources) -> LabeledRange<'a> {
    LabeledRange { range: range(label.span, sources), label: &label.text }
}

fn replacement<'a>(edit: &'a Edit, sources: &'a Sources) -> Replacement<'a> {
    Replacement { range: range(edit.span, sources), text: &edit.text }
}

pub(super) fn range(span: Span, sources: &Sources) -> Range<'_> {
    let start = sources.start(span);
    let end = sources.end(span);
    Range {
        file: &sources.get(span.source).name,
        line: start.line,
        column: start.column,
        end_line: end.line,
        end_column: end.column,
    }
}
