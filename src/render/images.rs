//! The folder of the images: who owns it, who renders into it, and how images are added.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use super::RenderError;
use super::record::{HIDDEN, Record, Verdict};
use crate::output::Manifest;

/// A folder of images that this process alone renders into.
pub struct Images {
    folder: PathBuf,
    _lock: File,
}

impl Images {
    /// Opens a folder for images: creates it if needed, checks that it is jabuka's, locks it, and removes leftovers of a killed
    /// run.
    ///
    /// # Errors
    /// If the folder belongs to something else, another process renders into it, or it cannot be used.
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

    /// Its path.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The path of an image.
    pub fn image(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.png"))
    }

    /// The file in which the version of POV-Ray is kept.
    pub fn povray_memory(&self) -> PathBuf {
        self.hidden().join("povray")
    }

    fn hidden(&self) -> PathBuf {
        self.folder.join(HIDDEN)
    }

    /// A new folder for one process of POV-Ray's, on the same disk as the images.
    pub(super) fn work_folder(&self, number: usize) -> Result<PathBuf, RenderError> {
        let path = self.hidden().join(format!("work-{}-{number}", std::process::id()));
        fs::create_dir(&path).map_err(RenderError::io(&path))?;
        Ok(path)
    }

    /// A new folder for the moments of a frame.
    pub(super) fn exposure_folder(&self, index: usize) -> Result<PathBuf, RenderError> {
        let path = self.hidden().join(format!("work-{}-frame-{index}", std::process::id()));
        fs::create_dir(&path).map_err(RenderError::io(&path))?;
        Ok(path)
    }

    /// Adds a finished image under its name: first the image, then the record. An interruption between them leaves an image
    /// that is rendered again.
    pub(super) fn adopt(&self, finished: &Path, name: &str, record: &Record) -> Result<(), RenderError> {
        let path = self.image(name);
        let record = record.clone().of_image(finished).map_err(RenderError::io(finished))?;
        fs::rename(finished, &path).map_err(RenderError::io(&path))?;
        record.write(&self.folder, name).map_err(RenderError::io(Record::path(&self.folder, name)))?;
        self.forget_failure(name)
    }

    /// Whether an image has the bytes that its record states. An unreadable image counts as damaged.
    pub(super) fn verify(&self, name: &str) -> Verdict {
        let Some(record) = Record::read(&self.folder, name) else { return Verdict::Unverified };
        record.verify(&self.image(name)).unwrap_or(Verdict::Changed)
    }

    /// Adds a copy of an existing image under another name.
    pub(super) fn copy(&self, from: &str, name: &str, record: &Record) -> Result<(), RenderError> {
        let temporary = self.hidden().join(format!("work-{}-copy.png", std::process::id()));
        let bytes = fs::read(self.image(from)).map_err(RenderError::io(self.image(from)))?;
        fs::write(&temporary, bytes).map_err(RenderError::io(self.image(name)))?;
        self.adopt(&temporary, name, record)
    }

    /// Copies an image to another place. The copy appears whole or not at all.
    ///
    /// # Errors
    /// If it cannot be read, or cannot be written there.
    pub fn copy_out(&self, name: &str, target: &Path) -> Result<(), RenderError> {
        let file = target.file_name().unwrap_or_default().to_string_lossy();
        let temporary = target.with_file_name(format!(".jabuka-{file}.tmp"));
        // A killed run may have left this file.
        let _ = fs::remove_file(&temporary);
        let copy = || {
            let mut image = File::open(self.image(name))?;
            // `create_new` follows no link.
            let mut copy = OpenOptions::new().write(true).create_new(true).open(&temporary)?;
            io::copy(&mut image, &mut copy)?;
            fs::rename(&temporary, target)
        };
        copy().map_err(|error| {
            // The temporary file may not exist.
            let _ = fs::remove_file(&temporary);
            RenderError::io(target)(error)
        })
    }

    /// Records why an image could not be rendered.
    pub(super) fn note_failure(&self, name: &str, why: &str) -> Result<(), RenderError> {
        let folder = self.hidden().join("failed");
        fs::create_dir_all(&folder).map_err(RenderError::io(&folder))?;
        let path = folder.join(format!("{name}.txt"));
        fs::write(&path, format!("{why}\n")).map_err(RenderError::io(&path))
    }

    fn forget_failure(&self, name: &str) -> Result<(), RenderError> {
        let path = self.hidden().join("failed").join(format!("{name}.txt"));
        match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(RenderError::io(&path)(error)),
            _ => Ok(()),
        }
    }

    /// Removes images that jabuka has rendered for frames that no longer exist, and returns their number. An image that was
    /// changed since stays.
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

    /// Removes leftovers of a killed run: its work folders, which hold `.pov-state` and unfinished images.
    fn sweep(&self) -> io::Result<()> {
        for entry in fs::read_dir(self.hidden())? {
            let entry = entry?;
            // Also unfinished records.
            let is_left =
                |name: &str| name.starts_with("work-") || (name.starts_with('.') && name.ends_with(".tmp"));
            if !entry.file_name().to_str().is_some_and(is_left) {
                continue;
            }
            // A POV-Ray that has outlived its jabuka may still be writing there, so try once more.
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

/// Whether jabuka has rendered images into a folder.
pub(crate) fn is_folder_of_images(folder: &Path) -> bool {
    folder.join(HIDDEN).is_dir()
}

fn lock(folder: &Path, path: &Path) -> Result<File, RenderError> {
    if fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_symlink()) {
        return Err(RenderError::Link(path.to_owned()));
    }
    let file = OpenOptions::new().write(true).create(true).truncate(false).open(path);
    let file = file.map_err(RenderError::io(path))?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(RenderError::Locked(folder.to_owned())),
        Err(TryLockError::Error(error)) => Err(RenderError::io(path)(error)),
    }
}
