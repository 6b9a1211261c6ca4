//! The errors of exporting a run.

use std::{fmt, io};

use crate::diagnostic::Report;
use crate::simulate::SimulateError;
use crate::system::FolderError;

/// The reason why a run cannot be exported.
#[derive(Debug)]
pub enum ExportError {
    /// The file cannot be written.
    Io(io::Error),
    /// The run cannot be simulated or read.
    Simulate(SimulateError),
    /// The format holds only whole runs, and some frames are missing.
    NotWhole,
    /// An error of the run itself.
    Run(Report),
    /// The file would be larger than its format allows. It would have at least this many bytes.
    TooLarge(u64),
    /// A value that a camera or a light follows is unknown at the time of a frame.
    NoValue {
        /// What follows the value.
        what: String,
        /// The time of the frame, s.
        time: f64,
    },
    /// The location of a body, a camera or a light exceeds the largest number of the format.
    OutOfRange {
        /// The name of the body, camera or light.
        what: String,
        /// The time of the frame, s.
        time: f64,
    },
}

impl ExportError {
    /// Returns advice on how to correct the error. `None` if the error message alone is enough.
    pub fn help(&self) -> Option<&'static str> {
        match self {
            ExportError::TooLarge(_) => {
                Some("take fewer frames, by `--frames` or by `simulation.frame_rate`")
            }
            _ => None,
        }
    }
}

impl From<FolderError> for ExportError {
    fn from(error: FolderError) -> ExportError {
        ExportError::Io(error.into())
    }
}

impl fmt::Display for ExportError {
    #[allow(clippy::cast_precision_loss, reason = "a size is said with two digits after the point")]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ExportError::Io(error) => error.fmt(f),
            ExportError::Simulate(error) => error.fmt(f),
            ExportError::Run(report) => f.write_str(&report.to_text(false)),
            ExportError::NotWhole => {
                f.write_str("a web page holds all frames of a run, and some are missing")
            }
            ExportError::TooLarge(bytes) => {
                write!(
                    f,
                    "the file would have {:.2} GB or more, and a `.glb` holds 4.29 GB at most",
                    *bytes as f64 / 1e9
                )
            }
            ExportError::NoValue { what, time } => {
                write!(f, "at t = {time} s {what} has no value: a body that a formula names may be absent")
            }
            ExportError::OutOfRange { what, time } => {
                write!(
                    f,
                    "at t = {time} s `{what}` is farther away than the numbers of a `.glb` reach: 3.4e38 m"
                )
            }
        }
    }
}

impl std::error::Error for ExportError {}

impl From<io::Error> for ExportError {
    fn from(error: io::Error) -> ExportError {
        ExportError::Io(error)
    }
}

impl From<SimulateError> for ExportError {
    fn from(error: SimulateError) -> ExportError {
        ExportError::Simulate(error)
    }
}
