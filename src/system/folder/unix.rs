//! The operations of a folder on Unix. Each takes an open folder and a single name in it, and follows no link.

use std::ffi::{OsStr, OsString};
use std::fs::{File, TryLockError};
use std::io;
use std::os::fd::AsFd;
use std::os::unix::ffi::OsStrExt as _;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use rustix::fd::OwnedFd;
use rustix::fs::{self, AtFlags, CWD, FileType, Mode, OFlags};

use super::{About, Access, Kind};

/// An open folder.
pub(super) type Handle = OwnedFd;

/// On Linux, this opens folders that the user may pass through but not list.
#[cfg(any(target_os = "linux", target_os = "android"))]
const FOLDER_OPEN_FLAGS: OFlags = OFlags::PATH;
#[cfg(not(any(target_os = "linux", target_os = "android")))]
const FOLDER_OPEN_FLAGS: OFlags = OFlags::RDONLY;

/// Opens a folder by its path. Links on the path are followed.
pub(super) fn open_path(path: &Path) -> io::Result<Handle> {
    Ok(fs::openat(CWD, path, FOLDER_OPEN_FLAGS | OFlags::DIRECTORY | OFlags::CLOEXEC, Mode::empty())?)
}

pub(super) fn open_folder(folder: &Handle, name: &OsStr) -> io::Result<Handle> {
    let flags = FOLDER_OPEN_FLAGS | OFlags::DIRECTORY | OFlags::NOFOLLOW | OFlags::CLOEXEC;
    Ok(fs::openat(folder, name, flags, Mode::empty())?)
}

/// Does nothing: an open folder can be removed.
pub(super) fn release(_: &Handle) {}

pub(super) fn make_folder(folder: &Handle, name: &OsStr) -> io::Result<()> {
    Ok(fs::mkdirat(folder, name, Mode::from_raw_mode(0o777))?)
}

/// Opens a file, which may be of any kind. A pipe does not block.
pub(super) fn open_file(folder: &Handle, name: &OsStr, access: Access) -> io::Result<File> {
    let access = match access {
        Access::Read => OFlags::RDONLY,
        Access::Write => OFlags::RDWR,
        Access::WriteOrCreate => OFlags::RDWR | OFlags::CREATE,
        Access::Create => OFlags::RDWR | OFlags::CREATE | OFlags::EXCL,
    };
    let flags = access | OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::NOCTTY | OFlags::CLOEXEC;
    Ok(fs::openat(folder, name, flags, Mode::from_raw_mode(0o666))?.into())
}

/// Locks a file that another program will write. The lock belongs to the file, and hinders nobody who does not ask for it.
pub(super) fn lock_for_child(_: &Handle, _: &OsStr, file: &File) -> Result<Option<File>, TryLockError> {
    file.try_lock().map(|()| None)
}

/// Makes a symbolic link.
pub(super) fn link(target: &Path, folder: &Handle, name: &OsStr) -> io::Result<()> {
    Ok(fs::symlinkat(target, folder, name)?)
}

pub(super) fn rename(from: &Handle, name: &OsStr, to: &Handle, new_name: &OsStr) -> io::Result<()> {
    Ok(fs::renameat(from, name, to, new_name)?)
}

pub(super) fn remove_file(folder: &Handle, name: &OsStr) -> io::Result<()> {
    Ok(fs::unlinkat(folder, name, AtFlags::empty())?)
}

pub(super) fn remove_folder(folder: &Handle, name: &OsStr) -> io::Result<()> {
    Ok(fs::unlinkat(folder, name, AtFlags::REMOVEDIR)?)
}

pub(super) fn about(folder: &Handle, name: &OsStr) -> io::Result<About> {
    let found = fs::statat(folder, name, AtFlags::SYMLINK_NOFOLLOW)?;
    let kind = match FileType::from_raw_mode(found.st_mode) {
        FileType::RegularFile => Kind::File,
        FileType::Directory => Kind::Folder,
        FileType::Symlink => Kind::Link,
        _ => Kind::Other,
    };
    Ok(About { kind, bytes: u64::try_from(found.st_size).unwrap_or(0) })
}

pub(super) fn names(folder: &Handle) -> io::Result<Vec<OsString>> {
    let mut names = Vec::new();
    // A folder that was opened with `FOLDER_OPEN_FLAGS` cannot be listed, so it is opened once more.
    let listed =
        fs::openat(folder, ".", OFlags::RDONLY | OFlags::DIRECTORY | OFlags::CLOEXEC, Mode::empty())?;
    for entry in fs::Dir::new(listed)? {
        let entry = entry?;
        let name = entry.file_name().to_bytes();
        if name != b"." && name != b".." {
            names.push(OsStr::from_bytes(name).to_owned());
        }
    }
    Ok(names)
}

/// Returns a text that tells the folder apart from all others, also from those that get its path after it was removed. The path is only part
/// of it if the system does not say when the folder was made.
pub(super) fn identity(folder: &Handle, path: &Path) -> io::Result<String> {
    let about = File::from(folder.as_fd().try_clone_to_owned()?).metadata()?;
    let created = about.created().ok().and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok());
    Ok(match created {
        Some(created) => format!("{} {}", about.ino(), created.as_nanos()),
        None => format!("{} {}", about.ino(), path.canonicalize()?.display()),
    })
}

/// Returns a path that leads this process and its children to the open folder, whatever has become of the folder's own path. `None` if the
/// system has no such path.
pub(super) fn path_of(folder: &Handle) -> Option<PathBuf> {
    use std::os::fd::AsRawFd as _;
    let path = PathBuf::from(format!("/proc/self/fd/{}", folder.as_raw_fd()));
    path.is_dir().then_some(path)
}
