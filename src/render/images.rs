//! The folder of the images: checks that jabuka made it, locks it, and adds finished images.

use std::fs::{File, TryLockError};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use super::RenderError;
use super::record::{Compare, HIDDEN_FOLDER, Record, State, Verdict};
use super::undated::undated;
use crate::output::Manifest;
use crate::system::{Dir, FolderError, Kind};

/// A folder of images that is locked, so that only this process renders into it.
pub struct Images {
    folder: Dir,
    /// The folder `.jabuka` among the images.
    hidden: Dir,
    _lock: File,
}

/// A folder for unfinished images. Dropping it removes it.
pub(super) struct WorkFolder {
    hidden: Dir,
    name: String,
    pub(super) dir: Dir,
}

/// A finished image in a work folder.
pub(super) struct Finished {
    pub(super) folder: Dir,
    pub(super) name: String,
}

impl Images {
    /// Opens a folder for images: creates it if needed, checks that jabuka made it, locks it, and removes leftovers of a killed process.
    ///
    /// # Errors
    /// If jabuka did not make the folder, another process renders into it, or it cannot be created or read.
    pub fn open(folder: &Path) -> Result<Images, RenderError> {
        Images::of(Dir::make(folder)?)
    }

    /// Opens the folder `images` in a folder of scripts, as [`Images::open`] does.
    ///
    /// # Errors
    /// If jabuka did not make the folder, another process renders into it, or it cannot be created or read.
    pub fn among(scripts: &Dir) -> Result<Images, RenderError> {
        Images::of(scripts.make_folder("images")?)
    }

    fn of(folder: Dir) -> Result<Images, RenderError> {
        match folder.about(HIDDEN_FOLDER)?.map(|found| found.kind) {
            Some(Kind::Folder) => {}
            Some(_) => return Err(RenderError::Link(folder.path().join(HIDDEN_FOLDER))),
            None => {
                if !folder.names()?.is_empty() && Manifest::of_dir(&folder).is_none() {
                    return Err(RenderError::NotOurs(folder.path().to_owned()));
                }
                folder.new_folder(HIDDEN_FOLDER)?;
            }
        }
        let hidden = folder.folder(HIDDEN_FOLDER)?;
        let images = Images { _lock: lock(&folder, &hidden)?, folder, hidden };
        images.sweep()?;
        Ok(images)
    }

    /// Returns the path of the folder of images.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Returns the path of an image. `name` has no extension: `frame_0007`.
    pub fn image(&self, name: &str) -> PathBuf {
        self.folder().join(format!("{name}.png"))
    }

    /// Reads an image.
    ///
    /// # Errors
    /// If the image cannot be read.
    pub fn read(&self, name: &str) -> Result<Vec<u8>, RenderError> {
        Ok(self.folder.read(file_name(name))?)
    }

    /// Returns the hidden folder among the images. POV-Ray's version is cached there.
    pub(super) fn hidden(&self) -> &Dir {
        &self.hidden
    }

    /// Creates a work folder for one POV-Ray process, on the same disk as the images.
    pub(super) fn work_folder(&self, number: usize) -> Result<WorkFolder, RenderError> {
        self.new_folder(format!("work-{}-{number}", std::process::id()))
    }

    /// Creates a folder for the images of the moments of one frame.
    pub(super) fn exposure_folder(&self, index: usize) -> Result<WorkFolder, RenderError> {
        self.new_folder(format!("work-{}-frame-{index}", std::process::id()))
    }

    fn new_folder(&self, name: String) -> Result<WorkFolder, RenderError> {
        let dir = self.hidden.new_folder(&name)?;
        Ok(WorkFolder { hidden: self.hidden.clone(), name, dir })
    }

    /// Moves a finished image into the folder, without its date, and then writes its record. If the process is killed between the two
    /// steps, the image has no valid record and is rendered again.
    pub(super) fn adopt(&self, finished: &Finished, name: &str, record: &Record) -> Result<(), RenderError> {
        let Finished { folder, name: image } = finished;
        let mut bytes = folder.read(image)?;
        if let Some(undated) = undated(&bytes) {
            let written = folder.create(image)?.write_all(&undated);
            written.map_err(RenderError::io(folder.path().join(image)))?;
            bytes = undated;
        }
        folder.rename(image, &self.folder, file_name(name))?;
        record.clone().of_bytes(&bytes).write_in(&self.hidden, name)?;
        self.forget_failure(name)
    }

    /// Returns the state of an image, compared with the record that it would get if it were rendered now.
    pub(super) fn state(&self, name: &str, expected: &Record) -> State {
        let about = self.folder.about(file_name(name)).ok().flatten();
        let image = about.map(|about| (about.kind == Kind::File, about.bytes));
        expected.state_of(image, self.record(name).as_ref(), Compare::All)
    }

    fn record(&self, name: &str) -> Option<Record> {
        Record::read_in(&self.hidden, name)
    }

    /// Checks an image against the digest in its record. An unreadable image counts as changed.
    pub(super) fn verify(&self, name: &str) -> Verdict {
        let Some(record) = self.record(name) else { return Verdict::Unverified };
        let image = self.folder.open_file(file_name(name)).map_err(io::Error::from);
        image.and_then(|image| record.verify_file(image)).unwrap_or(Verdict::Changed)
    }

    /// Adds a copy of an existing image under another name, with its own record.
    pub(super) fn copy(&self, from: &str, name: &str, record: &Record) -> Result<(), RenderError> {
        let bytes = self.read(from)?;
        let copy =
            Finished { folder: self.hidden.clone(), name: format!("work-{}-copy.png", std::process::id()) };
        let copied = copy.folder.create(&copy.name)?.write_all(&bytes);
        copied.map_err(RenderError::io(self.image(name)))?;
        self.adopt(&copy, name, record)
    }

    /// Copies an image to a path outside of the folder. The copy is written under a temporary name and renamed when it is complete.
    ///
    /// # Errors
    /// If the image cannot be read, or the copy cannot be written.
    pub fn copy_out(&self, name: &str, target: &Path) -> Result<(), RenderError> {
        let (folder, file) = Dir::of_file(target, false)?;
        let mut image = self.folder.open_file(file_name(name))?;
        folder
            .write_whole(&file, |copy| io::copy(&mut image, copy).map(drop).map_err(RenderError::io(target)))
    }

    /// Saves the reason why an image could not be rendered, for `jabuka status`.
    pub(super) fn note_failure(&self, name: &str, why: &str) -> Result<(), RenderError> {
        let folder = self.hidden.make_folder("failed")?;
        let file = format!("{name}.txt");
        let written = folder.create(&file)?.write_all(format!("{why}\n").as_bytes());
        written.map_err(RenderError::io(folder.path().join(file)))
    }

    fn forget_failure(&self, name: &str) -> Result<(), RenderError> {
        match self.hidden.remove_file(format!("failed/{name}.txt")) {
            Err(error) if !error.is_not_found() => Err(error.into()),
            _ => Ok(()),
        }
    }

    /// Removes the images of frames that no longer exist, and returns their number. Images whose length has changed since jabuka rendered
    /// them stay.
    pub(super) fn remove_others(&self, is_frame: impl Fn(&str) -> bool) -> Result<usize, RenderError> {
        let mut removed = 0;
        for file in self.hidden.names()? {
            let Some(name) = file.to_str().and_then(|name| name.strip_suffix(".txt")) else { continue };
            // A record may come from elsewhere, so only images with a name that jabuka gives are removed.
            if is_frame(name) || !crate::output::is_own_name(&format!("{name}.pov")) {
                continue;
            }
            let Some(record) = self.record(name) else { continue };
            let image = self.folder.about(file_name(name))?;
            if image.is_some_and(|image| image.kind == Kind::File && image.bytes == record.bytes) {
                self.folder.remove_file(file_name(name))?;
                removed += 1;
            }
            self.hidden.remove_file(&file)?;
        }
        Ok(removed)
    }

    /// Removes the leftovers of killed processes: work folders with unfinished images and POV-Ray's `.pov-state`, and temporary files.
    fn sweep(&self) -> Result<(), FolderError> {
        // Names that begin with a dot and end in `.tmp` are unfinished records.
        let is_left =
            |name: &str| name.starts_with("work-") || (name.starts_with('.') && name.ends_with(".tmp"));
        for name in self.hidden.names()? {
            if !name.to_str().is_some_and(is_left) {
                continue;
            }
            // A POV-Ray process that outlives the jabuka process that started it may still write into the folder, so a failed removal is
            // tried once more.
            match self.hidden.remove_all(&name).or_else(|_| self.hidden.remove_all(&name)) {
                Err(error) if !error.is_not_found() => return Err(error),
                _ => {}
            }
        }
        Ok(())
    }
}

impl Drop for WorkFolder {
    fn drop(&mut self) {
        self.dir.release();
        // If the folder cannot be removed, the next process removes it.
        let _: Result<(), FolderError> = self.hidden.remove_all(&self.name);
    }
}

/// Returns true if jabuka has rendered images into a folder.
pub(crate) fn is_folder_of_images(folder: &Path) -> bool {
    folder.join(HIDDEN_FOLDER).is_dir()
}

fn file_name(name: &str) -> String {
    format!("{name}.png")
}

fn lock(folder: &Dir, hidden: &Dir) -> Result<File, RenderError> {
    let file = hidden.open_or_create("lock")?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(RenderError::Locked(folder.path().to_owned())),
        Err(TryLockError::Error(error)) => Err(RenderError::io(hidden.path().join("lock"))(error)),
    }
}
