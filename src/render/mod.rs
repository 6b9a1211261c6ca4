//! Scripts → images.

mod options;
mod record;

pub use options::{Quality, options};
pub use record::{Compare, Files, HIDDEN, Record, State};
