//! Images → film, by ffmpeg.
//!
//! jabuka reads the images and pipes their pixels to ffmpeg. So images with any names make a film, a broken image can be named,
//! and ffmpeg's own PNG reader is not needed. A film has as many frames as there are images; ffmpeg's count is checked.
//!
//! **Colors.** The bytes are sRGB. For `.mp4` and `.webm`, they are converted by the BT.709 matrix to the limited range, and
//! the film is marked so; without the mark, players guess from the size. Color has half the resolution (4:2:0), since nothing
//! else plays everywhere.
//!
//! **Sizes.** `.mp4` and `.webm` need even widths and heights. An odd one gets one more column or row, a copy of the last.
//!
//! **Transparency.** `.mp4` and `.webm` show transparent pixels on white. A `.gif` keeps transparency as far as the format can:
//! a pixel that is at least half opaque becomes opaque, any other fully transparent.
//!
//! **Rates.** [`Pace`] chooses the rate of a film if none is given. The file has the exact rate: 23.976 is 2997/125. The times
//! in a `.webm` are whole milliseconds. The frames of a `.gif` last whole hundredths of a second, and at least two, since
//! browsers replace one by ten. So 25 and 50 frames a second are exact, 24 have delays of 4, 4, 4, 4, 4, 5 hundredths, 30 have
//! 3, 3, 4; both have the right duration. Higher rates are shown at 50: a second of 60 frames takes 1.2 s. [`Film::shown_rate`]
//! gives the shown rate.
//!
//! **Sameness.** The same images and the same build of ffmpeg give the same bytes on any number of cores: the number of threads
//! is [fixed](Format), since libx264 and libvpx depend on it. Another version of ffmpeg may give other bytes.

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

/// A planned film.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film {
    path: PathBuf,
    format: Format,
    quality: Quality,
}

impl Film {
    /// A film of this name, whose ending gives the format.
    ///
    /// # Errors
    /// If the ending is unknown, or there is a folder of this name.
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

    /// The same film in another quality.
    ///
    /// # Errors
    /// If the format has no qualities: a `.gif`.
    pub fn with_quality(self, quality: Quality) -> Result<Film, FilmError> {
        match self.format {
            Format::Gif => Err(FilmError::NoQuality(self.path)),
            Format::Mp4 | Format::Webm => Ok(Film { quality, ..self }),
        }
    }

    /// The path of the film.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its format.
    pub fn format(&self) -> Format {
        self.format
    }

    /// The frames per second at which the film will be shown, if it is made for this rate. All formats but `.gif` keep the rate.
    pub fn shown_rate(&self, frame_rate: f64) -> f64 {
        match self.format {
            Format::Gif => frame_rate.min(50.0),
            Format::Mp4 | Format::Webm => frame_rate,
        }
    }

    /// The speed at which the film shows images of a scene with this frame rate: the requested rate, or else one that people
    /// can watch.
    pub fn pace(&self, scene_rate: f64, asked: Option<f64>) -> Pace {
        let rate = Pace::new(scene_rate, asked).rate;
        Pace::new(scene_rate, Some(self.shown_rate(rate)))
    }

    /// Finds the ffmpeg for the film, so that a missing one is noticed before anything is rendered: the given program, or else
    /// `ffmpeg` in the `PATH`. The confinement applies to all its runs.
    ///
    /// # Errors
    /// If it does not exist, or cannot make this format.
    pub fn check(&self, ffmpeg: Option<&Path>, confinement: Confinement) -> Result<Ffmpeg, FilmError> {
        Ffmpeg::find(ffmpeg, self.format, confinement)
    }

    /// Checks that a film can have this rate, in frames per second.
    ///
    /// # Errors
    /// If it cannot.
    pub fn check_rate(frame_rate: f64) -> Result<(), FilmError> {
        if Pace::RATES.contains(&frame_rate) { Ok(()) } else { Err(FilmError::Rate(frame_rate)) }
    }

    /// Checks that a film of this format can have images of this size.
    ///
    /// # Errors
    /// If they are too large.
    pub fn check_size(&self, size: [u32; 2]) -> Result<(), FilmError> {
        let most = self.format.longest_side();
        if size.iter().all(|side| *side <= most) {
            return Ok(());
        }
        Err(FilmError::TooLarge { format: self.format, size, most })
    }

    /// Checks that the film can be written to its path. Creates its folder, if needed.
    ///
    /// # Errors
    /// If no file can be written there, or another process writes it.
    pub fn check_place(&self) -> Result<(), FilmError> {
        Target::create(&self.path).map(drop)
    }

    /// Makes the film from some images, in their order. Many times a second, on this thread, it asks `cancelled` and tells
    /// `progress` the number of frames in the film. An existing film stays until the new one is whole.
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
        // All headers are read first, which is quick, so that missing images are reported before the long work.
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
                    // ffmpeg has closed its end, and will report the reason.
                    Ok(Err(error)) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
                    Ok(Err(error)) => return fail(stop, FilmError::io(&self.path)(error)),
                    Err(error) => return fail(stop, error),
                }
            }
            Ok(())
        };
        let end = ffmpeg.run(&arguments, target.temporary(), feed, cancelled, progress)?;
        self.judge(end, images.len())?;
        target.finish()
    }

    /// Checks that a run of ffmpeg has made a film of this many images.
    fn judge(&self, end: ffmpeg::End, images: usize) -> Result<(), FilmError> {
        // ffmpeg ends with code 0 even if it could not write the last bytes, and then the film cannot be played.
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

    /// The pixels of an image as ffmpeg gets them.
    fn pixels(&self, path: &Path, size: Size) -> Result<Vec<u8>, FilmError> {
        let picture = Picture::read(path)?;
        if picture.size != size {
            // The image has changed since its header was read.
            return Err(FilmError::Image(path.to_owned(), "it has been changed meanwhile".to_owned()));
        }
        Ok(match self.format {
            Format::Gif => picture.rgba,
            Format::Mp4 | Format::Webm => even(&picture.over_white(), size),
        })
    }
}

/// Ends the feeding of ffmpeg with an error.
fn fail(stop: &AtomicBool, error: FilmError) -> Result<(), FilmError> {
    stop.store(true, Ordering::Relaxed);
    Err(error)
}

/// The next even number.
fn next_even(length: usize) -> usize {
    length + length % 2
}

/// A picture of three bytes a pixel with even width and height: the last column and the last row may be doubled.
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
