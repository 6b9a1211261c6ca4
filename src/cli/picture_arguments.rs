//! The command-line arguments for the size and quality of images.

use crate::render::{self, Quality};
use crate::scene::Override;
use clap::ValueEnum;

/// The size and quality of the images to render.
#[derive(clap::Args)]
pub(super) struct PictureArguments {
    /// The size of the images in pixels, as in 1280x720 [default: that of the scene]
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = parse_size)]
    size: Option<[u32; 2]>,
    /// The quality of the images
    #[arg(long, value_enum, default_value_t)]
    quality: QualityName,
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum QualityName {
    /// Fast, to judge the motion: no anti-aliasing
    Draft,
    /// The same quality as `povray animation.ini`
    #[default]
    Good,
    /// For the final film: finer anti-aliasing
    Final,
}

impl From<QualityName> for Quality {
    fn from(name: QualityName) -> Quality {
        match name {
            QualityName::Draft => Quality::Draft,
            QualityName::Good => Quality::Good,
            QualityName::Final => Quality::Final,
        }
    }
}

fn parse_size(argument: &str) -> Result<[u32; 2], String> {
    let number = |text: &str| text.parse::<u32>().ok().filter(|n| (1..=65535).contains(n));
    let size = argument.split_once(['x', 'X', '×']).and_then(|(w, h)| Some([number(w)?, number(h)?]));
    size.ok_or_else(|| "write it as WIDTHxHEIGHT, as in 1280x720".to_owned())
}

impl PictureArguments {
    /// Returns the override of `output.size` that gives the scene's camera the requested aspect ratio. Empty if the user requests no size.
    pub(super) fn overrides(&self) -> Vec<Override> {
        let size = |[width, height]: [u32; 2]| Override::new(format!("output.size=[{width}, {height}]"));
        self.size.map(size).into_iter().collect()
    }

    /// Returns the requested image size, width and height in pixels, or by default `size`, for which the scripts were written.
    pub(super) fn size_or(&self, size: [u32; 2]) -> [u32; 2] {
        self.size.unwrap_or(size)
    }

    /// Returns the POV-Ray options for the size, transparency and quality of the images. `size` is the image size for which the scripts
    /// were written.
    pub(super) fn options(&self, size: [u32; 2], transparent: bool) -> Vec<String> {
        render::options(self.size_or(size), transparent, self.quality.into())
    }
}
