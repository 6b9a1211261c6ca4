//! The errors that stop the rendering of a whole film.

use std::fmt;
use std::io;
use std::path::PathBuf;

use crate::diagnostic::{Code, Diagnostic, Report};
use crate::system::FolderError;

/// An error that stops the rendering of all frames. If only a single frame fails, that is a [`Fault`](super::Fault), and the rendering
/// continues.
#[derive(Debug)]
pub enum RenderError {
    /// POV-Ray was not found. The path is that of the missing program.
    NoPovray(PathBuf),
    /// The program is not POV-Ray, or is an unknown version of it: its path, and its answer when asked for the version.
    NotPovray(PathBuf, String),
    /// The folder contains no scripts.
    NoScripts(PathBuf),
    /// The folder lacks scripts, because the command that wrote them was interrupted.
    Incomplete(PathBuf),
    /// The folder contains no scripts of the requested frames: its path, and the selection of frames.
    NoSuchFrames(PathBuf, String),
    /// The folder for the images contains files, and jabuka did not make it.
    NotOurs(PathBuf),
    /// The path that jabuka would write to is a symbolic link.
    Link(PathBuf),
    /// Another jabuka process renders into the same folder.
    Locked(PathBuf),
    /// The disk has no space left for images.
    DiskFull(PathBuf),
    /// A file could not be read, written or removed.
    Io(PathBuf, io::Error),
    /// This many frames failed, and none succeeded.
    AllFail(usize),
}

impl RenderError {
    /// Returns the diagnostic code of this error.
    pub fn code(&self) -> Code {
        match self {
            RenderError::NoPovray(_) => Code::NoPovray,
            RenderError::NotPovray(..) => Code::WrongPovray,
            RenderError::NoScripts(_) | RenderError::NoSuchFrames(..) => Code::NoScripts,
            RenderError::Incomplete(_) => Code::IncompleteScripts,
            RenderError::NotOurs(_) => Code::FolderNotOurs,
            RenderError::Link(_) => Code::Link,
            RenderError::Locked(_) => Code::FolderLocked,
            RenderError::DiskFull(_) => Code::DiskFull,
            RenderError::Io(..) => Code::CannotWrite,
            RenderError::AllFail(_) => Code::AllFramesFail,
        }
    }

    /// Returns the error as a diagnostic, with advice.
    pub fn report(&self) -> Report {
        let diagnostic = Diagnostic::error(self.code(), self.to_string());
        let diagnostic = match self.help() {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        };
        Report { diagnostics: vec![diagnostic], ..Report::default() }
    }

    /// Returns advice on how to correct the error. `None` if the error message alone is enough.
    pub fn help(&self) -> Option<&'static str> {
        match self {
            RenderError::NoPovray(_) => Some(
                "install POV-Ray 3.7: `apt install povray povray-includes` on Debian and Ubuntu, `brew install povray` \
                 on macOS, `dnf install povray` on Fedora, and from povray.org on Windows; or say where it is with `--povray PATH`; \
                 `jabuka doctor` tells what is there",
            ),
            RenderError::NotPovray(..) => {
                Some("jabuka needs POV-Ray 3.7 or 3.8: say where it is with `--povray PATH`")
            }
            RenderError::NoScripts(_) => {
                Some("`jabuka compile` writes them; `jabuka render SCENE.toml` does both")
            }
            RenderError::Incomplete(_) => Some("run `jabuka compile` again"),
            RenderError::NotOurs(_) => Some("name an empty or a new folder with `-o`"),
            RenderError::Link(_) => Some("remove the link, or name the folder that it leads to"),
            RenderError::Locked(_) => {
                Some("wait until the other run has ended, or name another folder with `-o`")
            }
            RenderError::DiskFull(_) => {
                Some("make room and run the same command again: it goes on where this one has stopped")
            }
            RenderError::AllFail(_) => Some("with `--keep-going`, the other frames are tried as well"),
            RenderError::Io(..) | RenderError::NoSuchFrames(..) => None,
        }
    }

    /// Returns a function that converts an I/O error of this file. A full disk becomes [`RenderError::DiskFull`].
    pub(super) fn io(path: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> RenderError {
        let path = path.into();
        |error| match error.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => RenderError::DiskFull(path),
            _ => RenderError::Io(path, error),
        }
    }
}

impl From<FolderError> for RenderError {
    fn from(error: FolderError) -> RenderError {
        match error {
            FolderError::Link(path) => RenderError::Link(path),
            FolderError::NotAFolder(path) => RenderError::Io(path, io::ErrorKind::NotADirectory.into()),
            FolderError::Io(path, error) => RenderError::io(path)(error),
        }
    }
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RenderError::NoPovray(path) => write!(f, "POV-Ray is not there: no program `{}`", path.display()),
            RenderError::NotPovray(path, said) => {
                write!(f, "`{}` is no POV-Ray that jabuka can use: it says `{said}`", path.display())
            }
            RenderError::NoScripts(path) => {
                write!(f, "the folder `{}` holds no scripts of frames", path.display())
            }
            RenderError::Incomplete(path) => {
                write!(f, "not all scripts are in `{}`: what writes them was broken off", path.display())
            }
            RenderError::NoSuchFrames(path, frames) => {
                write!(f, "the folder `{}` has no scripts of the frames {frames}", path.display())
            }
            RenderError::NotOurs(path) => {
                write!(f, "the folder `{}` is not empty, and jabuka did not make it", path.display())
            }
            RenderError::Link(path) => write!(f, "`{}` is a link, which is not followed", path.display()),
            RenderError::Locked(path) => {
                write!(f, "another jabuka renders into the folder `{}`", path.display())
            }
            RenderError::DiskFull(path) => write!(f, "no space is left for `{}`", path.display()),
            RenderError::Io(path, error) => write!(f, "`{}`: {error}", path.display()),
            RenderError::AllFail(frames) => {
                write!(f, "stopped, since all of the first {frames} frames failed")
            }
        }
    }
}

impl std::error::Error for RenderError {}
