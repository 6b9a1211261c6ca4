//! The reasons why a request to the server fails.

use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};

use crate::RunError;
use crate::diagnostic::Report;
use crate::output::OutputError;
use crate::render::RenderError;

/// The reason why a request to the server fails.
pub(super) enum Failed {
    /// The requested run has been removed, or has no such frame or body.
    Gone,
    /// The error report of a run, a scene or POV-Ray, as the terminal would show it.
    Report(Report),
    /// An error of the operating system.
    Io(std::io::Error),
}

impl From<std::io::Error> for Failed {
    fn from(error: std::io::Error) -> Failed {
        Failed::Io(error)
    }
}

impl From<OutputError> for Failed {
    fn from(error: OutputError) -> Failed {
        Failed::Report(error.report())
    }
}

impl From<RunError> for Failed {
    fn from(error: RunError) -> Failed {
        Failed::Report(error.report())
    }
}

impl From<RenderError> for Failed {
    fn from(error: RenderError) -> Failed {
        Failed::Report(error.report())
    }
}

impl From<Report> for Failed {
    fn from(report: Report) -> Failed {
        Failed::Report(report)
    }
}

impl IntoResponse for Failed {
    fn into_response(self) -> Response {
        match self {
            Failed::Gone => (StatusCode::NOT_FOUND, "there is no such run, frame or body\n").into_response(),
            Failed::Report(report) => {
                (StatusCode::UNPROCESSABLE_ENTITY, report.to_text(false)).into_response()
            }
            Failed::Io(error) => (StatusCode::INTERNAL_SERVER_ERROR, format!("{error}\n")).into_response(),
        }
    }
}
