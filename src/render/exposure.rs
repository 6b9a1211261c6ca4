//! Collects the images of the moments of a frame with motion blur, and computes their mean.

use std::fs;
use std::path::{Path, PathBuf};

use super::linear_light;
use super::{Images, RenderError};

/// The images of the moments of one frame, in a folder of their own. Dropping the value removes the folder.
pub(super) struct Exposure {
    folder: PathBuf,
    images: Vec<PathBuf>,
    /// The total rendering time of the images, s.
    pub(super) seconds: f64,
}

impl Exposure {
    /// Makes an empty folder for the images of a frame's moments.
    pub(super) fn new(images: &Images, index: usize) -> Result<Exposure, RenderError> {
        Ok(Exposure { folder: images.exposure_folder(index)?, images: Vec::new(), seconds: 0.0 })
    }

    /// Adds the image of a moment. `of` is the number of moments of the frame. Returns true once all their images have been added.
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

    /// Writes the mean of all images in linear light into the folder, and returns its path.
    pub(super) fn develop(&self) -> Result<PathBuf, RenderError> {
        let path = self.folder.join("mean.png");
        let mut images = self.images.clone();
        // The images arrive in any order. They are sorted, since the sum of floating-point numbers depends on their order.
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
        // If the folder cannot be removed, the next process removes it.
        let _ = fs::remove_dir_all(&self.folder);
    }
}
