//! The command-line arguments for the frame rate and quality of a film.

use crate::render::{Film, FilmError, Quality};
use clap::ValueEnum;

/// The frame rate and quality of a film.
#[derive(clap::Args)]
pub(super) struct VideoArguments {
    /// The frame rate of the film, per second [default: that of the scene, or 25 if that is not from 1 to 120]
    #[arg(long, value_name = "RATE", value_parser = parse_rate)]
    pub(super) video_rate: Option<f64>,
    /// The quality of the film; a higher quality needs a larger file [default: good]
    #[arg(long, value_enum)]
    video_quality: Option<VideoQuality>,
}

#[derive(Clone, Copy, ValueEnum)]
enum VideoQuality {
    /// A small file that is made quickly
    Draft,
    /// Visually almost identical to the images
    Good,
    /// For films that will be edited and encoded again: about twice the size
    Final,
}

fn parse_rate(argument: &str) -> Result<f64, String> {
    let rate = argument.parse().map_err(|_| "it is not a number".to_owned())?;
    Film::check_rate(rate).map_err(|error| error.to_string())?;
    Ok(rate)
}

impl VideoArguments {
    /// Returns true if the user gave the frame rate or the quality of a film.
    pub(super) fn are_given(&self) -> bool {
        self.video_rate.is_some() || self.video_quality.is_some()
    }

    /// Returns the film with the requested quality. Unchanged if the user gave none.
    pub(super) fn applied_to(&self, film: Film) -> Result<Film, FilmError> {
        self.quality().map_or(Ok(film.clone()), |quality| film.with_quality(quality))
    }

    /// Returns the requested quality of the film. `None` if the user gave none.
    pub(super) fn quality(&self) -> Option<Quality> {
        self.video_quality.map(|name| match name {
            VideoQuality::Draft => Quality::Draft,
            VideoQuality::Good => Quality::Good,
            VideoQuality::Final => Quality::Final,
        })
    }
}
