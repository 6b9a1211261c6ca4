//! What differs between operating systems, and what jabuka knows about the machine that it runs on.

#[cfg(feature = "render")]
pub(crate) mod made_here;

mod folder;

pub use folder::{About, Dir, FolderError, Kind, Made, open, read, read_to_string};
#[cfg(feature = "render")]
pub(crate) use folder::{create, open_to_write};
