//! What differs between operating systems, and what jabuka knows about the machine that it runs on.
//!
//! Every path that is written, renamed or removed is reached by `Dir` (`folder.rs`): an open folder, from which each name is opened without
//! following a link (`openat` with `O_NOFOLLOW`; `folder/by_path.rs` stands in on systems without it). A link that another program puts in place
//! meanwhile changes nothing. POV-Ray and ffmpeg start in the open folder, and write relative to it. The folder that the user names may not
//! be a link, nor may any part of a relative path; the folders above an absolute path may.
//!
//! A folder can come from elsewhere, with all that is in it. `made_here.rs` notes, outside of it, which folders jabuka has made on this
//! machine: by inode and time of birth, which no copy shares.

#[cfg(feature = "render")]
pub(crate) mod made_here;

mod folder;

pub use folder::{About, Dir, FolderError, Kind, Made, open, read, read_to_string};
#[cfg(feature = "render")]
pub(crate) use folder::{create, open_to_write};
