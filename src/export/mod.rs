//! Frames → data for other programs.

mod csv;
mod error;
mod glb;

pub use self::csv::{HEADER, write_csv};
pub use self::error::ExportError;
pub use self::glb::{Exported, write_glb};
