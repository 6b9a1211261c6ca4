//! The operations of a folder on Windows. Each takes an open folder and a single name in it, and follows no link.
//!
//! Windows opens files by their paths only. But a folder that is open without the right to delete it stays at its path, and so do all folders
//! above it: nobody can put a link in its place. So an open folder is a path together with such an open handle.
//!
//! Links are symbolic links and junctions. Other reparse points, such as files of OneDrive, are files and folders as all others.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File, Metadata, OpenOptions, TryLockError};
use std::io;
use std::os::windows::fs::{FileTypeExt as _, MetadataExt as _, OpenOptionsExt as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use super::super::windows::{FILE_FLAG_BACKUP_SEMANTICS, FILE_FLAG_OPEN_REPARSE_POINT, FileId, canonicalize};
use super::{About, Access, Kind};

/// See `CreateFileW`, and the file attributes and errors of Windows.
const FILE_LIST_DIRECTORY: u32 = 0x1;
const FILE_SHARE_READ: u32 = 0x1;
const FILE_SHARE_WRITE: u32 = 0x2;
const FILE_FLAG_DELETE_ON_CLOSE: u32 = 0x0400_0000;
const FILE_ATTRIBUTE_REPARSE_POINT: u32 = 0x400;
const ERROR_SHARING_VIOLATION: i32 = 32;

/// An open folder.
#[derive(Debug)]
pub(super) struct Handle {
    path: PathBuf,
    /// While it is open, the folder can be neither renamed nor removed. `None` after [`release`].
    pin: Mutex<Option<File>>,
}

impl Handle {
    fn open(path: PathBuf, flags: u32) -> io::Result<Handle> {
        let mut options = OpenOptions::new();
        options.access_mode(FILE_LIST_DIRECTORY).share_mode(FILE_SHARE_READ | FILE_SHARE_WRITE);
        let pin = options.custom_flags(FILE_FLAG_BACKUP_SEMANTICS | flags).open(&path)?;
        let about = pin.metadata()?;
        if about.is_symlink() || !about.is_dir() {
            return Err(io::ErrorKind::NotADirectory.into());
        }
        Ok(Handle { path, pin: Mutex::new(Some(pin)) })
    }
}

/// Opens a folder by its path. Links on the path are followed.
pub(super) fn open_path(path: &Path) -> io::Result<Handle> {
    // Some drives do not tell the path of a folder.
    let real = match canonicalize(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => std::path::absolute(path)?,
        real => real?,
    };
    Handle::open(real, 0)
}

pub(super) fn open_folder(folder: &Handle, name: &OsStr) -> io::Result<Handle> {
    Handle::open(folder.path.join(name), FILE_FLAG_OPEN_REPARSE_POINT)
}

/// Lets the folder be removed, although it is still open. Afterwards, only its path is known.
pub(super) fn release(folder: &Handle) {
    folder.pin.lock().unwrap_or_else(PoisonError::into_inner).take();
}

pub(super) fn make_folder(folder: &Handle, name: &OsStr) -> io::Result<()> {
    fs::create_dir(folder.path.join(name))
}

/// Opens a file. A link is opened itself, and is an error.
pub(super) fn open_file(folder: &Handle, name: &OsStr, access: Access) -> io::Result<File> {
    let path = folder.path.join(name);
    let mut options = OpenOptions::new();
    options.read(true);
    match access {
        Access::Read => &mut options,
        Access::Write => options.write(true),
        Access::WriteOrCreate => options.write(true).create(true).truncate(false),
        Access::Create => options.write(true).create_new(true),
    };
    let file = options.custom_flags(FILE_FLAG_OPEN_REPARSE_POINT).open(&path)?;
    let about = file.metadata()?;
    if about.is_symlink() {
        return Err(io::Error::other("it is a link"));
    }
    if about.file_attributes() & FILE_ATTRIBUTE_REPARSE_POINT == 0 {
        return Ok(file);
    }
    // The contents of such a file come from a driver, which needs the file opened as usual.
    let usual = options.create_new(false).custom_flags(0).open(&path)?;
    if FileId::of(&usual)? == FileId::of(&file)? { Ok(usual) } else { Err(io::Error::other("it is a link")) }
}

/// Locks a file that another program will write. On Windows, a lock forbids others to write, so a file beside it is locked, which
/// disappears with this process.
pub(super) fn lock_for_child(folder: &Handle, name: &OsStr, _: &File) -> Result<Option<File>, TryLockError> {
    let mut lock = name.to_owned();
    lock.push(".lock");
    let mut options = OpenOptions::new();
    options.write(true).create(true).truncate(false).share_mode(0);
    options.custom_flags(FILE_FLAG_DELETE_ON_CLOSE | FILE_FLAG_OPEN_REPARSE_POINT);
    match options.open(folder.path.join(lock)) {
        Ok(file) => Ok(Some(file)),
        Err(error) if error.raw_os_error() == Some(ERROR_SHARING_VIOLATION) => Err(TryLockError::WouldBlock),
        Err(error) => Err(TryLockError::Error(error)),
    }
}

/// Makes a link to a folder: a junction, which needs no rights. On drives without junctions, makes a folder with the same files.
pub(super) fn link(target: &Path, folder: &Handle, name: &OsStr) -> io::Result<()> {
    let path = folder.path.join(name);
    if junction::create(target, &path).is_ok() && path.is_dir() {
        return Ok(());
    }
    // The attempt may have left an empty folder.
    let _: io::Result<()> = fs::remove_dir(&path);
    mirror(target, &path)
}

/// Makes a folder with the files of another one: hard links, or copies on another drive. Links, and the files that jabuka keeps for itself, are
/// left out.
fn mirror(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        if entry.file_name().to_string_lossy().starts_with(".jabuka") {
            continue;
        }
        let (source, target) = (entry.path(), to.join(entry.file_name()));
        match entry.file_type()? {
            kind if kind.is_file() => {
                fs::hard_link(&source, &target).or_else(|_| fs::copy(&source, &target).map(drop))?;
            }
            // The images may be among the scripts, and the new folder is among the images.
            kind if kind.is_dir() && !to.starts_with(&source) => mirror(&source, &target)?,
            _ => {}
        }
    }
    Ok(())
}

/// Renames a file. A file of the new name is replaced at once. Programs that look through new files, such as virus scanners, keep them
/// open for a moment, so the renaming is tried for 0.2 s.
pub(super) fn rename(from: &Handle, name: &OsStr, to: &Handle, new_name: &OsStr) -> io::Result<()> {
    let (from, to) = (from.path.join(name), to.path.join(new_name));
    let mut renamed = fs::rename(&from, &to);
    for _ in 0..20 {
        let is_in_use = renamed.as_ref().is_err_and(|error| {
            error.kind() == io::ErrorKind::PermissionDenied
                || error.raw_os_error() == Some(ERROR_SHARING_VIOLATION)
        });
        if !is_in_use || to.is_dir() {
            break;
        }
        thread::sleep(Duration::from_millis(10));
        renamed = fs::rename(&from, &to);
    }
    renamed
}

pub(super) fn remove_file(folder: &Handle, name: &OsStr) -> io::Result<()> {
    let path = folder.path.join(name);
    // Windows keeps links to folders apart from links to files.
    let is_link_to_folder = fs::symlink_metadata(&path)
        .is_ok_and(|about| about.file_type().is_symlink_dir() || is_junction(&about));
    if is_link_to_folder { fs::remove_dir(path) } else { fs::remove_file(path) }
}

/// Returns true for a link to a folder that is no symbolic link.
fn is_junction(about: &Metadata) -> bool {
    /// See the file attributes of Windows.
    const FILE_ATTRIBUTE_DIRECTORY: u32 = 0x10;
    about.is_symlink() && about.file_attributes() & FILE_ATTRIBUTE_DIRECTORY != 0
}

pub(super) fn remove_folder(folder: &Handle, name: &OsStr) -> io::Result<()> {
    fs::remove_dir(folder.path.join(name))
}

pub(super) fn about(folder: &Handle, name: &OsStr) -> io::Result<About> {
    let found = fs::symlink_metadata(folder.path.join(name))?;
    let kind = match found.file_type() {
        kind if kind.is_symlink() => Kind::Link,
        kind if kind.is_dir() => Kind::Folder,
        kind if kind.is_file() => Kind::File,
        _ => Kind::Other,
    };
    Ok(About { kind, bytes: found.len() })
}

pub(super) fn names(folder: &Handle) -> io::Result<Vec<OsString>> {
    fs::read_dir(&folder.path)?.map(|entry| Ok(entry?.file_name())).collect()
}

/// Returns a text that tells the folder apart from all others, also from those that get its path after it was removed.
pub(super) fn identity(folder: &Handle, path: &Path) -> io::Result<String> {
    let pin = folder.pin.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(pin) = pin.as_ref() else {
        return Err(io::Error::other(format!("`{}` is no longer open", path.display())));
    };
    let about = winapi_util::file::information(pin)?;
    let created = about.creation_time().unwrap_or(0);
    Ok(format!("{} {} {created}", about.volume_serial_number(), about.file_index()))
}

/// Returns the path of the folder, which leads to it as long as it is open.
pub(super) fn path_of(folder: &Handle) -> Option<PathBuf> {
    Some(folder.path.clone())
}
