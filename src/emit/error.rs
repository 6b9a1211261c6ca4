//! The errors of writing a script.

use crate::diagnostic::{Code, Diagnostic, Report, Span};

/// The reason why a script cannot be written.
#[derive(Clone, Debug)]
pub enum EmitError {
    /// A coordinate is not finite in POV-Ray units.
    OutOfRange {
        /// The thing at this coordinate: a body, a light, or the camera.
        what: String,
        /// The time, s.
        time: f64,
    },
    /// The camera comes too close to the point that it looks at: POV-Ray cannot tell the two apart.
    Blind {
        /// The time, s.
        time: f64,
    },
    /// POV-Ray cannot tell apart things that the scene shows. The report names them and their places in the scene.
    Indistinct(Report),
    /// A template fails. The report names the place in the template.
    Template(Report),
}

impl EmitError {
    /// The code of the error's diagnostic.
    pub fn code(&self) -> Code {
        match self {
            EmitError::Indistinct(_) => Code::Indistinct,
            EmitError::OutOfRange { .. } | EmitError::Blind { .. } | EmitError::Template(_) => {
                Code::CannotEmit
            }
        }
    }

    /// The error as a report. The diagnostic has a place if the error has one.
    pub fn report(&self) -> Report {
        match self {
            EmitError::Template(report) | EmitError::Indistinct(report) => report.clone(),
            EmitError::OutOfRange { .. } | EmitError::Blind { .. } => {
                Report::of_error(self.code(), self.to_string())
            }
        }
    }

    /// Converts the error of a template, with the template's file, text and place.
    pub(super) fn of_template(
        error: &minijinja::Error,
        text_of: impl Fn(&str) -> Option<(String, String)>,
    ) -> EmitError {
        // The innermost error is the mistake. The outer errors name the templates that include the faulty template.
        let mut innermost = error;
        let mut message = error.to_string();
        let mut cause = std::error::Error::source(error);
        while let Some(inner) = cause {
            message = inner.to_string();
            if let Some(error) = inner.downcast_ref::<minijinja::Error>() {
                innermost = error;
            }
            cause = inner.source();
        }
        // The report shows the place, so the message omits it. A detail for an operation that jabuka refuses is a full
        // message.
        if let (Some(detail), true) = (innermost.detail(), innermost.name().is_some()) {
            message = match innermost.kind() {
                minijinja::ErrorKind::BadSerialization => detail.to_owned(),
                kind => format!("{kind}: {detail}"),
            };
        }
        let mut report = Report::default();
        let diagnostic = Diagnostic::error(Code::BadTemplate, message);
        let place = innermost.name().and_then(text_of);
        report.diagnostics.push(match place {
            None => diagnostic,
            Some((path, text)) => {
                let range =
                    innermost.range().or_else(|| innermost.line().map(|line| line_range(&text, line)));
                let id = report.sources.add(path, text);
                diagnostic.at(Span::new(id, range.unwrap_or_default()), "")
            }
        });
        EmitError::Template(report)
    }
}

/// The range of a line, bytes. Lines are counted from 1.
fn line_range(text: &str, line: usize) -> std::ops::Range<usize> {
    let start = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let length = text[start..].lines().next().map_or(0, str::len);
    start..start + length
}

impl std::fmt::Display for EmitError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            EmitError::OutOfRange { what, time } => {
                write!(f, "at t = {time} s {what} is at a place that is no number in POV-Ray's units")
            }
            EmitError::Blind { time } => {
                write!(f, "at t = {time} s POV-Ray cannot tell the camera from the point that it looks at")
            }
            EmitError::Template(report) | EmitError::Indistinct(report) => report.fmt(f),
        }
    }
}

impl std::error::Error for EmitError {}
