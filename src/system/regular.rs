//! Regular files: what a file is if it is none, and how to open it without harm.

use std::fs::{File, FileType, Metadata, OpenOptions};
use std::io;
use std::path::Path;

use super::names;

/// Returns what the system says about the file at a path. Links are followed.
///
/// # Errors
/// If there is no such file. On Windows, also if its name is that of a device, or is read as the name of another file.
pub(crate) fn metadata(path: &Path) -> io::Result<Metadata> {
    names::check(path.file_name().unwrap_or_default())?;
    path.metadata()
}

/// Opens a file for reading. If the file is a pipe, this does not wait for another program.
///
/// # Errors
/// If the file cannot be opened. On Windows, also if its name is that of a device, or is read as the name of another file.
pub(crate) fn open_without_waiting(path: &Path) -> io::Result<File> {
    names::check(path.file_name().unwrap_or_default())?;
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(all(unix, feature = "render"))]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options.custom_flags(rustix::fs::OFlags::NONBLOCK.bits().cast_signed());
    }
    options.open(path)
}

/// Describes the type of a file in words, such as "a named pipe". `None` for a regular file.
pub(crate) fn irregular(kind: FileType) -> Option<&'static str> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_fifo() {
            return Some("a named pipe");
        }
        if kind.is_socket() {
            return Some("a socket");
        }
        if kind.is_char_device() || kind.is_block_device() {
            return Some("a device");
        }
    }
    match () {
        () if kind.is_file() => None,
        () if kind.is_dir() => Some("a folder"),
        () => Some("no regular file"),
    }
}
