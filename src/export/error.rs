//! Why a run cannot be exported.

use std::{fmt, io};

use crate::simulate::SimulateError;

/// Why a run cannot be exported.
#[derive(Debug)]
pub enum ExportError {
    /// It cannot be written.
    Io(io::Error),
    /// The run cannot be simulated, or read.
    Simulate(SimulateError),
    /// The file would be larger than its format allows: so many bytes, or more.
    TooLarge(u64),
    /// A body, a camera or a light is farther away than the numbers of the format reach.
    OutOfRange {
        /// Its name.
        what: String,
        /// The time of the frame, s.
        time: f64,
    },
}

impl ExportError {
    /// How to mend it, where that is not plain from the message.
    pub fn help(&self) -> Option<&'static str> {
        match self {
            ExportError::TooLarge(_) => {
                Some("take fewer frames, by `--frames` or by `simulation.frame_rate`")
            }
            _ => None,
        }
    }
}

impl fmt::Display for ExportError {
    #[allow(clippy::cast_precision_loss, reason = "a size is said with two digits after the point")]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ExportError::Io(error) => error.fmt(f),
            ExportError::Simulate(error) => error.fmt(f),
            ExportError::TooLarge(bytes) => {
                write!(
                    f,
                    "the file would have {:.2} GB or more, and a `.glb` holds 4.29 GB at most",
                    *bytes as f64 / 1e9
                )
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
