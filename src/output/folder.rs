//! An output folder: checks that jabuka made it, locks it, and writes files into it.

use std::fs::{File, TryLockError};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::OutputError;
use super::edited::SetAside;
use super::manifest::{self, MANIFEST};
use crate::emit::{COMMON, INI, MASTER, is_trail_file};
use crate::system::{Dir, FolderError, Kind, Made, made_here};

/// The name of the lock file. It stays in the folder, since removing it would race with another process that has just opened it. The lock
/// belongs to the open file, so it ends with the process, however the process ends.
const LOCK_FILE: &str = ".jabuka-lock";

/// An output folder that is locked, so that only this process writes to it.
pub struct Folder {
    dir: Dir,
    _lock: File,
    /// True if jabuka made this folder on this machine. All later changes in it are then the user's.
    made_here: bool,
    /// The folders that were made to open this one.
    made: Made,
    /// True if the folder was empty when it was opened.
    is_new: bool,
    /// The edited files that were renamed since the folder was opened.
    set_aside: Mutex<Vec<SetAside>>,
}

impl Folder {
    /// Opens a folder for writing: creates it if needed, checks that jabuka made it, locks it, and removes files that a killed process
    /// left half-written.
    ///
    /// # Errors
    /// If jabuka did not make the folder, another process writes to it, or it cannot be created or read.
    pub fn open(path: &Path) -> Result<Folder, OutputError> {
        let (dir, made) = Dir::make_noting(path)?;
        Folder::of(dir, made, &|dir| manifest::read(dir).is_some())
    }

    /// Opens a subfolder for writing, as [`Folder::open`] does.
    pub(crate) fn within(above: &Dir, name: &str) -> Result<Folder, OutputError> {
        let (dir, made) = above.make_folder_noting(name)?;
        Folder::of(dir, made, &|dir| manifest::read(dir).is_some())
    }

    /// Locks an open folder as [`Folder::open`] does, but `marked` decides whether jabuka made it. `made` are the folders that were made to open
    /// it.
    pub(crate) fn of(dir: Dir, made: Made, marked: &dyn Fn(&Dir) -> bool) -> Result<Folder, OutputError> {
        let is_empty = is_empty(&dir)?;
        if !is_empty && !marked(&dir) {
            return Err(OutputError::NotOurs(dir.path().to_owned()));
        }
        let lock = lock(&dir)?;
        if is_empty {
            made_here::note(&dir);
        }
        let made_here = is_empty || made_here::is_noted(&dir);
        let folder =
            Folder { dir, _lock: lock, made, is_new: is_empty, made_here, set_aside: Mutex::default() };
        folder.sweep()?;
        Ok(folder)
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        self.dir.path()
    }

    /// Returns the open folder.
    pub fn dir(&self) -> &Dir {
        &self.dir
    }

    /// Returns true if jabuka made this folder on this machine. Another folder may hold anything.
    pub(crate) fn is_made_here(&self) -> bool {
        self.made_here
    }

    /// Notes that all files of jabuka's in this folder were written here.
    pub(crate) fn note_made_here(&self) {
        if !self.made_here {
            made_here::note(&self.dir);
        }
    }

    pub(super) fn lock_set_aside(&self) -> MutexGuard<'_, Vec<SetAside>> {
        self.set_aside.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes a file into the folder under a temporary name, and renames it when it is whole.
    ///
    /// # Errors
    /// If the file cannot be written. An existing file of that name then stays unchanged.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), OutputError> {
        self.write_with(name, |file| file.write_all(bytes))
    }

    /// Writes a file as [`Folder::write`] does, but `fill` writes the contents of the file piece by piece.
    pub(super) fn write_with(
        &self,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        let path = self.path().join(name);
        self.try_write_with(name, |file| fill(file).map_err(|error| OutputError::Io(path, error)))
    }

    /// Writes a file as [`Folder::write_with`] does, but `fill` may fail for other reasons than writing.
    pub(super) fn try_write_with(
        &self,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<File>) -> Result<(), OutputError>,
    ) -> Result<(), OutputError> {
        // Temporary files for subfolders are in the main folder, too, since the next process looks for leftovers in the main folder only.
        let temporary = format!(".jabuka-{}.tmp", name.replace('/', "-"));
        self.dir.write_as(Path::new(&temporary), Path::new(name), fill)
    }

    /// Removes everything that was written, if the folder was empty when it was opened. The lock is removed with this value.
    pub(crate) fn discard(&self) {
        if self.is_new {
            for name in self.dir.names().unwrap_or_default().iter().filter(|name| *name != LOCK_FILE) {
                // What cannot be removed stays, and the manifest says that it is incomplete.
                let _: Result<(), FolderError> = self.dir.remove_all(name);
            }
        }
    }

    /// Returns the frame numbers and names of the scripts in the folder, sorted by frame. `of` selects the frames.
    pub(super) fn scripts(&self, of: impl Fn(usize) -> bool) -> Result<Vec<(usize, String)>, OutputError> {
        scripts_of(&self.dir, of)
    }

    /// Returns the sorted names of the include files in the folder that hold parts of trails.
    pub(super) fn trail_files(&self) -> Result<Vec<String>, OutputError> {
        Ok(trail_files(&self.dir)?)
    }

    /// Removes all scripts, and the include files that jabuka wrote with them. Returns the numbers of the frames that had a script.
    pub(super) fn remove_scripts(&self) -> Result<Vec<usize>, OutputError> {
        let scripts = self.scripts(|_| true)?;
        let mut numbers: Vec<usize> = scripts.iter().map(|(number, _)| *number).collect();
        numbers.dedup();
        let names = scripts.into_iter().map(|(_, name)| name);
        let names = names.chain([MASTER, INI, COMMON].map(str::to_owned)).chain(self.trail_files()?);
        for name in names {
            self.dir.remove_file(name)?;
        }
        Ok(numbers)
    }

    fn sweep(&self) -> Result<(), FolderError> {
        for name in self.dir.names()?.iter().filter(|name| name.to_str().is_some_and(is_temporary)) {
            if self.dir.about(name)?.is_some_and(|found| found.kind != Kind::Folder) {
                self.dir.remove_file(name)?;
            }
        }
        Ok(())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A folder that was made for nothing is removed, with its lock.
        let is_for_nothing = self.is_new && !self.made.is_empty() && is_empty(&self.dir).unwrap_or(false);
        if is_for_nothing && self.dir.remove_file(LOCK_FILE).is_ok() {
            self.dir.release();
            self.made.remove();
        }
    }
}

/// Returns the frame numbers and names of the scripts in a folder, sorted by frame. Each frame's sharp script comes before its script with
/// motion blur.
pub(crate) fn scripts(path: &Path) -> Result<Vec<(usize, String)>, OutputError> {
    scripts_of(&Dir::of_path(path)?, |_| true)
}

fn scripts_of(dir: &Dir, of: impl Fn(usize) -> bool) -> Result<Vec<(usize, String)>, OutputError> {
    let mut scripts = Vec::new();
    for name in dir.names()? {
        if let Some((number, name)) = name.to_str().and_then(|name| Some((script_number(name)?, name)))
            && of(number)
        {
            scripts.push((number, name.to_owned()));
        }
    }
    scripts.sort_unstable();
    Ok(scripts)
}

/// Returns the sorted names of the include files in a folder that hold parts of trails.
pub(crate) fn trail_files(dir: &Dir) -> Result<Vec<String>, FolderError> {
    let names = dir.names()?.into_iter().filter_map(|name| name.into_string().ok());
    Ok(names.filter(|name| is_trail_file(name)).collect())
}

/// Returns the frame number in the name of a script. `None` for every other file name.
pub(super) fn script_number(name: &str) -> Option<usize> {
    let number = name.strip_prefix("frame_").or_else(|| name.strip_prefix("shutter_"))?;
    let digits = number.strip_suffix(".pov")?;
    let plain = digits.len() >= 4 && digits.bytes().all(|b| b.is_ascii_digit());
    plain.then(|| digits.parse().ok())?
}

/// Returns true for the names of files that jabuka writes into a folder of scripts: manifest, scripts and their include files.
pub(crate) fn is_own_name(name: &str) -> bool {
    [MANIFEST, MASTER, INI, COMMON].contains(&name) || script_number(name).is_some() || is_trail_file(name)
}

fn is_temporary(name: &str) -> bool {
    name.starts_with(".jabuka-") && name.ends_with(".tmp")
}

/// Returns true if a folder is empty but for a lock and leftovers of a killed process.
fn is_empty(dir: &Dir) -> Result<bool, FolderError> {
    let is_left = |name: &str| name == LOCK_FILE || is_temporary(name);
    Ok(dir.names()?.iter().all(|name| name.to_str().is_some_and(is_left)))
}

fn lock(dir: &Dir) -> Result<File, OutputError> {
    let file = dir.open_or_create(LOCK_FILE)?;
    // A new child process briefly has copies of all open files, until it executes its program. A lock that was just released can therefore
    // still be held by such a copy, so locking is tried for 0.2 s.
    for _ in 0..20 {
        match file.try_lock() {
            Ok(()) => return Ok(file),
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(10)),
            Err(TryLockError::Error(error)) => {
                return Err(OutputError::Io(dir.path().join(LOCK_FILE), error));
            }
        }
    }
    Err(OutputError::Locked(dir.path().to_owned()))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn only_our_own_plain_names_are_scripts() {
        assert_eq!(script_number("frame_0050.pov"), Some(50));
        assert_eq!(script_number("frame_10000.pov"), Some(10_000));
        assert_eq!(script_number("shutter_0050.pov"), Some(50));
        for name in [
            "frame_050.pov",
            "shutter_50.pov",
            "shutter_frame_0050.pov",
            "frame_+050.pov",
            "../frame_0050.pov",
            "frame_0050.png",
            "frame_.pov",
            "x",
        ] {
            assert_eq!(script_number(name), None, "{name}");
        }
    }

    #[test]
    fn one_process_writes_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let first = Folder::open(folder.path()).unwrap();
        assert!(matches!(Folder::open(folder.path()), Err(OutputError::Locked(_))));
        drop(first);
        assert!(Folder::open(folder.path()).is_ok());
    }

    #[test]
    fn a_folder_with_files_of_others_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("thesis.txt"), "years of work").unwrap();
        assert!(matches!(Folder::open(folder.path()), Err(OutputError::NotOurs(_))));
        fs::write(folder.path().join(MANIFEST), "{\"name\": \"a web page\"}").unwrap();
        assert!(matches!(Folder::open(folder.path()), Err(OutputError::NotOurs(_))));
    }

    #[test]
    fn half_written_files_are_swept_away_and_others_stay() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(".jabuka-frame_0001.pov.tmp"), "half").unwrap();
        Folder::open(folder.path()).unwrap();
        let names = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name());
        assert_eq!(names.collect::<Vec<_>>(), [LOCK_FILE]);
    }
}
