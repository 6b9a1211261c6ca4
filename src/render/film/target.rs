//! A file that appears whole or not at all, even if another program writes it.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use super::FilmError;

/// A file that is made under a temporary name beside its path. If it is not finished, dropping this removes it.
pub(in crate::render) struct Target {
    path: PathBuf,
    temporary: PathBuf,
    /// Locked, so that two processes do not write the same file; the lock ends with the process, however that ends.
    file: File,
    finished: bool,
}

impl Target {
    /// Makes the empty temporary file, and the folder if needed. Removes leftovers of a killed run.
    ///
    /// # Errors
    /// If another process makes the same file, or no file can be made there.
    pub(in crate::render) fn create(path: &Path) -> Result<Target, FilmError> {
        let io_error = || FilmError::io(path);
        if path.is_dir() {
            return Err(FilmError::Folder(path.to_owned()));
        }
        // Absolute, so that no name looks like an option or a protocol.
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
        // `create_new` follows no link.
        let file = OpenOptions::new().write(true).create_new(true).open(&temporary).map_err(io_error())?;
        if is_locked(&file) {
            return Err(FilmError::Locked(path.to_owned()));
        }
        Ok(Target { path: path.to_owned(), temporary, file, finished: false })
    }

    /// The path of the product.
    pub(in crate::render) fn path(&self) -> &Path {
        &self.path
    }

    /// The absolute path of the temporary file.
    pub(super) fn temporary(&self) -> &Path {
        &self.temporary
    }

    /// The file to write to, for jabuka itself.
    pub(in crate::render) fn file(&self) -> &File {
        &self.file
    }

    /// Renames the file to its final path.
    ///
    /// # Errors
    /// If it cannot be renamed.
    pub(in crate::render) fn finish(mut self) -> Result<(), FilmError> {
        fs::rename(&self.temporary, &self.path).map_err(FilmError::io(&self.path))?;
        self.finished = true;
        Ok(())
    }
}

impl Drop for Target {
    fn drop(&mut self) {
        if !self.finished {
            // If even this fails, the next run removes it.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}
