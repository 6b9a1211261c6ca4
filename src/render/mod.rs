//! Scripts → images.

pub mod batch;
mod files;
mod options;
mod record;
mod status;

pub use files::{ASSETS, of_scripts};
pub use options::{Quality, options};
pub use record::{Compare, Files, HIDDEN, Record, State};
pub use status::{Failed, Running, Status};
