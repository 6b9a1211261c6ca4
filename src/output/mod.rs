//! Writes scripts into output folders.
//!
//! An output folder stays consistent. A file appears under its name only when it is whole. Running a killed command again completes the
//! folder. jabuka never changes or removes files that it did not write, and reaches all of them through `system::Dir`, which follows no links.
//!
//! Everything in a folder may come from elsewhere, also its manifest. Only in a folder that was made here (`system::made_here`) do the
//! digests in the manifest tell which files the user has edited.
//!
//! - A file is written under a temporary name and then renamed, so it is either complete or absent. There is no protection against a power
//!   failure (no `fsync`).
//! - The sizes and digests of scripts are stored in a temporary file until the manifest is written (`ledger.rs`), so memory does not grow
//!   with the number of frames.
//! - The manifest is written first, and has one of three states: `clearing` (files of another scene may still exist), `writing`, `complete`.
//! - If a script cannot be made, a folder that was empty or missing is left as it was.
//! - Only one process at a time writes to a folder: it locks `.jabuka-lock`, and the lock ends with the process. The file remains, because
//!   removing it would be a race condition.
//! - jabuka removes only files whose names match its own patterns, and only in a folder with its manifest. It never uses the list in a
//!   manifest to remove anything.
//! - In a folder that was made here, the digests in the manifest show which files were edited since jabuka wrote them. Before such a file is
//!   written again, the edited version is renamed (`edited.rs`), for example to `frame_0002.edited.pov`. A folder from elsewhere is written
//!   anew; a file that would count as an edit is refused by name. Only in a folder that was made here are scripts up to date, and are
//!   `local.conf` and `render.sbatch` kept.
//! - Frames are read from the recording one after another; each free thread takes the next frame, writes its script, and drops the frame.
//!
//! The digests in the manifest are SHA-256, so `sha256sum` can check them.

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
