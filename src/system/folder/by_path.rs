//! The operations of a folder on systems without open folders. Each takes the path of a folder and a single name in it.
//!
//! A link is recognized and not followed. But unlike on Unix and Windows, a folder that another program replaces by a link in the very moment between
//! this check and the operation is not noticed.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use super::{About, Access, Kind};

/// The path of a folder.
pub(super) type Handle = PathBuf;

/// Checks that a folder exists at a path. Links on the path are followed.
pub(super) fn open_path(path: &Path) -> io::Result<Handle> {
    if fs::metadata(path)?.is_dir() { Ok(path.to_owned()) } else { Err(io::ErrorKind::NotADirectory.into()) }
}

pub(super) fn open_folder(folder: &Handle, name: &OsStr) -> io::Result<Handle> {
    match about(folder, name)?.kind {
        Kind::Folder => Ok(folder.join(name)),
        _ => Err(io::ErrorKind::NotADirectory.into()),
    }
}

/// Does nothing: there is only a path.
pub(super) fn release(_: &Handle) {}

pub(super) fn make_folder(folder: &Handle, name: &OsStr) -> io::Result<()> {
    fs::create_dir(folder.join(name))
}

pub(super) fn open_file(folder: &Handle, name: &OsStr, access: Access) -> io::Result<File> {
    if about(folder, name).is_ok_and(|found| found.kind == Kind::Link) {
        return Err(io::Error::other("it is a link"));
    }
    let mut options = OpenOptions::new();
    options.read(true);
    match access {
        Access::Read => &mut options,
        Access::Write => options.write(true),
        Access::WriteOrCreate => options.write(true).create(true).truncate(false),
        Access::Create => options.write(true).create_new(true),
    };
    options.open(folder.join(name))
}

/// Makes a symbolic link, where the system has such links for all users.
pub(super) fn link(_: &Path, _: &Handle, _: &OsStr) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

pub(super) fn rename(from: &Handle, name: &OsStr, to: &Handle, new_name: &OsStr) -> io::Result<()> {
    fs::rename(from.join(name), to.join(new_name))
}

pub(super) fn remove_file(folder: &Handle, name: &OsStr) -> io::Result<()> {
    fs::remove_file(folder.join(name))
}

pub(super) fn remove_folder(folder: &Handle, name: &OsStr) -> io::Result<()> {
    fs::remove_dir(folder.join(name))
}

pub(super) fn about(folder: &Handle, name: &OsStr) -> io::Result<About> {
    let found = fs::symlink_metadata(folder.join(name))?;
    let kind = match found.file_type() {
        kind if kind.is_symlink() => Kind::Link,
        kind if kind.is_dir() => Kind::Folder,
        kind if kind.is_file() => Kind::File,
        _ => Kind::Other,
    };
    Ok(About { kind, bytes: found.len() })
}

pub(super) fn names(folder: &Handle) -> io::Result<Vec<OsString>> {
    fs::read_dir(folder)?.map(|entry| Ok(entry?.file_name())).collect()
}

/// Returns a text that tells the folder apart from those that get its path after it was removed.
pub(super) fn identity(folder: &Handle, _: &Path) -> io::Result<String> {
    let created = fs::metadata(folder)?.created()?;
    let created = created.duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
    Ok(format!("{} {}", fs::canonicalize(folder)?.display(), created.as_nanos()))
}

pub(super) fn path_of(_: &Handle) -> Option<PathBuf> {
    None
}
