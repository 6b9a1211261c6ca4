//! Reads images into memory, and converts between sRGB bytes and linear light.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use png::{Decoder, Reader, Transformations};

use super::FilmError;
use crate::system;

/// An image in memory with four bytes per pixel: red, green, blue in sRGB, and alpha. The colors are not premultiplied by alpha.
pub(super) struct Picture {
    pub(super) size: Size,
    pub(super) rgba: Vec<u8>,
}

/// A width and a height in pixels.
pub(super) type Size = (usize, usize);

impl Picture {
    /// Reads a PNG of any color type.
    ///
    /// # Errors
    /// If the file does not exist, or is not a complete PNG.
    pub(super) fn read(path: &Path) -> Result<Picture, FilmError> {
        let mut reader = open(path)?;
        let too_large = || FilmError::Image(path.to_owned(), "it is too large".to_owned());
        let mut bytes = vec![0; reader.output_buffer_size().ok_or_else(too_large)?];
        let info = reader.next_frame(&mut bytes).map_err(|error| bad(path, &error))?;
        bytes.truncate(info.buffer_size());
        let rgba = match info.color_type {
            png::ColorType::GrayscaleAlpha => {
                bytes.chunks_exact(2).flat_map(|p| [p[0], p[0], p[0], p[1]]).collect()
            }
            _ => bytes,
        };
        Ok(Picture { size: (info.width as usize, info.height as usize), rgba })
    }

    /// Returns the image on a white background, three bytes per pixel. Colors are blended in linear light.
    pub(super) fn over_white(&self) -> Vec<u8> {
        let pixel = |pixel: &[u8]| match pixel[3] {
            255 => [pixel[0], pixel[1], pixel[2]],
            0 => [255; 3],
            opacity => {
                let part = f32::from(opacity) / 255.0;
                [0, 1, 2].map(|i| srgb(light(pixel[i]) * part + (1.0 - part)))
            }
        };
        self.rgba.chunks_exact(4).flat_map(pixel).collect()
    }
}

/// Returns the width and height of a PNG. Reads only its header.
///
/// # Errors
/// If the file does not exist, or is not a PNG.
pub(super) fn size(path: &Path) -> Result<Size, FilmError> {
    let reader = open(path)?;
    Ok((reader.info().width as usize, reader.info().height as usize))
}

/// Returns the size that all images have in common.
///
/// # Errors
/// If there are no images, one of them cannot be read, or they differ in size.
pub(super) fn common_size<'a>(mut paths: impl Iterator<Item = &'a PathBuf>) -> Result<Size, FilmError> {
    let first = paths.next().ok_or(FilmError::NoImages)?;
    let common = size(first)?;
    for path in paths {
        let size = size(path)?;
        if size != common {
            return Err(FilmError::Sizes { first: (first.clone(), common), other: (path.clone(), size) });
        }
    }
    Ok(common)
}

fn open(path: &Path) -> Result<Reader<BufReader<File>>, FilmError> {
    let file = system::open(path).map_err(|error| FilmError::Image(path.to_owned(), error.to_string()))?;
    let mut decoder = Decoder::new(BufReader::new(file));
    decoder.set_transformations(Transformations::EXPAND | Transformations::STRIP_16 | Transformations::ALPHA);
    decoder.read_info().map_err(|error| bad(path, &error))
}

fn bad(path: &Path, error: &png::DecodingError) -> FilmError {
    let why = match error {
        png::DecodingError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            "it ends too early".to_owned()
        }
        other => other.to_string(),
    };
    FilmError::Image(path.to_owned(), why)
}

/// Converts an sRGB byte to linear light from 0 to 1.
pub(super) fn light(byte: u8) -> f32 {
    static LIGHT: LazyLock<[f32; 256]> = LazyLock::new(|| {
        std::array::from_fn(|byte| {
            let value = byte as f64 / 255.0;
            // The formula is from IEC 61966-2-1.
            let light =
                if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) };
            light as f32
        })
    });
    LIGHT[usize::from(byte)]
}

/// Converts linear light to the nearest sRGB byte. Light below 0 or above 1 is clamped.
pub(super) fn srgb(light: f32) -> u8 {
    let light = f64::from(light).clamp(0.0, 1.0);
    let value =
        if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055 };
    (value * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_comes_back_from_its_light() {
        for byte in 0..=255 {
            assert_eq!(srgb(light(byte)), byte);
        }
    }

    #[test]
    fn half_of_black_before_white_is_half_of_the_light() {
        let picture = Picture { size: (3, 1), rgba: vec![0, 0, 0, 128, 9, 9, 9, 0, 10, 20, 30, 255] };
        assert_eq!(picture.over_white(), [187, 187, 187, 255, 255, 255, 10, 20, 30]);
    }
}
