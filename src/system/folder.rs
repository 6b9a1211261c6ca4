//! An open folder, through which jabuka writes, renames and removes files.
//!
//! Jabuka works in folders that others may have made, and there a symbolic link can lead to any file of the user. So every path below a
//! folder is taken one name after another, and a link among these names is an error. An open folder remains the same folder, even if
//! another program puts a link in its place. In the place of a file, a folder may hold a pipe, which blocks whoever opens it, or a device.
//! Only regular files are opened.
//!
//! `unix` and `windows` hold the operations on a single name. `by_path` has them for systems without open folders, such as a browser.

#[cfg(not(all(any(unix, windows), feature = "render")))]
mod by_path;
#[cfg(not(all(any(unix, windows), feature = "render")))]
use by_path as native;
#[cfg(all(unix, feature = "render"))]
mod unix;
#[cfg(all(unix, feature = "render"))]
use unix as native;
#[cfg(all(windows, feature = "render"))]
mod windows;
#[cfg(all(windows, feature = "render"))]
use windows as native;

use std::ffi::{OsStr, OsString};
use std::fmt;
use std::fs::File;
#[cfg(feature = "render")]
use std::fs::TryLockError;
use std::io::{self, BufWriter, Read as _};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use native::Handle;

use super::names;

/// An open folder. Names of files are relative to it, and may have several parts: `assets/wood.png`.
#[derive(Clone, Debug)]
pub struct Dir {
    handle: Arc<Handle>,
    /// The path of the folder as the user gave it, for messages.
    path: PathBuf,
}

/// The folders that were made on the way to a folder, from the outermost on: the folder above, and the name.
#[derive(Debug, Default)]
pub struct Made(Vec<(Dir, OsString)>);

impl Made {
    /// Returns true if no folder was missing.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Removes the folders again, as far as they are empty.
    pub fn remove(&self) {
        for (folder, name) in self.0.iter().rev() {
            // A folder that has got files meanwhile stays.
            let _: io::Result<()> = native::remove_folder(&folder.handle, name);
            folder.release();
        }
    }
}

/// What is found in a folder under a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct About {
    /// The kind of file.
    pub kind: Kind,
    /// The length of the file in bytes.
    pub bytes: u64,
}

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A regular file.
    File,
    /// A folder.
    Folder,
    /// A symbolic link, which is never followed.
    Link,
    /// A pipe, device or socket.
    Other,
}

/// How a file is opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Access {
    Read,
    Write,
    WriteOrCreate,
    Create,
}

/// The error of an operation in a folder, with the path concerned.
#[derive(Debug)]
pub enum FolderError {
    /// There is a symbolic link, whose target may be anywhere.
    Link(PathBuf),
    /// There is a file in the place of a folder.
    NotAFolder(PathBuf),
    /// The operation failed.
    Io(PathBuf, io::Error),
}

impl Dir {
    /// Opens a folder that the user names.
    ///
    /// The folder itself may not be a link. In an absolute path, the folders above it are those of the user and the system, and may be
    /// links. A relative path begins in the current folder, whose contents may come from elsewhere, so none of its parts may be a link.
    ///
    /// # Errors
    /// If there is no such folder, it cannot be opened, or a link is in the way.
    pub fn open(path: &Path) -> Result<Dir, FolderError> {
        Dir::walk(path, None, false)
    }

    /// Opens a folder as [`Dir::open`] does, and makes it if it is missing, with the folders above.
    ///
    /// # Errors
    /// If the folder cannot be made or opened, or a link is in the way.
    pub fn make(path: &Path) -> Result<Dir, FolderError> {
        Dir::walk(path, Some(&mut Made::default()), false)
    }

    /// Makes a folder as [`Dir::make`] does, and also returns the folders that were missing.
    ///
    /// # Errors
    /// If the folder cannot be made or opened, or a link is in the way.
    pub fn make_noting(path: &Path) -> Result<(Dir, Made), FolderError> {
        let mut made = Made::default();
        Ok((Dir::walk(path, Some(&mut made), false)?, made))
    }

    /// Opens the folder of a file that the user names, and returns it with the name of the file. With `make`, makes missing folders.
    ///
    /// # Errors
    /// If the folder cannot be opened, a link is in the way, or the path has no file name.
    pub fn of_file(path: &Path, make: bool) -> Result<(Dir, OsString), FolderError> {
        let name = path.file_name().filter(|_| !ends_in_separator(path));
        let Some(name) = name else {
            return Err(FolderError::Io(path.to_owned(), io::ErrorKind::IsADirectory.into()));
        };
        let parent = path.parent().unwrap_or(Path::new(""));
        Ok((Dir::walk(parent, make.then_some(&mut Made::default()), true)?, name.to_owned()))
    }

    /// Opens a folder that is only read, or of the user's own. Its path may have links.
    ///
    /// # Errors
    /// If there is no such folder, or it cannot be opened.
    pub fn of_path(path: &Path) -> Result<Dir, FolderError> {
        let path = if path == Path::new("") { Path::new(".") } else { path };
        let handle = native::open_path(path).map_err(|error| FolderError::Io(path.to_owned(), error))?;
        Ok(Dir { handle: Arc::new(handle), path: path.to_owned() })
    }

    fn walk(path: &Path, mut make: Option<&mut Made>, follow_last: bool) -> Result<Dir, FolderError> {
        // On Windows, a path can begin at the current drive, or in the current folder of a drive.
        let is_elsewhere = !path.is_absolute()
            && matches!(path.components().next(), Some(Component::Prefix(_) | Component::RootDir));
        let whole = if is_elsewhere { std::path::absolute(path) } else { Ok(path.to_owned()) };
        let whole = whole.map_err(|error| FolderError::Io(path.to_owned(), error))?;
        let parts: Vec<Component<'_>> = whole.components().collect();
        let root =
            parts.iter().take_while(|part| matches!(part, Component::Prefix(_) | Component::RootDir)).count();
        // The number of parts that are opened at once, and may be links.
        let mut trusted = match whole.is_absolute() {
            true if follow_last => parts.len(),
            true => parts.len().saturating_sub(1).max(root),
            false => 0,
        };
        let handle = loop {
            let start = if trusted == 0 { PathBuf::from(".") } else { parts[..trusted].iter().collect() };
            match native::open_path(&start) {
                Ok(handle) => break handle,
                Err(error) if make.is_some() && error.kind() == io::ErrorKind::NotFound && trusted > root => {
                    trusted -= 1;
                }
                Err(error) if error.kind() == io::ErrorKind::NotADirectory => {
                    return Err(FolderError::NotAFolder(start));
                }
                Err(error) => return Err(FolderError::Io(start, error)),
            }
        };
        let mut dir = Dir { handle: Arc::new(handle), path: parts[..trusted].iter().collect() };
        for part in &parts[trusted..] {
            if *part != Component::CurDir {
                dir = dir.step(part.as_os_str(), make.as_deref_mut())?;
            }
        }
        dir.path = path.to_owned();
        Ok(dir)
    }

    /// Opens the subfolder of this name.
    fn step(&self, name: &OsStr, make: Option<&mut Made>) -> Result<Dir, FolderError> {
        names::check(name).map_err(|error| FolderError::Io(self.path.join(name), error))?;
        let mut opened = native::open_folder(&self.handle, name);
        if let Some(made) = make
            && opened.as_ref().is_err_and(|error| error.kind() == io::ErrorKind::NotFound)
        {
            opened = match native::make_folder(&self.handle, name) {
                Ok(()) => {
                    made.0.push((self.clone(), name.to_owned()));
                    native::open_folder(&self.handle, name)
                }
                // Another program has just made it.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    native::open_folder(&self.handle, name)
                }
                Err(error) => Err(error),
            };
        }
        let handle = opened.map_err(|error| self.explained(name, error, true))?;
        Ok(Dir { handle: Arc::new(handle), path: self.path.join(name) })
    }

    /// Adds the path to an error, and finds out whether a link is the reason.
    fn explained(&self, name: &OsStr, error: io::Error, is_folder_wanted: bool) -> FolderError {
        let path = self.path.join(name);
        match native::about(&self.handle, name).map(|found| found.kind) {
            Ok(Kind::Link) => FolderError::Link(path),
            Ok(kind) if is_folder_wanted && kind != Kind::Folder => FolderError::NotAFolder(path),
            _ => FolderError::Io(path, error),
        }
    }

    /// Opens the folder that holds a file, and calls `act` with it and the last part of the name.
    fn at<T>(&self, name: &Path, act: impl FnOnce(&Dir, &OsStr) -> io::Result<T>) -> Result<T, FolderError> {
        let mut parts = name.components().peekable();
        let mut dir = None;
        while let Some(part) = parts.next() {
            let Component::Normal(part) = part else { break };
            let folder: &Dir = dir.as_ref().unwrap_or(self);
            if parts.peek().is_none() {
                let done = names::check(part).and_then(|()| act(folder, part));
                return done.map_err(|error| folder.explained(part, error, false));
            }
            dir = Some(folder.step(part, None)?);
        }
        Err(FolderError::Io(
            self.path.join(name),
            io::Error::new(io::ErrorKind::InvalidInput, "it is not a name in a folder"),
        ))
    }

    /// Returns the path of the folder as the user gave it, for messages. Another program may have put something else there.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns a path that leads to this very folder, for a child process to start in. Where the system has no such path, returns the
    /// absolute path of the folder.
    pub fn path_for_child(&self) -> PathBuf {
        native::path_of(&self.handle).unwrap_or_else(|| {
            // The path of the current folder may be empty, which no system accepts.
            let path = Path::new(".").join(&self.path);
            std::path::absolute(&path).unwrap_or(path)
        })
    }

    /// Lets this folder be removed while this value exists. Windows would refuse it otherwise. Other values for the same folder count, too.
    pub(crate) fn release(&self) {
        native::release(&self.handle);
    }

    /// Locks an open file of this folder, which another program will write, as long as the returned value exists. `None` if the lock belongs to
    /// the file itself.
    ///
    /// # Errors
    /// If another process has locked the file.
    #[cfg(feature = "render")]
    pub(crate) fn lock_for_child(&self, name: &OsStr, file: &File) -> Result<Option<File>, TryLockError> {
        native::lock_for_child(&self.handle, name, file)
    }

    /// Returns a text that tells the folder apart from all others, as long as it exists.
    ///
    /// # Errors
    /// If the system does not say when the folder was made.
    pub fn identity(&self) -> Result<String, FolderError> {
        native::identity(&self.handle, &self.path).map_err(|error| FolderError::Io(self.path.clone(), error))
    }

    /// Opens a subfolder.
    ///
    /// # Errors
    /// If there is none, or a link is in the way.
    pub fn folder(&self, name: impl AsRef<Path>) -> Result<Dir, FolderError> {
        self.below(name.as_ref(), None)
    }

    /// Opens a subfolder, and makes it if it is missing, with the folders above.
    ///
    /// # Errors
    /// If it cannot be made, or a link is in the way.
    pub fn make_folder(&self, name: impl AsRef<Path>) -> Result<Dir, FolderError> {
        self.below(name.as_ref(), Some(&mut Made::default()))
    }

    /// Opens a subfolder as [`Dir::make_folder`] does, and also returns the folders that were missing.
    ///
    /// # Errors
    /// If it cannot be made, or a link is in the way.
    pub fn make_folder_noting(&self, name: impl AsRef<Path>) -> Result<(Dir, Made), FolderError> {
        let mut made = Made::default();
        Ok((self.below(name.as_ref(), Some(&mut made))?, made))
    }

    fn below(&self, name: &Path, mut make: Option<&mut Made>) -> Result<Dir, FolderError> {
        let mut dir = self.clone();
        for part in name.components() {
            let Component::Normal(part) = part else {
                let wrong = io::Error::new(io::ErrorKind::InvalidInput, "it is not a name in a folder");
                return Err(FolderError::Io(self.path.join(name), wrong));
            };
            dir = dir.step(part, make.as_deref_mut())?;
        }
        Ok(dir)
    }

    /// Makes a subfolder that must not exist yet, and opens it.
    ///
    /// # Errors
    /// If there is something of this name, or the folder cannot be made.
    pub fn new_folder(&self, name: impl AsRef<Path>) -> Result<Dir, FolderError> {
        let name = name.as_ref();
        self.at(name, |dir, name| native::make_folder(&dir.handle, name))?;
        self.folder(name)
    }

    /// Returns what there is of this name. `None` if there is nothing.
    ///
    /// # Errors
    /// If the folder cannot be read, or a link is on the way to the file.
    pub fn about(&self, name: impl AsRef<Path>) -> Result<Option<About>, FolderError> {
        match self.at(name.as_ref(), |dir, name| native::about(&dir.handle, name)) {
            Ok(about) => Ok(Some(about)),
            Err(error) if error.is_not_found() => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Returns the names of all files and folders in the folder, sorted.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn names(&self) -> Result<Vec<OsString>, FolderError> {
        let names = native::names(&self.handle).map_err(|error| FolderError::Io(self.path.clone(), error));
        names.map(|mut names| {
            names.sort_unstable();
            names
        })
    }

    /// Opens a regular file for reading.
    ///
    /// # Errors
    /// If it cannot be opened, is not a regular file, or a link is in the way.
    pub fn open_file(&self, name: impl AsRef<Path>) -> Result<File, FolderError> {
        self.regular(name.as_ref(), Access::Read)
    }

    /// Opens a regular file for reading and writing.
    ///
    /// # Errors
    /// If it cannot be opened, is not a regular file, or a link is in the way.
    pub fn open_to_write(&self, name: impl AsRef<Path>) -> Result<File, FolderError> {
        self.regular(name.as_ref(), Access::Write)
    }

    /// Opens a regular file for reading and writing, and creates it if it is missing.
    ///
    /// # Errors
    /// If it cannot be opened, is not a regular file, or a link is in the way.
    pub fn open_or_create(&self, name: impl AsRef<Path>) -> Result<File, FolderError> {
        self.regular(name.as_ref(), Access::WriteOrCreate)
    }

    fn regular(&self, name: &Path, access: Access) -> Result<File, FolderError> {
        let not_regular = || io::Error::new(io::ErrorKind::InvalidData, "it is not a regular file");
        self.at(name, |dir, name| {
            // Some devices act when they are opened, so the kind is checked before, and again of what was opened.
            if native::about(&dir.handle, name).is_ok_and(|found| found.kind != Kind::File) {
                return Err(not_regular());
            }
            let file = native::open_file(&dir.handle, name, access)?;
            if file.metadata()?.is_file() { Ok(file) } else { Err(not_regular()) }
        })
    }

    /// Reads a regular file.
    ///
    /// # Errors
    /// If it cannot be read, is not a regular file, or a link is in the way.
    pub fn read(&self, name: impl AsRef<Path>) -> Result<Vec<u8>, FolderError> {
        let name = name.as_ref();
        let mut bytes = Vec::new();
        let read = self.open_file(name)?.read_to_end(&mut bytes);
        read.map_err(|error| FolderError::Io(self.path.join(name), error))?;
        Ok(bytes)
    }

    /// Reads a regular file as text.
    ///
    /// # Errors
    /// If it cannot be read, is not a regular file, is not UTF-8, or a link is in the way.
    pub fn read_to_string(&self, name: impl AsRef<Path>) -> Result<String, FolderError> {
        let name = name.as_ref();
        let wrong =
            |error| FolderError::Io(self.path.join(name), io::Error::new(io::ErrorKind::InvalidData, error));
        String::from_utf8(self.read(name)?).map_err(wrong)
    }

    /// Creates a file that must not exist yet.
    ///
    /// # Errors
    /// If there is something of this name, or the file cannot be created.
    pub fn create_new(&self, name: impl AsRef<Path>) -> Result<File, FolderError> {
        self.at(name.as_ref(), |dir, name| native::open_file(&dir.handle, name, Access::Create))
    }

    /// Creates a file. A file, pipe, device or link of this name is removed before.
    ///
    /// # Errors
    /// If the file cannot be created: for example, there is a folder of this name.
    pub fn create(&self, name: impl AsRef<Path>) -> Result<File, FolderError> {
        let name = name.as_ref();
        self.remove_file(name)?;
        self.create_new(name)
    }

    /// Writes a file under the temporary name `.jabuka-NAME.tmp`, and renames it when it is whole. `fill` writes its contents. On failure,
    /// an existing file of that name stays unchanged, and no temporary file is left.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_whole<T, E: From<FolderError>>(
        &self,
        name: &OsStr,
        fill: impl FnOnce(&mut BufWriter<File>) -> Result<T, E>,
    ) -> Result<T, E> {
        let mut temporary = OsString::from(".jabuka-");
        temporary.push(name);
        temporary.push(".tmp");
        self.remove_file(&temporary)?;
        self.write_as(Path::new(&temporary), Path::new(name), fill)
    }

    /// Writes a file under the name `temporary`, which must be free, and renames it to `name` when it is whole. On failure, the temporary
    /// file is removed.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_as<T, E: From<FolderError>>(
        &self,
        temporary: &Path,
        name: &Path,
        fill: impl FnOnce(&mut BufWriter<File>) -> Result<T, E>,
    ) -> Result<T, E> {
        let mut file = BufWriter::new(self.create_new(temporary)?);
        let written = fill(&mut file).and_then(|what| {
            let ended = file.into_inner().map_err(io::IntoInnerError::into_error);
            ended.map_err(|error| FolderError::Io(self.path.join(name), error))?;
            self.rename(temporary, self, name)?;
            Ok(what)
        });
        written.inspect_err(|_| {
            // If the file cannot be removed, the next process removes it.
            let _: Result<bool, FolderError> = self.remove_file(temporary);
        })
    }

    /// Makes a symbolic link to `target`, for another program to follow.
    ///
    /// # Errors
    /// If there is something of this name, or the system has no links.
    pub fn link(&self, target: &Path, name: impl AsRef<Path>) -> Result<(), FolderError> {
        self.at(name.as_ref(), |dir, name| native::link(target, &dir.handle, name))
    }

    /// Renames a file or folder, also from one folder to another. A file of the new name is replaced.
    ///
    /// # Errors
    /// If it cannot be renamed, or a link is on the way to it.
    pub fn rename(
        &self,
        name: impl AsRef<Path>,
        to: &Dir,
        new_name: impl AsRef<Path>,
    ) -> Result<(), FolderError> {
        let new_name = new_name.as_ref();
        self.at(name.as_ref(), |from, name| {
            let moved =
                to.at(new_name, |to, new_name| native::rename(&from.handle, name, &to.handle, new_name));
            Ok(moved)
        })?
    }

    /// Removes a file, pipe, device or link. Returns false if there was none.
    ///
    /// # Errors
    /// If it is a folder or cannot be removed, or a link is on the way to it.
    pub fn remove_file(&self, name: impl AsRef<Path>) -> Result<bool, FolderError> {
        match self.at(name.as_ref(), |dir, name| native::remove_file(&dir.handle, name)) {
            Ok(()) => Ok(true),
            Err(error) if error.is_not_found() => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// Removes a file, or a folder with all that is in it. A link is removed, and its target stays.
    ///
    /// # Errors
    /// If something cannot be removed.
    pub fn remove_all(&self, name: impl AsRef<Path>) -> Result<(), FolderError> {
        let name = name.as_ref();
        match self.about(name)? {
            None => Ok(()),
            Some(About { kind: Kind::Folder, .. }) => {
                let folder = self.folder(name)?;
                for inner in folder.names()? {
                    folder.remove_all(inner)?;
                }
                folder.release();
                self.at(name, |dir, name| native::remove_folder(&dir.handle, name))
            }
            Some(_) => self.remove_file(name).map(drop),
        }
    }
}

/// Opens the folder of a file. The path of the folder may have links, as it is for a file that is only read or for a folder of the user's
/// own.
fn beside(path: &Path) -> io::Result<(Dir, &OsStr)> {
    let name = path.file_name().ok_or(io::ErrorKind::IsADirectory)?;
    Ok((Dir::of_path(path.parent().unwrap_or(Path::new("")))?, name))
}

/// Opens a regular file for reading. The file itself may not be a link.
///
/// # Errors
/// If it cannot be opened, or is not a regular file.
pub fn open(path: &Path) -> io::Result<File> {
    let (dir, name) = beside(path)?;
    Ok(dir.open_file(name)?)
}

/// Opens a regular file in a folder of the user's own, for reading and writing. Creates it with `create` if it is missing.
///
/// # Errors
/// If it cannot be opened, or is not a regular file.
#[cfg(feature = "render")]
pub(crate) fn open_to_write(path: &Path, create: bool) -> io::Result<File> {
    let (dir, name) = beside(path)?;
    Ok(if create { dir.open_or_create(name)? } else { dir.open_to_write(name)? })
}

/// Creates a file in a folder of the user's own. A file, pipe, device or link of this name is removed before.
///
/// # Errors
/// If the file cannot be created: for example, there is a folder of this name.
#[cfg(feature = "render")]
pub(crate) fn create(path: &Path) -> io::Result<File> {
    let (dir, name) = beside(path)?;
    Ok(dir.create(name)?)
}

/// Reads a regular file. The file itself may not be a link.
///
/// # Errors
/// If it cannot be read, or is not a regular file.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads a regular file as text. The file itself may not be a link.
///
/// # Errors
/// If it cannot be read, is not a regular file, or is not UTF-8.
pub fn read_to_string(path: &Path) -> io::Result<String> {
    String::from_utf8(read(path)?).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}

/// Returns true for `name/`, which can only be a folder.
fn ends_in_separator(path: &Path) -> bool {
    path.as_os_str().as_encoded_bytes().last().is_some_and(|last| std::path::is_separator(char::from(*last)))
}

impl FolderError {
    /// Returns true if the file or folder does not exist.
    pub fn is_not_found(&self) -> bool {
        matches!(self, FolderError::Io(_, error) if error.kind() == io::ErrorKind::NotFound)
    }

    /// Returns the path of the file or folder concerned.
    pub fn path(&self) -> &Path {
        match self {
            FolderError::Link(path) | FolderError::NotAFolder(path) | FolderError::Io(path, _) => path,
        }
    }
}

impl fmt::Display for FolderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FolderError::Link(path) => write!(f, "`{}` is a link, which is not followed", path.display()),
            FolderError::NotAFolder(path) => write!(f, "`{}` is not a folder", path.display()),
            FolderError::Io(path, error) => write!(f, "`{}`: {error}", path.display()),
        }
    }
}

impl std::error::Error for FolderError {}

impl From<FolderError> for io::Error {
    /// Drops the path of the file, since callers of such a function know it. A link can be anywhere on the way to it.
    fn from(error: FolderError) -> io::Error {
        match error {
            FolderError::Link(_) => io::Error::other(error.to_string()),
            FolderError::NotAFolder(_) => io::ErrorKind::NotADirectory.into(),
            FolderError::Io(_, error) => error,
        }
    }
}

#[cfg(all(test, unix, feature = "render"))]
mod tests {
    use std::fs;
    use std::io::Write as _;
    use std::os::unix::fs::symlink;
    use std::process::Command;

    use super::*;

    #[test]
    fn only_regular_files_are_opened_and_others_are_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let dir = Dir::open(folder.path()).unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("file"), "text").unwrap();
        assert_eq!(dir.read_to_string("file").unwrap(), "text");
        assert!(Command::new("mkfifo").arg(path("pipe")).status().unwrap().success());
        symlink(path("file"), path("link")).unwrap();
        symlink("/dev/zero", path("device")).unwrap();
        fs::create_dir(path("folder")).unwrap();
        for name in ["pipe", "link", "device", "folder", "missing"] {
            assert!(dir.read(name).is_err() && dir.open_to_write(name).is_err(), "{name}");
            assert!(read(&path(name)).is_err(), "{name}");
        }
        assert!(read(Path::new("/dev/zero")).is_err());
        for name in ["pipe", "link", "device", "missing"] {
            dir.create(name).unwrap().write_all(b"new").unwrap();
            assert_eq!(dir.read(name).unwrap(), b"new", "{name}");
        }
        assert!(dir.create("folder").is_err());
        assert_eq!(dir.read_to_string("file").unwrap(), "text", "the link was replaced, not followed");
    }

    #[test]
    fn no_operation_leaves_the_folder() {
        let place = tempfile::tempdir().unwrap();
        let at = |name: &str| place.path().join(name);
        fs::create_dir_all(at("in/sub")).unwrap();
        fs::create_dir(at("out")).unwrap();
        fs::write(at("out/file"), "mine").unwrap();
        fs::write(at("in/file"), "ours").unwrap();
        symlink(at("out"), at("in/link")).unwrap();
        let dir = Dir::open(&at("in")).unwrap();
        for name in ["link/file", "../out/file", "/etc/passwd", "", ".", "sub/../../out/file"] {
            assert!(dir.read(name).is_err(), "{name}");
            assert!(dir.create(name).is_err(), "{name}");
            assert!(dir.open_or_create(name).is_err(), "{name}");
            assert!(dir.remove_file(name).is_err(), "{name}");
            assert!(dir.remove_all(name).is_err(), "{name}");
            assert!(dir.rename(name, &dir, "stolen").is_err(), "{name}");
            assert!(dir.rename("file", &dir, name).is_err(), "{name}");
        }
        for name in ["link", "link/new", ".."] {
            assert!(dir.folder(name).is_err() && dir.make_folder(name).is_err(), "{name}");
        }
        assert!(matches!(dir.folder("link").unwrap_err(), FolderError::Link(path) if path == at("in/link")));
        assert!(matches!(dir.folder("file").unwrap_err(), FolderError::NotAFolder(_)));
        // A folder that is removed with a link in it leaves the target of the link.
        symlink(at("out"), at("in/sub/link")).unwrap();
        dir.remove_all("sub").unwrap();
        assert!(!at("in/sub").exists() && at("in/file").exists());
        // An open folder remains the same folder, whatever gets its path.
        fs::rename(at("in"), at("moved")).unwrap();
        symlink(at("out"), at("in")).unwrap();
        dir.create("new").unwrap();
        assert!(at("moved/new").exists() && !at("out/new").exists());
        assert_eq!(fs::read_to_string(at("out/file")).unwrap(), "mine");
    }

    #[test]
    fn a_folder_that_is_named_is_no_link_and_is_made_with_those_above() {
        let place = tempfile::tempdir().unwrap();
        let at = |name: &str| place.path().join(name);
        fs::create_dir(at("real")).unwrap();
        symlink(at("real"), at("link")).unwrap();
        symlink(at("nowhere"), at("dangling")).unwrap();
        for path in ["link", "link/", "link/.", "dangling", "dangling/below"] {
            assert!(matches!(Dir::make(&at(path)).unwrap_err(), FolderError::Link(_)), "{path}");
        }
        let (dir, made) = Dir::make_noting(&at("link/a/b")).unwrap();
        assert!(at("real/a/b").is_dir());
        dir.create("file").unwrap();
        made.remove();
        assert!(at("real/a/b/file").exists(), "a folder with files stays");
        dir.remove_file("file").unwrap();
        made.remove();
        assert!(!at("real/a").exists());
        assert!(Dir::open(&at("missing")).unwrap_err().is_not_found());
        assert!(Dir::of_file(&at("missing/x.png"), false).is_err());
        assert_eq!(Dir::of_file(&at("new/x.png"), true).unwrap().1, "x.png");
    }

    #[test]
    fn a_file_is_whole_or_as_it_was() {
        let place = tempfile::tempdir().unwrap();
        let dir = Dir::open(place.path()).unwrap();
        let fail =
            |_: &mut BufWriter<File>| Err(FolderError::Io(PathBuf::new(), io::ErrorKind::Other.into()));
        let write = |text: &'static str| {
            move |file: &mut BufWriter<File>| {
                file.write_all(text.as_bytes()).map_err(|e| FolderError::Io("".into(), e))
            }
        };
        dir.write_whole(OsStr::new("x"), write("first")).unwrap();
        dir.write_whole::<(), _>(OsStr::new("x"), fail).unwrap_err();
        assert_eq!(dir.read_to_string("x").unwrap(), "first");
        fs::write(place.path().join(".jabuka-x.tmp"), "of a killed process").unwrap();
        dir.write_whole(OsStr::new("x"), write("second")).unwrap();
        assert_eq!((dir.read_to_string("x").unwrap(), dir.names().unwrap().len()), ("second".to_owned(), 1));
    }
}
