//! A file that is written under a temporary name and renamed when it is complete, even if another program writes it.

use std::ffi::OsString;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};

use super::FilmError;
use crate::system::{Dir, FolderError};

/// A file that is written under a temporary name beside its final path. Dropping it before [`Target::finish`] removes the temporary file.
pub(in crate::render) struct Target {
    path: PathBuf,
    folder: Dir,
    name: OsString,
    temporary: OsString,
    /// The temporary file. It is locked, so that two processes do not write the same file. The lock ends with the process, however the
    /// process ends.
    file: File,
    /// The lock, where it is a file of its own.
    _lock: Option<File>,
    finished: bool,
}

impl Target {
    /// Creates and locks the empty temporary file, and the parent folder if needed. Removes the leftover of a killed process.
    ///
    /// # Errors
    /// If another process writes the same file, or no file can be created there.
    pub(in crate::render) fn create(path: &Path) -> Result<Target, FilmError> {
        if path.is_dir() || path.file_name().is_none() {
            return Err(FilmError::Folder(path.to_owned()));
        }
        let (folder, name) = Dir::of_file(path, true).map_err(|error| match error {
            FolderError::Link(link) => FilmError::Link(link),
            error => FilmError::io(path)(error.into()),
        })?;
        let mut temporary = OsString::from(".jabuka-");
        temporary.push(&name);
        temporary.push(".tmp");
        let lock = |file: &File| match folder.lock_for_child(&temporary, file) {
            Err(TryLockError::WouldBlock) => Err(FilmError::Locked(path.to_owned())),
            // Some disks have no locks.
            Err(TryLockError::Error(_)) => Ok(None),
            Ok(lock) => Ok(lock),
        };
        if let Ok(left) = folder.open_file(&temporary) {
            lock(&left)?;
        }
        let file = folder.create(&temporary)?;
        let lock = lock(&file)?;
        Ok(Target { path: path.to_owned(), folder, name, temporary, file, _lock: lock, finished: false })
    }

    /// Returns the final path of the file.
    pub(in crate::render) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the folder of the file. Another program that writes the file starts in this folder.
    pub(super) fn folder(&self) -> &Dir {
        &self.folder
    }

    /// Returns the path of the temporary file, relative to its folder. With `./`, it never looks like an option or a protocol to ffmpeg.
    pub(super) fn temporary(&self) -> PathBuf {
        Path::new(".").join(&self.temporary)
    }

    /// Returns the open temporary file, for files that jabuka itself writes.
    pub(in crate::render) fn file(&self) -> &File {
        &self.file
    }

    /// Renames the temporary file to its final path.
    ///
    /// # Errors
    /// If the file cannot be renamed.
    pub(in crate::render) fn finish(mut self) -> Result<(), FilmError> {
        self.folder.rename(&self.temporary, &self.folder, &self.name)?;
        self.finished = true;
        Ok(())
    }
}

impl Drop for Target {
    fn drop(&mut self) {
        if !self.finished {
            // If the file cannot be removed, the next process that writes to this path removes it.
            let _: Result<bool, FolderError> = self.folder.remove_file(&self.temporary);
        }
    }
}
