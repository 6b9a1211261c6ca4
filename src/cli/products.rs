//! The products that `jabuka render` makes from the images: a film and a contact sheet.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::diagnostic::visible_path;
use crate::overwrite::{CannotOverwrite, ProtectedFiles};
use crate::render::{ContactSheet, Ffmpeg, Film, FilmError, Images, Sequence, Shot};
use crate::sandbox::{Confinement, Launcher};

use super::progress::Progress;
use super::{Failure, render, terminal};

/// The film and the contact sheet to make from rendered images, if they are requested.
pub(super) struct Products {
    film: Option<(Film, Ffmpeg)>,
    /// The frame rate of the film, 1/s, if the command line gives it.
    rate: Option<f64>,
    sheet: Option<ContactSheet>,
}

impl Products {
    /// Reads the requested products from the arguments. Reports a missing ffmpeg at once, before any frame is rendered.
    pub(super) fn of(arguments: &render::Arguments) -> Result<Products, Failure> {
        if arguments.video.is_none() && arguments.film.are_given() {
            let message = "`--video-rate` and `--video-quality` are of a film: name it with `--video FILE`";
            return Err(Failure::Usage(message.to_owned()));
        }
        let film = arguments.video.as_ref().map(|path| {
            let film = Film::new(path).and_then(|film| arguments.film.applied_to(film));
            let film = film.map_err(|error| misnamed(&error))?;
            let ffmpeg = film
                .check(None, Confinement::new(Launcher::of_this_program()))
                .map_err(|error| failed(&error))?;
            Ok((film, ffmpeg))
        });
        let sheet = arguments.contact_sheet.as_ref().map(ContactSheet::new).transpose();
        let sheet = sheet.map_err(|error| misnamed(&error))?;
        Ok(Products { film: film.transpose()?, rate: arguments.film.video_rate, sheet })
    }

    /// Returns an error if the film or the contact sheet would replace a file in `protected`.
    pub(super) fn replace_nothing_of(&self, protected: &ProtectedFiles) -> Result<(), CannotOverwrite> {
        let film = self.film.iter().map(|(film, _)| film.path());
        let mut paths = film.chain(self.sheet.iter().map(ContactSheet::path));
        paths.try_for_each(|path| protected.check(path))
    }

    /// Checks, before any frame is rendered, that the products can be made from images of this size. `rate` is the film's frame rate that
    /// the scene gives, if any.
    pub(super) fn check(&self, size: [u32; 2], rate: Option<f64>) -> Result<(), Failure> {
        let check = || {
            if let Some((film, _)) = &self.film {
                rate.map_or(Ok(()), Film::check_rate)?;
                film.check_size(size)?;
                film.check_place()?;
            }
            self.sheet.as_ref().map_or(Ok(()), ContactSheet::check_place)
        };
        check().map_err(|error| failed(&error))
    }

    /// Returns true if a film or a contact sheet is requested.
    pub(super) fn are_wanted(&self) -> bool {
        self.film.is_some() || self.sheet.is_some()
    }

    /// Makes the film and the contact sheet from the images of a sequence. If only every n-th frame was rendered, `every` is n.
    #[allow(clippy::cast_precision_loss, reason = "numbers of frames are small")]
    pub(super) fn make(
        &self,
        sequence: &Sequence,
        images: &Images,
        every: usize,
        stop: &AtomicBool,
    ) -> Result<(), Failure> {
        let scripts = sequence.scripts();
        if let Some(sheet) = &self.sheet {
            let shot = |script: &crate::render::Script| Shot {
                image: images.image(&script.name),
                frame: script.frame,
                time: sequence.time(script.frame),
            };
            let shots: Vec<Shot> = scripts.iter().map(shot).collect();
            sheet.make(&shots).map_err(|error| failed(&error))?;
            terminal::result(&format!("sheet     {}\n", visible_path(sheet.path())));
        }
        if let Some((film, ffmpeg)) = &self.film {
            let frames: Vec<PathBuf> = scripts.iter().map(|script| images.image(&script.name)).collect();
            // If only every n-th frame is rendered, the frame rate is divided by n, so that the film keeps its duration. A rate from the
            // command line is used as it is.
            let rate = self.rate.or(sequence.video_rate.map(|rate| rate / every as f64));
            let pace = film.pace(sequence.timeline.frame_rate / every as f64, rate);
            let progress = Progress::new(frames.len());
            progress.phase("film");
            let seen = std::cell::Cell::new(0);
            let made = film.make(&frames, pace.rate, ffmpeg, &|| stop.load(Ordering::Relaxed), &|done| {
                (seen.get()..done).for_each(|_| progress.step());
                seen.set(done.max(seen.get()));
            });
            progress.finish();
            made.map_err(|error| failed(&error))?;
            let seconds = frames.len() as f64 / pace.rate;
            let shown =
                pace.of_frames(sequence.timeline.frame_rate, scripts.iter().map(|script| script.frame));
            let speed = shown
                .and_then(|pace| pace.at(&sequence.timeline.speed))
                .and_then(crate::render::film::Pace::in_words)
                .map_or(String::new(), |words| format!(", {words}"));
            terminal::result(&format!("film      {}, {seconds:.2} s{speed}\n", visible_path(film.path())));
        }
        Ok(())
    }
}

fn failed(error: &FilmError) -> Failure {
    terminal::report(&error.report());
    Failure::Errors
}

/// Converts an invalid file name of a film or contact sheet into an error of usage.
fn misnamed(error: &FilmError) -> Failure {
    Failure::Usage(match error.help() {
        Some(help) => format!("{error}: {help}"),
        None => error.to_string(),
    })
}
