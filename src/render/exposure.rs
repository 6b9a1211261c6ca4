//! A frame with motion blur: collects the images of its moments, until all are there.

use std::fs;
use std::path::{Path, PathBuf};

use super::linear_light;
use super::{Images, RenderError};

/// The images of the moments of a frame. Dropping this removes their folder.
pub(super) struct Exposure {
    folder: PathBuf,
    images: Vec<PathBuf>,
    /// The total cost of the images, s.
    pub(super) seconds: f64,
}

impl Exposure {
    /// A frame without any moment yet.
    pub(super) fn new(images: &Images, index: usize) -> Result<Exposure, RenderError> {
        Ok(Exposure { folder: images.exposure_folder(index)?, images: Vec::new(), seconds: 0.0 })
    }

    /// Adds the image of one of this many moments, and returns whether all are there.
    pub(super) fn add(
        &mut self,
        image: &Path,
        moment: u32,
        seconds: f64,
        of: u32,
    ) -> Result<bool, RenderError> {
        let path = self.folder.join(format!("{moment:04}.png"));
        fs::rename(image, &path).map_err(RenderError::io(&path))?;
        self.images.push(path);
        self.seconds += seconds;
        Ok(self.images.len() == of as usize)
    }

    /// The mean of all moments in linear light, as a file in this exposure's folder.
    pub(super) fn develop(&self) -> Result<PathBuf, RenderError> {
        let path = self.folder.join("mean.png");
        let mut images = self.images.clone();
        // The sum of floating-point numbers depends on their order.
        images.sort();
        let other = |error: linear_light::ImageError| {
            RenderError::io(&path)(std::io::Error::other(error.to_string()))
        };
        linear_light::mean(&images).and_then(|mean| mean.write(&path)).map_err(other)?;
        Ok(path)
    }
}

impl Drop for Exposure {
    fn drop(&mut self) {
        // The next run removes a folder that stays.
        let _ = fs::remove_dir_all(&self.folder);
    }
}
