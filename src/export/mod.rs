//! Frames → data for other programs.

mod csv;

pub use self::csv::{ExportError, HEADER, write_csv};
