//! Opens and creates files in folders that other programs can also write to, such as the cache.
//!
//! In the place of a file, such a folder may hold a pipe, which blocks whoever opens it, or a device, a folder or a link. Only regular files are
//! opened here, and links are not followed.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read as _};
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::Path;

use rustix::fs::OFlags;

/// Opens a regular file with these options.
///
/// # Errors
/// If the file cannot be opened, or is not a regular file.
pub(crate) fn open(path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    // Some devices act when they are opened, so the type is checked before.
    if fs::symlink_metadata(path).is_ok_and(|about| !about.is_file()) {
        return Err(not_regular());
    }
    // The file may have been replaced since. Then these flags refuse a link, and keep a pipe from blocking.
    let flags = OFlags::NOFOLLOW | OFlags::NONBLOCK;
    let file = options.custom_flags(flags.bits().cast_signed()).open(path)?;
    if file.metadata()?.is_file() { Ok(file) } else { Err(not_regular()) }
}

/// Opens a regular file for reading.
///
/// # Errors
/// If the file cannot be opened, or is not a regular file.
pub(crate) fn open_to_read(path: &Path) -> io::Result<File> {
    open(path, OpenOptions::new().read(true))
}

/// Reads a regular file.
///
/// # Errors
/// If the file cannot be read, or is not a regular file.
pub(crate) fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_to_read(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads a regular file as text.
///
/// # Errors
/// If the file cannot be read, is not a regular file, or is not UTF-8.
pub(crate) fn read_to_string(path: &Path) -> io::Result<String> {
    String::from_utf8(read(path)?).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}

/// Creates a new file. A file, pipe, device or link of this name is removed before.
///
/// # Errors
/// If the file cannot be created: for example, there is a folder of this name.
pub(crate) fn create(path: &Path) -> io::Result<File> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    // `create_new` follows no link.
    OpenOptions::new().read(true).write(true).create_new(true).open(path)
}

fn not_regular() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "it is not a regular file")
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;
    use std::process::Command;

    use super::*;

    #[test]
    fn only_regular_files_are_opened_and_others_are_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("file"), "text").unwrap();
        assert_eq!(read_to_string(&path("file")).unwrap(), "text");
        assert!(Command::new("mkfifo").arg(path("pipe")).status().unwrap().success());
        std::os::unix::fs::symlink(path("file"), path("link")).unwrap();
        std::os::unix::fs::symlink("/dev/zero", path("device")).unwrap();
        fs::create_dir(path("folder")).unwrap();
        for name in ["pipe", "link", "device", "folder", "missing"] {
            assert!(read(&path(name)).is_err(), "{name}");
            assert!(open(&path(name), OpenOptions::new().write(true)).is_err(), "{name}");
        }
        assert!(read(Path::new("/dev/zero")).is_err());
        for name in ["pipe", "link", "device", "missing"] {
            create(&path(name)).unwrap().write_all(b"new").unwrap();
            assert_eq!(read(&path(name)).unwrap(), b"new", "{name}");
        }
        assert!(create(&path("folder")).is_err());
        assert_eq!(read_to_string(&path("file")).unwrap(), "text", "the link was replaced, not followed");
    }
}
