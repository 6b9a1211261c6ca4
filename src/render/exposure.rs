//! Collects the images of the moments of a frame with motion blur, and computes their mean.

use std::path::PathBuf;

use super::images::{Finished, WorkFolder};
use super::linear_light;
use super::{Images, RenderError};

/// The images of the moments of one frame, in a folder of their own.
pub(super) struct Exposure {
    folder: WorkFolder,
    images: Vec<String>,
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
        image: &Finished,
        moment: u32,
        seconds: f64,
        of: u32,
    ) -> Result<bool, RenderError> {
        let name = format!("{moment:04}.png");
        image.folder.rename(&image.name, &self.folder.dir, &name)?;
        self.images.push(name);
        self.seconds += seconds;
        Ok(self.images.len() == of as usize)
    }

    /// Writes the mean of all images in linear light into the folder.
    pub(super) fn develop(&self) -> Result<Finished, RenderError> {
        let folder = &self.folder.dir;
        // This path leads to the open folder.
        let place = folder.path_for_child();
        let name = "mean.png".to_owned();
        let mut images: Vec<PathBuf> = self.images.iter().map(|name| place.join(name)).collect();
        // The images arrive in any order. They are sorted, since the sum of floating-point numbers depends on their order.
        images.sort();
        let other = |error: linear_light::ImageError| {
            RenderError::io(folder.path().join(&name))(std::io::Error::other(error.to_string()))
        };
        linear_light::mean(&images).and_then(|mean| mean.write(&place.join(&name))).map_err(other)?;
        Ok(Finished { folder: folder.clone(), name })
    }
}
