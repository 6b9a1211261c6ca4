//! An output folder: checks that jabuka made it, locks it, and writes files into it.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::OutputError;
use super::edited::SetAside;
use super::manifest::{self, MANIFEST};
use crate::emit::{COMMON, INI, MASTER, is_trail_file};

/// The name of the lock file. It stays in the folder, since removing it would race with another process that has just opened it. The lock
/// belongs to the open file, so it ends with the process, however the process ends.
const LOCK: &str = ".jabuka-lock";

/// An output folder that is locked, so that only this process writes to it.
pub struct Folder {
    path: PathBuf,
    _lock: File,
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
        Folder::open_marked(path, &|path| manifest::read(&path.join(MANIFEST)).is_some())
    }

    /// Opens a folder as [`Folder::open`] does, but `marked` decides whether jabuka made it.
    pub(crate) fn open_marked(path: &Path, marked: &dyn Fn(&Path) -> bool) -> Result<Folder, OutputError> {
        let io_error = |error| OutputError::Io(path.to_owned(), error);
        match fs::metadata(path) {
            Ok(metadata) if !metadata.is_dir() => return Err(OutputError::NotAFolder(path.to_owned())),
            Ok(_) => {}
            Err(_) => fs::create_dir_all(path).map_err(io_error)?,
        }
        if !is_ours(path, marked).map_err(io_error)? {
            return Err(OutputError::NotOurs(path.to_owned()));
        }
        let folder = Folder { path: path.to_owned(), _lock: lock(path)?, set_aside: Mutex::default() };
        folder.sweep().map_err(io_error)?;
        Ok(folder)
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
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
        let path = self.path.join(name);
        self.try_write_with(name, |file| fill(file).map_err(|error| OutputError::Io(path, error)))
    }

    /// Writes a file as [`Folder::write_with`] does, but `fill` may fail for other reasons than writing.
    pub(super) fn try_write_with(
        &self,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<File>) -> Result<(), OutputError>,
    ) -> Result<(), OutputError> {
        let path = self.path.join(name);
        let io_error = |error| OutputError::Io(path.clone(), error);
        // Temporary files for subfolders are in the main folder, too, since the next process looks for leftovers in the main folder only.
        let temporary = self.path.join(format!(".jabuka-{}.tmp", name.replace('/', "-")));
        let fill_and_rename = || {
            // `create_new` does not follow symbolic links.
            let file = OpenOptions::new().write(true).create_new(true).open(&temporary).map_err(io_error)?;
            let mut file = BufWriter::new(file);
            fill(&mut file)?;
            file.into_inner().map_err(io::IntoInnerError::into_error).map_err(io_error)?;
            fs::rename(&temporary, &path).map_err(io_error)
        };
        fill_and_rename().inspect_err(|_| {
            // If the file cannot be removed, the next process that opens the folder removes it.
            let _ = fs::remove_file(&temporary);
        })
    }

    /// Returns the frame numbers and names of the scripts in the folder, sorted by frame. `of` selects the frames.
    pub(super) fn scripts(&self, of: impl Fn(usize) -> bool) -> Result<Vec<(usize, String)>, OutputError> {
        scripts_of(&self.path, of)
    }

    /// Returns the sorted names of the include files in the folder that hold parts of trails.
    pub(super) fn trail_files(&self) -> Result<Vec<String>, OutputError> {
        trail_files(&self.path).map_err(|error| OutputError::Io(self.path.clone(), error))
    }

    /// Removes all scripts, and the include files that jabuka wrote with them. Returns the numbers of the frames that had a script.
    pub(super) fn remove_scripts(&self) -> Result<Vec<usize>, OutputError> {
        let scripts = self.scripts(|_| true)?;
        let mut numbers: Vec<usize> = scripts.iter().map(|(number, _)| *number).collect();
        numbers.dedup();
        let names = scripts.into_iter().map(|(_, name)| name);
        let names = names.chain([MASTER, INI, COMMON].map(str::to_owned)).chain(self.trail_files()?);
        for name in names {
            let path = self.path.join(name);
            match fs::remove_file(&path) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => {
                    return Err(OutputError::Io(path, error));
                }
                _ => {}
            }
        }
        Ok(numbers)
    }

    fn sweep(&self) -> io::Result<()> {
        for entry in fs::read_dir(&self.path)? {
            let entry = entry?;
            if entry.file_name().to_str().is_some_and(is_temporary) && !entry.file_type()?.is_dir() {
                fs::remove_file(entry.path())?;
            }
        }
        Ok(())
    }
}

/// Returns the frame numbers and names of the scripts in a folder, sorted by frame. Each frame's sharp script comes before its script with
/// motion blur.
pub(crate) fn scripts(path: &Path) -> Result<Vec<(usize, String)>, OutputError> {
    scripts_of(path, |_| true)
}

fn scripts_of(path: &Path, of: impl Fn(usize) -> bool) -> Result<Vec<(usize, String)>, OutputError> {
    let io_error = |error| OutputError::Io(path.to_owned(), error);
    let mut scripts = Vec::new();
    for entry in fs::read_dir(path).map_err(io_error)? {
        let entry = entry.map_err(io_error)?;
        if let Some((number, name)) = entry.file_name().to_str().and_then(|n| Some((script_number(n)?, n)))
            && of(number)
        {
            scripts.push((number, name.to_owned()));
        }
    }
    scripts.sort_unstable();
    Ok(scripts)
}

/// Returns the sorted names of the include files in a folder that hold parts of trails.
pub(crate) fn trail_files(path: &Path) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(path)? {
        names.extend(entry?.file_name().into_string().ok().filter(|name| is_trail_file(name)));
    }
    names.sort_unstable();
    Ok(names)
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

/// Returns true if `marked` recognizes a folder as jabuka's, or if it contains only a lock and leftovers of a killed process.
fn is_ours(path: &Path, marked: &dyn Fn(&Path) -> bool) -> io::Result<bool> {
    for entry in fs::read_dir(path)? {
        let name = entry?.file_name();
        if name.to_str().is_none_or(|name| name != LOCK && !is_temporary(name)) {
            return Ok(marked(path));
        }
    }
    Ok(true)
}

fn lock(folder: &Path) -> Result<File, OutputError> {
    let path = folder.join(LOCK);
    if fs::symlink_metadata(&path).is_ok_and(|metadata| metadata.is_symlink()) {
        return Err(OutputError::Link(path));
    }
    let file = OpenOptions::new().write(true).create(true).truncate(false).open(&path);
    let file = file.map_err(|error| OutputError::Io(path.clone(), error))?;
    // A new child process briefly has copies of all open files, until it executes its program. A lock that was just released can therefore
    // still be held by such a copy, so locking is tried for 0.2 s.
    for _ in 0..20 {
        match file.try_lock() {
            Ok(()) => return Ok(file),
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(10)),
            Err(TryLockError::Error(error)) => return Err(OutputError::Io(path, error)),
        }
    }
    Err(OutputError::Locked(folder.to_owned()))
}

#[cfg(test)]
mod tests {
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
        assert_eq!(names.collect::<Vec<_>>(), [LOCK]);
    }
}
