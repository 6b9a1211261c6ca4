//! A file that is written under a temporary name and renamed when it is complete, even if another program writes it.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use super::FilmError;

/// A file that is written under a temporary name beside its final path. Dropping it before [`Target::finish`] removes the temporary file.
pub(in crate::render) struct Target {
    path: PathBuf,
    temporary: PathBuf,
    /// The temporary file. It is locked, so that two processes do not write the same file. The lock ends with the process, however the
    /// process ends.
    file: File,
    finished: bool,
}

impl Target {
    /// Creates and locks the empty temporary file, and the parent folder if needed. Removes the leftover of a killed process.
    ///
    /// # Errors
    /// If another process writes the same file, or no file can be created there.
    pub(in crate::render) fn create(path: &Path) -> Result<Target, FilmError> {
        let io_error = || FilmError::io(path);
        if path.is_dir() {
            return Err(FilmError::Folder(path.to_owned()));
        }
        // An absolute path never looks like an option or a protocol to ffmpeg.
        let absolute = std::path::absolute(path).map_err(io_error())?;
        let name = absolute.file_name().ok_or_else(|| FilmError::Folder(path.to_owned()))?;
        let mut temporary = OsString::from(".jabuka-");
        temporary.push(name);
        temporary.push(".tmp");
        let temporary = absolute.with_file_name(temporary);
        if let Some(folder) = absolute.parent() {
            fs::create_dir_all(folder).map_err(io_error())?;
        }
        let is_locked = |file: &File| matches!(file.try_lock(), Err(TryLockError::WouldBlock));
        if File::open(&temporary).is_ok_and(|file| is_locked(&file)) {
            return Err(FilmError::Locked(path.to_owned()));
        }
        match fs::remove_file(&temporary) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(io_error()(error)),
            _ => {}
        }
        // `create_new` does not follow symbolic links.
        let file = OpenOptions::new().write(true).create_new(true).open(&temporary).map_err(io_error())?;
        if is_locked(&file) {
            return Err(FilmError::Locked(path.to_owned()));
        }
        Ok(Target { path: path.to_owned(), temporary, file, finished: false })
    }

    /// Returns the final path of the file.
    pub(in crate::render) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the absolute path of the temporary file.
    pub(super) fn temporary(&self) -> &Path {
        &self.temporary
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
        fs::rename(&self.temporary, &self.path).map_err(FilmError::io(&self.path))?;
        self.finished = true;
        Ok(())
    }
}

impl Drop for Target {
    fn drop(&mut self) {
        if !self.finished {
            // If the file cannot be removed, the next process that writes to this path removes it.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}
