//! The errors of writing a script.

use crate::diagnostic::{Code, Diagnostic, Report, Span};

/// The reason why a script cannot be written.
#[derive(Clone, Debug)]
pub enum EmitError {
    /// The location of a body, a light or the camera is not finite in POV-Ray units.
    OutOfRange {
        /// The name of the body, light or camera.
        what: String,
        /// The time of the frame, s.
        time: f64,
    },
    /// A value that the camera, a light or the scene's own SDL follows is unknown at the time of a frame.
    NoValue {
        /// What follows the value.
        what: String,
        /// The time of the frame, s.
        time: f64,
    },
    /// The camera and the point that it looks at are so close together that POV-Ray cannot distinguish them.
    Blind {
        /// The time of the frame, s.
        time: f64,
    },
    /// Sizes or distances in the scene are too small for POV-Ray. The report points to their positions in the text of the scene.
    Indistinct(Report),
    /// A template cannot be parsed or rendered. The report points to the position in the template.
    Template(Report),
}

impl EmitError {
    /// Returns the diagnostic code of this error.
    pub fn code(&self) -> Code {
        match self {
            EmitError::Indistinct(_) => Code::Indistinct,
            EmitError::OutOfRange { .. }
            | EmitError::NoValue { .. }
            | EmitError::Blind { .. }
            | EmitError::Template(_) => Code::CannotEmit,
        }
    }

    /// Returns the error as a report. Errors in the scene or in a template point to a position in the text of the scene or template.
    pub fn report(&self) -> Report {
        match self {
            EmitError::Template(report) | EmitError::Indistinct(report) => report.clone(),
            EmitError::OutOfRange { .. } | EmitError::NoValue { .. } | EmitError::Blind { .. } => {
                Report::of_error(self.code(), self.to_string())
            }
        }
    }

    /// Converts an error of the template engine to a report. `text_of` returns the path and the text of the template with a given name.
    pub(super) fn of_template(
        error: &minijinja::Error,
        text_of: impl Fn(&str) -> Option<(String, String)>,
    ) -> EmitError {
        // The innermost error is the mistake. The outer errors name the templates that include the faulty one.
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
        // The report shows the position, so the message omits it. For a value that scripts cannot contain, the detail alone is a full
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

/// Returns the byte range of a line. Lines are counted from 1.
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
            EmitError::NoValue { what, time } => {
                write!(f, "at t = {time} s {what} has no value: a body that a formula names may be absent")
            }
            EmitError::Blind { time } => {
                write!(f, "at t = {time} s POV-Ray cannot tell the camera from the point that it looks at")
            }
            EmitError::Template(report) | EmitError::Indistinct(report) => report.fmt(f),
        }
    }
}

impl std::error::Error for EmitError {}
