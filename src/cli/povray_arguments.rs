//! The command-line arguments for POV-Ray: the program, retries, time limit and further options.

use std::path::PathBuf;
use std::time::Duration;

use crate::diagnostic::is_invisible;
use crate::render::{Images, Job, PovRay, RenderError, Sequence};
use crate::sandbox::Confinement;

use super::picture_arguments::PictureArguments;
use super::terminal;

/// The POV-Ray program that renders the images, and how it is run.
#[derive(clap::Args)]
pub(super) struct PovRayArguments {
    /// The path of the POV-Ray program [default: povray]
    #[arg(long, value_name = "PATH")]
    povray: Option<PathBuf>,
    /// The number of further attempts at a frame after POV-Ray was killed or did not finish
    #[arg(long, value_name = "N", default_value_t = 2)]
    retry: u32,
    /// The time limit for rendering one frame, in seconds [default: far longer than other frames have taken]
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(1..))]
    time_limit: Option<u64>,
    /// Further options for POV-Ray, as in -- +Q4 +AM2
    #[arg(last = true, value_name = "POVRAY OPTIONS", value_parser = parse_option)]
    options: Vec<String>,
}

/// Checks an additional option for POV-Ray. It must not contain line breaks, because all options are recorded in one line.
fn parse_option(argument: &str) -> Result<String, String> {
    if argument.chars().any(is_invisible) {
        return Err("it holds a line break or another character that cannot be seen".to_owned());
    }
    Ok(argument.to_owned())
}

impl PovRayArguments {
    /// Checks quickly that the POV-Ray program exists, without starting it.
    pub(super) fn look(&self) -> Result<(), RenderError> {
        PovRay::locate(self.povray.as_deref()).map(drop)
    }

    /// Finds the POV-Ray program to render into a folder of images. Prints a warning if the system cannot confine it fully.
    pub(super) fn find(&self, images: &Images, confinement: Confinement) -> Result<PovRay, RenderError> {
        let povray = PovRay::find(self.povray.as_deref(), images, confinement)?;
        if let Some(warning) = povray.warning() {
            terminal::error(&format!("warning: {warning}\n"));
        }
        Ok(povray)
    }

    /// Returns the job that renders the scripts of a sequence into a folder of images.
    pub(super) fn job<'a>(
        &self,
        sequence: &'a Sequence,
        images: &'a Images,
        povray: &'a PovRay,
        picture: &PictureArguments,
    ) -> Job<'a> {
        let mut options = picture.options(sequence.size, sequence.transparent);
        options.extend(self.options.iter().cloned());
        Job {
            sequence,
            images,
            povray,
            options,
            jobs: None,
            threads: 1,
            retries: self.retry,
            keep_going: false,
            time_limit: self.time_limit.map(Duration::from_secs),
            verify: false,
        }
    }
}
