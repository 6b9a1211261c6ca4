//! The arguments for POV-Ray: which one renders, and what it may do.

use std::path::PathBuf;
use std::time::Duration;

use jabuka::diagnostic::is_invisible;
use jabuka::render::{Images, Job, PovRay, RenderError, Sequence};
use jabuka::sandbox::Confinement;

use super::picture_arguments::PictureArguments;
use super::say;

/// Which POV-Ray renders, and what it may do.
#[derive(clap::Args)]
pub(super) struct PovRayArguments {
    /// The program POV-Ray [default: povray]
    #[arg(long, value_name = "PATH")]
    povray: Option<PathBuf>,
    /// How often a frame is tried again after POV-Ray was killed or hung
    #[arg(long, value_name = "N", default_value_t = 2)]
    retry: u32,
    /// How long a frame may take, in seconds [default: far longer than others have taken]
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(1..))]
    time_limit: Option<u64>,
    /// Further options for POV-Ray, as in -- +Q4 +AM2
    #[arg(last = true, value_name = "POVRAY OPTIONS", value_parser = parse_option)]
    options: Vec<String>,
}

/// An option of POV-Ray. Records keep all options in one line, so it must not contain line breaks.
fn parse_option(argument: &str) -> Result<String, String> {
    if argument.chars().any(is_invisible) {
        return Err("it holds a line break or another character that cannot be seen".to_owned());
    }
    Ok(argument.to_owned())
}

impl PovRayArguments {
    /// Quickly checks that there is a POV-Ray.
    pub(super) fn look(&self) -> Result<(), RenderError> {
        PovRay::locate(self.povray.as_deref()).map(drop)
    }

    /// The POV-Ray for a folder of images. Warns if it is less confined than it should be.
    pub(super) fn find(&self, images: &Images, confinement: Confinement) -> Result<PovRay, RenderError> {
        let povray = PovRay::find(self.povray.as_deref(), &images.povray_memory(), confinement)?;
        if let Some(warning) = povray.warning() {
            say::error(&format!("warning: {warning}\n"));
        }
        Ok(povray)
    }

    /// The job of rendering these images.
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
