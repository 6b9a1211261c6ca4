//! Writes scripts into output folders.
//!
//! An output folder stays consistent. A file appears under its name only when it is whole. Running a killed command again completes the
//! folder. jabuka never changes or removes files that it did not write, and reaches all of them through `system::Dir`, which follows no links.
//!
//! Everything in a folder may come from elsewhere, also its manifest. Only in a folder that was made here (`system::made_here`) do the digests in
//! the manifest tell which files the user has edited.

mod assets;
mod compare;
mod digest_writer;
mod edited;
mod error;
mod folder;
mod ledger;
mod manifest;
mod moment;
mod trails;
mod up_to_date;
mod write;

pub use compare::{Difference, Kind, Line, compare};
use digest_writer::DigestWriter;
pub(crate) use edited::free_name;
pub use error::OutputError;
pub use folder::Folder;
pub(crate) use folder::{is_own_name, scripts};
pub(crate) use manifest::header_of as read_manifest;
pub use manifest::{Entry, Header, MANIFEST, Manifest, State};
pub use moment::write_moment;
pub use up_to_date::up_to_date;
pub use write::{Written, write};
