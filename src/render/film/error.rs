//! The errors that can occur while a film or a contact sheet is made.

use std::fmt;
use std::io;
use std::path::PathBuf;

use super::{Format, Pace};
use crate::diagnostic::{Code, Diagnostic, Report};
use crate::system::FolderError;

/// An error of making a film or a contact sheet.
#[derive(Debug)]
pub enum FilmError {
    /// The extension of the film's name is not that of a known format.
    FilmName(PathBuf),
    /// The name of the contact sheet does not end in `.png`.
    SheetName(PathBuf),
    /// The path of the film or the contact sheet is that of a folder.
    Folder(PathBuf),
    /// There are no images to make a film or a contact sheet from.
    NoImages,
    /// The frame rate is outside of the allowed range. The number is in frames per second.
    Rate(f64),
    /// A quality was requested for a format that has no choice of quality.
    NoQuality(PathBuf),
    /// The images are too large for a film of this format.
    TooLarge {
        /// The format of the film.
        format: Format,
        /// The width and height of the images, pixels.
        size: [u32; 2],
        /// The longest side of an image that the format allows, pixels.
        most: u32,
    },
    /// ffmpeg cannot be used: the path of the program, and the reason.
    NoFfmpeg(PathBuf, String),
    /// This ffmpeg was built without the required encoder: the path of the program, and the name of the encoder.
    NoEncoder(PathBuf, &'static str),
    /// An image is missing, or is not a complete PNG: its path, and the reason.
    Image(PathBuf, String),
    /// Two images differ in size.
    Sizes {
        /// The path of the first image, with its width and height in pixels.
        first: (PathBuf, (usize, usize)),
        /// The path of the first image of a different size, with its width and height in pixels.
        other: (PathBuf, (usize, usize)),
    },
    /// Another process writes the same file.
    Locked(PathBuf),
    /// The disk has no space left for the file.
    DiskFull(PathBuf),
    /// A folder on the path of the file is a symbolic link.
    Link(PathBuf),
    /// A file could not be written.
    Io(PathBuf, io::Error),
    /// ffmpeg failed: the path of the film, how ffmpeg ended, and its last messages.
    Failed(PathBuf, String, String),
    /// ffmpeg reported success, but the numbers of frames and images differ: the path of the film, the number of frames, and the number of
    /// images.
    Count(PathBuf, usize, usize),
    /// The user has stopped the program.
    Cancelled,
}

impl FilmError {
    /// Returns the diagnostic code of this error.
    pub fn code(&self) -> Code {
        match self {
            FilmError::FilmName(_) | FilmError::SheetName(_) => Code::BadFilmName,
            FilmError::NoImages => Code::NoImages,
            FilmError::Rate(_) => Code::BadFilmRate,
            FilmError::NoQuality(_) => Code::BadFilmName,
            FilmError::TooLarge { .. } => Code::BadFilmSize,
            FilmError::NoFfmpeg(..) | FilmError::NoEncoder(..) => Code::NoFfmpeg,
            FilmError::Image(..) => Code::BadImage,
            FilmError::Sizes { .. } => Code::ImageSizes,
            FilmError::Link(_) => Code::Link,
            FilmError::Folder(_) | FilmError::Locked(_) | FilmError::DiskFull(_) | FilmError::Io(..) => {
                Code::CannotWrite
            }
            FilmError::Failed(..) | FilmError::Count(..) => Code::FfmpegFailed,
            FilmError::Cancelled => Code::Stopped,
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
            FilmError::FilmName(_) => Some(
                "`.mp4` plays nearly everywhere, `.webm` in browsers, and `.gif` where only images may stand",
            ),
            FilmError::NoFfmpeg(..) => Some(
                "install it: `apt install ffmpeg` on Debian and Ubuntu, `brew install ffmpeg` on macOS, \
                 `dnf install ffmpeg-free` on Fedora",
            ),
            FilmError::NoEncoder(..) => Some(
                "install a complete one: `apt install ffmpeg` on Debian and Ubuntu, `brew install ffmpeg` on macOS, \
                 `dnf install ffmpeg` from RPM Fusion on Fedora; or name a film of another kind: `.mp4`, `.webm`, `.gif`",
            ),
            FilmError::Rate(_) => Some("most films have 24, 25, 30 or 60"),
            FilmError::NoQuality(_) => {
                Some("leave out `--video-quality`, or name a film that ends in `.mp4` or `.webm`")
            }
            FilmError::TooLarge { .. } => {
                Some("make the images smaller: by `output.size` in the scene, or by `--size`")
            }
            FilmError::Image(..) | FilmError::Sizes { .. } => {
                Some("remove the image, so that it is rendered again")
            }
            FilmError::Locked(_) => Some("wait until the other run has ended, or name another file"),
            FilmError::Folder(_) => Some("name a file"),
            FilmError::Link(_) => Some("name the folder that it leads to"),
            FilmError::DiskFull(_) => Some("make room; the images are kept"),
            FilmError::Cancelled => Some("run the same command again: the images are kept"),
            FilmError::SheetName(_)
            | FilmError::NoImages
            | FilmError::Io(..)
            | FilmError::Failed(..)
            | FilmError::Count(..) => None,
        }
    }

    /// Returns a function that converts an I/O error of this output file. A full disk becomes [`FilmError::DiskFull`].
    pub(in crate::render) fn io(path: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> FilmError {
        let path = path.into();
        |error| match error.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => FilmError::DiskFull(path),
            _ => FilmError::Io(path, error),
        }
    }
}

impl From<FolderError> for FilmError {
    fn from(error: FolderError) -> FilmError {
        match error {
            FolderError::Link(path) => FilmError::Link(path),
            FolderError::NotAFolder(path) => FilmError::Io(path, io::ErrorKind::NotADirectory.into()),
            FolderError::Io(path, error) => FilmError::io(path)(error),
        }
    }
}

impl fmt::Display for FilmError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FilmError::FilmName(path) => {
                let [mp4, webm, gif] = Format::ALL.map(Format::extension);
                write!(
                    f,
                    "the name of a film ends in `.{mp4}`, `.{webm}` or `.{gif}`, and `{}` does not",
                    path.display()
                )
            }
            FilmError::SheetName(path) => {
                write!(f, "the name of a contact sheet ends in `.png`, and `{}` does not", path.display())
            }
            FilmError::Folder(path) => write!(f, "`{}` is a folder", path.display()),
            FilmError::NoImages => f.write_str("there are no images to show"),
            FilmError::Rate(rate) => {
                let (low, high) = (Pace::RATES.start(), Pace::RATES.end());
                write!(f, "a film shows from {low} to {high} frames a second, not {rate}")
            }
            FilmError::NoQuality(path) => {
                write!(f, "`{}` has 256 colors in any quality", path.display())
            }
            FilmError::TooLarge { format, size: [width, height], most } => write!(
                f,
                "a film `.{}` has images of at most {most} × {most} pixels, not {width} × {height}",
                format.extension()
            ),
            FilmError::NoFfmpeg(path, why) => {
                write!(f, "ffmpeg, which makes films, cannot be used: `{}`: {why}", path.display())
            }
            FilmError::NoEncoder(path, encoder) => {
                write!(f, "`{}` was built without the encoder `{encoder}`", path.display())
            }
            FilmError::Image(path, why) => write!(f, "the image `{}` cannot be read: {why}", path.display()),
            FilmError::Sizes { first: (first, (w1, h1)), other: (other, (w2, h2)) } => write!(
                f,
                "the images differ in size: `{}` has {w1} × {h1} pixels, and `{}` has {w2} × {h2}",
                first.display(),
                other.display()
            ),
            FilmError::Locked(path) => write!(f, "another jabuka writes `{}`", path.display()),
            FilmError::DiskFull(path) => write!(f, "no space is left for `{}`", path.display()),
            FilmError::Link(path) => write!(f, "`{}` is a link, which is not followed", path.display()),
            FilmError::Io(path, error) => write!(f, "`{}`: {error}", path.display()),
            FilmError::Failed(path, how, said) if said.is_empty() => {
                write!(f, "ffmpeg could not make `{}`: it {how} without a word", path.display())
            }
            FilmError::Failed(path, how, said) => {
                write!(f, "ffmpeg could not make `{}`: it {how}, and said last:\n{said}", path.display())
            }
            FilmError::Count(path, frames, images) => {
                write!(f, "ffmpeg made {frames} frames of {images} images for `{}`", path.display())
            }
            FilmError::Cancelled => f.write_str("stopped"),
        }
    }
}

impl std::error::Error for FilmError {}
