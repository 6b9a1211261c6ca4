//! The arguments for the size and quality of images.

use clap::ValueEnum;
use jabuka::render::{self, Quality};
use jabuka::scene::Override;

/// How large and how good images are.
#[derive(clap::Args)]
pub(super) struct PictureArguments {
    /// The size of the images in pixels, as in 1280x720 [default: that of the scene]
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = parse_size)]
    size: Option<[u32; 2]>,
    /// How good the images are
    #[arg(long, value_enum, default_value_t)]
    quality: QualityName,
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum QualityName {
    /// For a look at the motion: no anti-aliasing
    Draft,
    /// As `povray animation.ini` renders it
    #[default]
    Good,
    /// For the film that is kept: finer anti-aliasing
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
    /// The change to the scene that gives its camera the shape of these images, if a size is requested.
    pub(super) fn overrides(&self) -> Vec<Override> {
        let size = |[width, height]: [u32; 2]| Override::new(format!("output.size=[{width}, {height}]"));
        self.size.map(size).into_iter().collect()
    }

    /// The requested size of the images, or else `size`, for which the scripts are made.
    pub(super) fn size_or(&self, size: [u32; 2]) -> [u32; 2] {
        self.size.unwrap_or(size)
    }

    /// POV-Ray's options for the images. `size` is the one for which the scripts are made.
    pub(super) fn options(&self, size: [u32; 2], transparent: bool) -> Vec<String> {
        render::options(self.size_or(size), transparent, self.quality.into())
    }
}
