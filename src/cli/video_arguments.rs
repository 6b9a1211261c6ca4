//! The arguments for the speed and quality of a film.

use clap::ValueEnum;
use jabuka::render::{Film, FilmError, Quality};

/// How fast and how good a film is.
#[derive(clap::Args)]
pub(super) struct VideoArguments {
    /// Frames per second of the film [default: those of the scene, or 25 where these are not from 1 to 120]
    #[arg(long, value_name = "RATE", value_parser = parse_rate)]
    pub(super) video_rate: Option<f64>,
    /// How good the film is, against the size of its file [default: good]
    #[arg(long, value_enum)]
    video_quality: Option<VideoQuality>,
}

#[derive(Clone, Copy, ValueEnum)]
enum VideoQuality {
    /// A small file, quickly made
    Draft,
    /// Hard to tell from the images
    Good,
    /// For films that are cut and encoded again: about twice the size
    Final,
}

fn parse_rate(argument: &str) -> Result<f64, String> {
    let rate = argument.parse().map_err(|_| "it is not a number".to_owned())?;
    Film::check_rate(rate).map_err(|error| error.to_string())?;
    Ok(rate)
}

impl VideoArguments {
    /// Whether any option is given.
    pub(super) fn are_given(&self) -> bool {
        self.video_rate.is_some() || self.video_quality.is_some()
    }

    /// The film in the requested quality.
    pub(super) fn applied_to(&self, film: Film) -> Result<Film, FilmError> {
        self.quality().map_or(Ok(film.clone()), |quality| film.with_quality(quality))
    }

    /// The requested quality.
    pub(super) fn quality(&self) -> Option<Quality> {
        self.video_quality.map(|name| match name {
            VideoQuality::Draft => Quality::Draft,
            VideoQuality::Good => Quality::Good,
            VideoQuality::Final => Quality::Final,
        })
    }
}
