//! Why a script cannot be written.

use crate::diagnostic::{Code, Diagnostic, Report, Span};

/// Why a script cannot be written.
#[derive(Clone, Debug)]
pub enum EmitError {
    /// A place is not a number in POV-Ray's units.
    OutOfRange {
        /// The thing at that place: a body, a light, or the camera.
        what: String,
        /// The time, s.
        time: f64,
    },
    /// The camera moves to where POV-Ray cannot tell it from the point that it looks at.
    Blind {
        /// The time, s.
        time: f64,
    },
    /// POV-Ray cannot tell apart what the scene shows; the report says what, and where in the scene.
    Indistinct(Report),
    /// A template fails; the report says where.
    Template(Report),
}

impl EmitError {
    /// The kind of mistake, as a diagnostic's code.
    pub fn code(&self) -> Code {
        match self {
            EmitError::Indistinct(_) => Code::Indistinct,
            EmitError::OutOfRange { .. } | EmitError::Blind { .. } | EmitError::Template(_) => {
                Code::CannotEmit
            }
        }
    }

    /// The error as a diagnostic, with its place if it has one.
    pub fn report(&self) -> Report {
        match self {
            EmitError::Template(report) | EmitError::Indistinct(report) => report.clone(),
            EmitError::OutOfRange { .. } | EmitError::Blind { .. } => {
                Report::of_error(self.code(), self.to_string())
            }
        }
    }

    /// The error of a template: in which file, with which text, and where in it.
    pub(super) fn of_template(
        error: &minijinja::Error,
        text_of: impl Fn(&str) -> Option<(String, String)>,
    ) -> EmitError {
        // The innermost cause is the mistake; the others name the templates on the way.
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
        // The place is shown, so it need not be said as well; and what we refuse to write says all by itself.
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

/// The bytes of a line, counted from 1.
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
