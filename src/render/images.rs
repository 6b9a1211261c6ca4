//! The folder of the images: checks that jabuka made it, locks it, and adds finished images.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use super::RenderError;
use super::record::{HIDDEN, Record, Verdict};
use super::undated::undated;
use crate::output::Manifest;
use crate::regular_file;

/// A folder of images that is locked, so that only this process renders into it.
pub struct Images {
    folder: PathBuf,
    _lock: File,
}

impl Images {
    /// Opens a folder for images: creates it if needed, checks that jabuka made it, locks it, and removes leftovers of a killed process.
    ///
    /// # Errors
    /// If jabuka did not make the folder, another process renders into it, or it cannot be created or read.
    pub fn open(folder: &Path) -> Result<Images, RenderError> {
        fs::create_dir_all(folder).map_err(RenderError::io(folder))?;
        let hidden = folder.join(HIDDEN);
        match fs::symlink_metadata(&hidden) {
            Ok(metadata) if metadata.is_dir() => {}
            Ok(_) => return Err(RenderError::Link(hidden)),
            Err(_) => {
                let is_empty = fs::read_dir(folder).map_err(RenderError::io(folder))?.next().is_none();
                if !is_empty && Manifest::read(folder).is_none() {
                    return Err(RenderError::NotOurs(folder.to_owned()));
                }
                fs::create_dir(&hidden).map_err(RenderError::io(&hidden))?;
            }
        }
        let images = Images { _lock: lock(folder, &hidden.join("lock"))?, folder: folder.to_owned() };
        images.sweep().map_err(RenderError::io(&hidden))?;
        Ok(images)
    }

    /// Returns the path of the folder of images.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the path of an image. `name` has no extension: `frame_0007`.
    pub fn image(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.png"))
    }

    /// Returns the path of the file that caches the version of POV-Ray.
    pub fn povray_memory(&self) -> PathBuf {
        self.hidden().join("povray")
    }

    fn hidden(&self) -> PathBuf {
        self.folder.join(HIDDEN)
    }

    /// Creates a work folder for one POV-Ray process, on the same disk as the images.
    pub(super) fn work_folder(&self, number: usize) -> Result<PathBuf, RenderError> {
        let path = self.hidden().join(format!("work-{}-{number}", std::process::id()));
        fs::create_dir(&path).map_err(RenderError::io(&path))?;
        Ok(path)
    }

    /// Creates a folder for the images of the moments of one frame.
    pub(super) fn exposure_folder(&self, index: usize) -> Result<PathBuf, RenderError> {
        let path = self.hidden().join(format!("work-{}-frame-{index}", std::process::id()));
        fs::create_dir(&path).map_err(RenderError::io(&path))?;
        Ok(path)
    }

    /// Moves a finished image into the folder, without its date, and then writes its record. If the process is killed between the two
    /// steps, the image has no valid record and is rendered again.
    pub(super) fn adopt(&self, finished: &Path, name: &str, record: &Record) -> Result<(), RenderError> {
        let path = self.image(name);
        let bytes = regular_file::read(finished).map_err(RenderError::io(finished))?;
        if let Some(bytes) = undated(&bytes) {
            let mut file = regular_file::create(finished).map_err(RenderError::io(finished))?;
            file.write_all(&bytes).map_err(RenderError::io(finished))?;
        }
        let record = record.clone().of_image(finished).map_err(RenderError::io(finished))?;
        fs::rename(finished, &path).map_err(RenderError::io(&path))?;
        record.write(&self.folder, name).map_err(RenderError::io(Record::path(&self.folder, name)))?;
        self.forget_failure(name)
    }

    /// Checks an image against the digest in its record. An unreadable image counts as changed.
    pub(super) fn verify(&self, name: &str) -> Verdict {
        let Some(record) = Record::read(&self.folder, name) else { return Verdict::Unverified };
        record.verify(&self.image(name)).unwrap_or(Verdict::Changed)
    }

    /// Adds a copy of an existing image under another name, with its own record.
    pub(super) fn copy(&self, from: &str, name: &str, record: &Record) -> Result<(), RenderError> {
        let temporary = self.hidden().join(format!("work-{}-copy.png", std::process::id()));
        let bytes = regular_file::read(&self.image(from)).map_err(RenderError::io(self.image(from)))?;
        let copied = regular_file::create(&temporary).and_then(|mut file| file.write_all(&bytes));
        copied.map_err(RenderError::io(self.image(name)))?;
        self.adopt(&temporary, name, record)
    }

    /// Copies an image to a path outside of the folder. The copy is written under a temporary name and renamed when it is complete.
    ///
    /// # Errors
    /// If the image cannot be read, or the copy cannot be written.
    pub fn copy_out(&self, name: &str, target: &Path) -> Result<(), RenderError> {
        let file = target.file_name().unwrap_or_default().to_string_lossy();
        let temporary = target.with_file_name(format!(".jabuka-{file}.tmp"));
        // A killed process may have left a temporary file of this name.
        let _ = fs::remove_file(&temporary);
        let copy = || {
            let mut image = File::open(self.image(name))?;
            // `create_new` does not follow symbolic links.
            let mut copy = OpenOptions::new().write(true).create_new(true).open(&temporary)?;
            io::copy(&mut image, &mut copy)?;
            fs::rename(&temporary, target)
        };
        copy().map_err(|error| {
            // The temporary file may not exist, so an error of removing it is ignored.
            let _ = fs::remove_file(&temporary);
            RenderError::io(target)(error)
        })
    }

    /// Saves the reason why an image could not be rendered, for `jabuka status`.
    pub(super) fn note_failure(&self, name: &str, why: &str) -> Result<(), RenderError> {
        let folder = self.hidden().join("failed");
        fs::create_dir_all(&folder).map_err(RenderError::io(&folder))?;
        let path = folder.join(format!("{name}.txt"));
        let written =
            regular_file::create(&path).and_then(|mut file| file.write_all(format!("{why}\n").as_bytes()));
        written.map_err(RenderError::io(&path))
    }

    fn forget_failure(&self, name: &str) -> Result<(), RenderError> {
        let path = self.hidden().join("failed").join(format!("{name}.txt"));
        match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(RenderError::io(&path)(error)),
            _ => Ok(()),
        }
    }

    /// Removes the images of frames that no longer exist, and returns their number. Images whose length has changed since jabuka rendered
    /// them stay.
    pub(super) fn remove_others(&self, is_frame: impl Fn(&str) -> bool) -> Result<usize, RenderError> {
        let hidden = self.hidden();
        let mut removed = 0;
        for entry in fs::read_dir(&hidden).map_err(RenderError::io(&hidden))? {
            let name = entry.map_err(RenderError::io(&hidden))?.file_name();
            let Some(name) = name.to_str().and_then(|name| name.strip_suffix(".txt")) else { continue };
            let Some(record) = Record::read(&self.folder, name).filter(|_| !is_frame(name)) else { continue };
            let path = self.image(name);
            if fs::symlink_metadata(&path).is_ok_and(|image| image.is_file() && image.len() == record.bytes) {
                fs::remove_file(&path).map_err(RenderError::io(&path))?;
                removed += 1;
            }
            let path = Record::path(&self.folder, name);
            fs::remove_file(&path).map_err(RenderError::io(&path))?;
        }
        Ok(removed)
    }

    /// Removes the leftovers of killed processes: work folders with unfinished images and POV-Ray's `.pov-state`, and temporary files.
    fn sweep(&self) -> io::Result<()> {
        for entry in fs::read_dir(self.hidden())? {
            let entry = entry?;
            // Names that begin with a dot and end in `.tmp` are unfinished records.
            let is_left =
                |name: &str| name.starts_with("work-") || (name.starts_with('.') && name.ends_with(".tmp"));
            if !entry.file_name().to_str().is_some_and(is_left) {
                continue;
            }
            // A POV-Ray process that outlives the jabuka process that started it may still write into the folder, so a failed removal is
            // tried once more.
            let remove = || match entry.file_type() {
                Ok(kind) if kind.is_dir() => fs::remove_dir_all(entry.path()),
                _ => fs::remove_file(entry.path()),
            };
            match remove().or_else(|_| remove()) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
        Ok(())
    }
}

/// Returns true if jabuka has rendered images into a folder.
pub(crate) fn is_folder_of_images(folder: &Path) -> bool {
    folder.join(HIDDEN).is_dir()
}

fn lock(folder: &Path, path: &Path) -> Result<File, RenderError> {
    if fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_symlink()) {
        return Err(RenderError::Link(path.to_owned()));
    }
    let file = regular_file::open(path, OpenOptions::new().write(true).create(true).truncate(false));
    let file = file.map_err(RenderError::io(path))?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(RenderError::Locked(folder.to_owned())),
        Err(TryLockError::Error(error)) => Err(RenderError::io(path)(error)),
    }
}
