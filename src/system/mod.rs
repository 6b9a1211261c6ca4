//! What differs between operating systems, and what jabuka knows about the machine that it runs on.
//!
//! Every path that is written, renamed or removed is reached by `Dir` (`folder.rs`): an open folder, from which each name is opened without
//! following a link (`openat` with `O_NOFOLLOW`; on Windows, an open folder cannot be replaced by a link: `folder/windows.rs`). A link that another program puts in place
//! meanwhile changes nothing. POV-Ray and ffmpeg start in the open folder, and write relative to it. The folder that the user names may not
//! be a link, nor may any part of a relative path; the folders above an absolute path may.
//!
//! A folder can come from elsewhere, with all that is in it. `made_here.rs` notes, outside of it, which folders jabuka has made on this
//! machine: by inode and time of birth, which no copy shares.

//!
//! `unix.rs` and `windows.rs` have the same functions, for open files, for processes and for the folders of the user. No other part of jabuka asks
//! which of the two it runs on. `names.rs` knows the names of files that Windows reads as something else.

#[cfg(feature = "render")]
pub(crate) mod made_here;

mod folder;
mod names;
mod regular;
#[cfg(all(unix, feature = "render"))]
mod unix;
#[cfg(all(windows, feature = "render"))]
mod windows;

#[cfg(all(unix, feature = "render"))]
use unix as native;
#[cfg(all(windows, feature = "render"))]
use windows as native;

pub use folder::{About, Dir, FolderError, Kind, Made, open, read, read_to_string};
#[cfg(feature = "render")]
pub(crate) use folder::{create, open_to_write};
#[cfg(feature = "render")]
pub(crate) use native::{
    Family, FileId, POVRAY_NAMES, TEMPORARY_FOLDER_VARIABLES, become_program, cache_folder, canonicalize,
    cpu_seconds, cpu_seconds_by_group, free_bytes, is_variable, large_temporary_folder, make_executable,
    povray_folders, read_exact_at, signal, state_folder, this_program, write_all_at,
};
pub(crate) use regular::{irregular, metadata, open_without_waiting};

/// Returns the absolute path without links and `..`.
#[cfg(not(feature = "render"))]
pub(crate) fn canonicalize(path: &std::path::Path) -> std::io::Result<std::path::PathBuf> {
    path.canonicalize()
}

/// A family of shells, which quote words in the same way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shell {
    /// bash, zsh and others.
    Unix,
    /// cmd and PowerShell.
    Windows,
}

/// The shells of this system.
pub const SHELL: Shell = if cfg!(windows) { Shell::Windows } else { Shell::Unix };

/// Prepares this process for a command. On Unix, a file that exceeds the limit of `ulimit -f` becomes an error of writing, and does not end the
/// process. On Windows, older consoles understand colors. Programs that jabuka starts are not changed.
#[cfg(feature = "cli")]
pub fn prepare_process() {
    native::prepare_process();
}
