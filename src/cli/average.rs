//! The command `jabuka average`: computes the mean of several images in linear light.

use std::path::PathBuf;

use crate::diagnostic::visible;
use crate::overwrite::ProtectedFiles;
use crate::render::linear_light;

use super::{Failure, terminal};

/// Average images in linear light, as a camera does while its shutter is open
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The images to average: PNG files of the same size
    #[arg(required = true)]
    images: Vec<PathBuf>,
    /// The PNG file to write
    #[arg(short, long, value_name = "FILE.png")]
    output: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let protected =
        ProtectedFiles::default().and_files(&arguments.images, "it is one of the images to average");
    terminal::report_protected(protected.check(&arguments.output))?;
    let mean = linear_light::mean(&arguments.images).and_then(|mean| mean.write(&arguments.output));
    mean.map_err(|error| {
        terminal::error(&format!("error: {}\n", visible(&error.to_string())));
        Failure::Errors
    })
}
