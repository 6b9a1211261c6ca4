//! Makes films from images, by ffmpeg.
//!
//! jabuka reads the images and pipes their pixels to ffmpeg. So the images may have any file names, an error message can name the broken
//! image, and ffmpeg's own PNG reader is not needed. A film has as many frames as there are images; ffmpeg's count is checked.
//!
//! **Colors.** The bytes of the images are sRGB. For `.mp4` and `.webm`, they are converted by the BT.709 matrix to the limited range, and
//! the film's metadata says so. Without this metadata, players guess the matrix from the size. Color has half the resolution of brightness
//! (4:2:0), since many players support nothing else.
//!
//! **Sizes.** `.mp4` and `.webm` need even widths and heights. An image with an odd width or height gets one more column or row, a copy of
//! the last.
//!
//! **Transparency.** `.mp4` and `.webm` show transparent pixels on white. A `.gif` keeps transparency as far as the format can: a pixel
//! that is at least half opaque becomes opaque, any other fully transparent.
//!
//! **Rates.** [`Pace`] chooses the frame rate of a film if none is given. The file has the exact rate: 23.976 is 2997/125. The times in a
//! `.webm` are whole milliseconds. The frames of a `.gif` last whole hundredths of a second, and at least two, since browsers show a frame
//! of one hundredth for ten. So 25 and 50 frames a second are exact. Delays of 4, 4, 4, 4, 4, 5 hundredths give 24 frames a second, and
//! delays of 3, 3, 4 give 30; the duration of the film is right. Higher rates are shown at 50: a second of 60 frames takes 1.2 s.
//! [`Film::shown_rate`] returns the shown rate.
//!
//! **Reproducibility.** The same images and the same build of ffmpeg give the same bytes on any number of cores. The number of threads is
//! [fixed](Format), since the output of libx264 and libvpx depends on it. Another version of ffmpeg may give other bytes.

mod error;
mod ffmpeg;
mod format;
mod target;

use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

pub use crate::picture::Pace;
pub use error::FilmError;
pub use ffmpeg::Ffmpeg;
pub use format::Format;
pub(super) use target::Target;

use super::Quality;
use super::picture::{self, Picture, Size};
use crate::sandbox::Confinement;

/// A film to make: its path, format and quality.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film {
    path: PathBuf,
    format: Format,
    quality: Quality,
}

impl Film {
    /// Plans a film with this path. The extension selects the format.
    ///
    /// # Errors
    /// If the extension is unknown, or the path is that of a folder.
    pub fn new(path: impl Into<PathBuf>) -> Result<Film, FilmError> {
        let path = path.into();
        let Some(format) = Format::of(&path) else {
            return Err(FilmError::FilmName(path));
        };
        if path.is_dir() {
            return Err(FilmError::Folder(path));
        }
        Ok(Film { path, format, quality: Quality::default() })
    }

    /// Sets the quality of the film.
    ///
    /// # Errors
    /// If the format has no choice of quality (`.gif`).
    pub fn with_quality(self, quality: Quality) -> Result<Film, FilmError> {
        match self.format {
            Format::Gif => Err(FilmError::NoQuality(self.path)),
            Format::Mp4 | Format::Webm => Ok(Film { quality, ..self }),
        }
    }

    /// Returns the path of the film.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the format of the film.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Returns the frame rate at which players show a film that is made for `frame_rate`, in frames per second. Only `.gif` limits the
    /// rate, to 50.
    pub fn shown_rate(&self, frame_rate: f64) -> f64 {
        match self.format {
            Format::Gif => frame_rate.min(50.0),
            Format::Mp4 | Format::Webm => frame_rate,
        }
    }

    /// Returns the frame rate of the film and its speed relative to the scene. `asked` is the requested frame rate, `None` for a rate that
    /// suits the scene.
    pub fn pace(&self, scene_rate: f64, asked: Option<f64>) -> Pace {
        let rate = Pace::new(scene_rate, asked).rate;
        Pace::new(scene_rate, Some(self.shown_rate(rate)))
    }

    /// Finds the ffmpeg for the film, so that a missing program is reported before anything is rendered. `ffmpeg` is its path, `None` for
    /// `ffmpeg` in the `PATH`. The confinement applies to every run of ffmpeg.
    ///
    /// # Errors
    /// If ffmpeg does not exist, or cannot make this format.
    pub fn check(&self, ffmpeg: Option<&Path>, confinement: Confinement) -> Result<Ffmpeg, FilmError> {
        Ffmpeg::find(ffmpeg, self.format, confinement)
    }

    /// Checks that a frame rate, in frames per second, is in the range that films allow.
    ///
    /// # Errors
    /// If the rate is out of range.
    pub fn check_rate(frame_rate: f64) -> Result<(), FilmError> {
        if Pace::RATES.contains(&frame_rate) { Ok(()) } else { Err(FilmError::Rate(frame_rate)) }
    }

    /// Checks that the format of the film allows images of this size, pixels.
    ///
    /// # Errors
    /// If the images are too large.
    pub fn check_size(&self, size: [u32; 2]) -> Result<(), FilmError> {
        let most = self.format.longest_side();
        if size.iter().all(|side| *side <= most) {
            return Ok(());
        }
        Err(FilmError::TooLarge { format: self.format, size, most })
    }

    /// Checks that the film can be written to its path. Creates the parent folder if needed.
    ///
    /// # Errors
    /// If no file can be written to this path, or another process writes the same file.
    pub fn check_place(&self) -> Result<(), FilmError> {
        Target::create(&self.path).map(drop)
    }

    /// Makes the film from images, in the given order. Calls `cancelled` many times a second, on this thread, and `progress` with each new
    /// number of written frames. An existing film is replaced only when the new one is complete.
    ///
    /// # Errors
    /// If an image cannot be read or differs in size, ffmpeg fails, the film cannot be written, or `cancelled` returns true.
    pub fn make(
        &self,
        images: &[PathBuf],
        frame_rate: f64,
        ffmpeg: &Ffmpeg,
        cancelled: &dyn Fn() -> bool,
        progress: &dyn Fn(usize),
    ) -> Result<(), FilmError> {
        Film::check_rate(frame_rate)?;
        // The headers of all images are read first, which is quick, so that missing images are reported before the long work.
        let size = picture::common_size(images.iter())?;
        let target = Target::create(&self.path)?;
        let samples = self.format.samples(images.len());
        let rate = self.shown_rate(frame_rate);
        let mut arguments = self.format.arguments(size, rate, samples.len(), self.quality);
        let mut output = OsString::from("file:");
        output.push(target.temporary());
        arguments.push(output);

        let order = samples.into_iter().chain(0..images.len());
        let feed = |pipe: &mut dyn Write, stop: &AtomicBool| {
            for index in order {
                if stop.load(Ordering::Relaxed) {
                    return Ok(());
                }
                let fed = self.pixels(&images[index], size).map(|pixels| pipe.write_all(&pixels));
                match fed {
                    Ok(Ok(())) => {}
                    // ffmpeg has closed its end of the pipe. Its own error message gives the reason.
                    Ok(Err(error)) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
                    Ok(Err(error)) => return fail(stop, FilmError::io(&self.path)(error)),
                    Err(error) => return fail(stop, error),
                }
            }
            Ok(())
        };
        let end = ffmpeg.run(&arguments, &target, feed, cancelled, progress)?;
        self.judge(end, images.len())?;
        target.finish()
    }

    /// Checks that ffmpeg has succeeded, and has written as many frames as there are images.
    fn judge(&self, end: ffmpeg::End, images: usize) -> Result<(), FilmError> {
        // ffmpeg's exit code is 0 even if it could not write the last bytes. The film cannot be played then.
        let unwritten = ["Error writing", "Error closing", "File too large", "Input/output error"];
        let full = ["No space left on device", "Disk quota exceeded"];
        let says = |words: &[&str]| words.iter().any(|word| end.said.contains(word));
        if says(&full) {
            return Err(FilmError::DiskFull(self.path.clone()));
        }
        if !end.success || says(&unwritten) {
            return Err(FilmError::Failed(self.path.clone(), end.how, end.said));
        }
        if end.frames != images {
            return Err(FilmError::Count(self.path.clone(), end.frames, images));
        }
        Ok(())
    }

    /// Reads an image, and returns its pixels in the layout that ffmpeg expects for the format.
    fn pixels(&self, path: &Path, size: Size) -> Result<Vec<u8>, FilmError> {
        let picture = Picture::read(path)?;
        if picture.size != size {
            // The size differs from that in the header, so the file was changed after its header was read.
            return Err(FilmError::Image(path.to_owned(), "it has been changed meanwhile".to_owned()));
        }
        Ok(match self.format {
            Format::Gif => picture.rgba,
            Format::Mp4 | Format::Webm => even(&picture.over_white(), size),
        })
    }
}

/// Stops feeding images to ffmpeg, and returns the error.
fn fail(stop: &AtomicBool, error: FilmError) -> Result<(), FilmError> {
    stop.store(true, Ordering::Relaxed);
    Err(error)
}

/// Rounds a length up to an even number.
fn next_even(length: usize) -> usize {
    length + length % 2
}

/// Makes the width and height of an image even, by copies of its last column and its last row. The pixels have three bytes each.
fn even(rgb: &[u8], (width, height): Size) -> Vec<u8> {
    let mut pixels = Vec::with_capacity(3 * next_even(width) * next_even(height));
    let last = height.saturating_sub(1);
    for y in 0..next_even(height) {
        let start = 3 * width * y.min(last);
        pixels.extend(&rgb[start..start + 3 * width]);
        if width % 2 == 1 {
            pixels.extend(&rgb[start + 3 * width - 3..start + 3 * width]);
        }
    }
    pixels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_odd_size_gets_copies_of_its_last_column_and_row() {
        let pixel = |value| [value; 3];
        let odd: Vec<u8> = [1, 2, 3].map(pixel).concat();
        assert_eq!(even(&odd, (3, 1)), [1, 2, 3, 3, 1, 2, 3, 3].map(pixel).concat());
        assert_eq!(even(&odd[..6], (2, 1)), [1, 2, 1, 2].map(pixel).concat());
        let square: Vec<u8> = [1, 2, 3, 4].map(pixel).concat();
        assert_eq!(even(&square, (2, 2)), square);
    }

    #[test]
    fn the_ending_says_the_format() {
        let format = |name: &str| Film::new(name).map(|film| film.format()).ok();
        assert_eq!(format("no/such.folder/A.MP4"), Some(Format::Mp4));
        assert_eq!(format("x.webm"), Some(Format::Webm));
        assert_eq!(format("x.y.gif"), Some(Format::Gif));
        for name in ["x.avi", "mp4", ".mp4", "x.mp4/", "x.mp4.png", ""] {
            let error = Film::new(name).map_err(|error| error.to_string());
            if name == "x.mp4/" {
                assert!(error.is_ok(), "a path without its last slash");
                continue;
            }
            let message =
                format!("the name of a film ends in `.mp4`, `.webm` or `.gif`, and `{name}` does not");
            assert_eq!(error.unwrap_err(), message);
        }
    }
}
