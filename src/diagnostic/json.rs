//! Diagnostics as data, for editors.

use serde::Serialize;

use super::{Diagnostic, Label, Report, Severity, Sources};

/// One diagnostic as an editor wants it: the first place is its own, the others are related.
#[derive(Serialize)]
pub struct Entry<'a> {
    /// The path of the scene, where somebody sets it.
    #[serde(skip_serializing_if = "Option::is_none")]
    scene: Option<String>,
    severity: &'static str,
    code: &'static str,
    message: &'a str,
    help: Option<&'a str>,
    #[serde(flatten)]
    place: Option<Place<'a>>,
    related: Vec<Place<'a>>,
}

impl Entry<'_> {
    /// Says of which scene the diagnostic is: one without a place names no file.
    pub fn set_scene(&mut self, scene: String) {
        self.scene = Some(scene);
    }
}

/// A range of a text: lines and columns from 1, columns in characters, the end exclusive.
#[derive(Serialize)]
struct Place<'a> {
    file: &'a str,
    line: usize,
    column: usize,
    end_line: usize,
    end_column: usize,
    label: &'a str,
}

pub(super) fn entries<'a>(report: &'a Report) -> Vec<Entry<'a>> {
    let entry = |diagnostic: &'a Diagnostic| Entry {
        scene: None,
        severity: match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        },
        code: diagnostic.code,
        message: &diagnostic.message,
        help: diagnostic.help.as_deref(),
        place: diagnostic.labels.first().map(|label| place(label, &report.sources)),
        related: diagnostic.labels.iter().skip(1).map(|label| place(label, &report.sources)).collect(),
    };
    report.diagnostics.iter().map(entry).collect()
}

fn place<'a>(label: &'a Label, sources: &'a Sources) -> Place<'a> {
    let start = sources.position(label.span.source, label.span.start);
    let end = sources.position(label.span.source, label.span.end);
    Place {
        file: &sources.get(label.span.source).name,
        line: start.line,
        column: start.column,
        end_line: end.line,
        end_column: end.column,
        label: &label.text,
    }
}
