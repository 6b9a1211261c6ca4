//! The reasons why a request of the page fails.

use crate::RunError;
use crate::diagnostic::Report;
use crate::simulate::SimulateError;

/// The reason why a request of the page fails.
#[derive(Debug)]
pub enum Failed {
    /// The requested run has been removed, or has no such frame or body.
    Gone,
    /// The text of the scene has changed since the version on which the user's changes are based.
    Changed,
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

impl From<RunError> for Failed {
    fn from(error: RunError) -> Failed {
        Failed::Report(error.report())
    }
}

impl From<SimulateError> for Failed {
    fn from(error: SimulateError) -> Failed {
        Failed::Report(error.report())
    }
}

impl From<Report> for Failed {
    fn from(report: Report) -> Failed {
        Failed::Report(report)
    }
}

impl Failed {
    /// The status of HTTP that fits the reason.
    pub fn status(&self) -> u16 {
        match self {
            Failed::Gone => 404,
            Failed::Changed => 409,
            Failed::Report(_) => 422,
            Failed::Io(_) => 500,
        }
    }

    /// The reason as text for the user.
    pub fn message(&self) -> String {
        match self {
            Failed::Gone => "there is no such run, frame or body\n".to_owned(),
            Failed::Changed => "another program has changed the file\n".to_owned(),
            Failed::Report(report) => report.to_text(false),
            Failed::Io(error) => format!("{error}\n"),
        }
    }
}
