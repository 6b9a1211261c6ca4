//! Computes the mean of images in linear light.
//!
//! While its shutter is open, a camera sees the mean of the light at different moments. The bytes of an image are not proportional to
//! light: sRGB encodes dark tones more finely than bright ones, so the mean of black and white is 188 of 255, and not 128. Therefore, this
//! module converts bytes to light, averages the light, and converts the mean back to bytes. If images have an alpha channel, each color is
//! weighted by its alpha.

use std::fmt;
use std::io::{self, BufReader, Write};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use png::{BitDepth, ColorType, Decoder, Encoder, Info, SrgbRenderingIntent};

use crate::system::{self, Dir, FolderError};

/// An sRGB image with 8 bits per channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// The width of the image, pixels.
    pub width: u32,
    /// The height of the image, pixels.
    pub height: u32,
    /// True if the image has an alpha channel.
    pub alpha: bool,
    /// The pixels, row by row from the upper left: red, green, blue, and alpha if the image has it.
    pub bytes: Vec<u8>,
}

/// An error of computing or writing the mean of several images.
#[derive(Debug)]
pub enum ImageError {
    /// The list of images is empty.
    None,
    /// A file cannot be read or written.
    Io(PathBuf, io::Error),
    /// A file is not an image, or has a format that POV-Ray does not write. The text gives the reason.
    Format(PathBuf, String),
    /// An image differs from the first one in its size, or in having an alpha channel.
    Differs(PathBuf),
}

/// Computes the mean of images in linear light. The images are sRGB PNGs of 8 or 16 bits per channel, as POV-Ray writes them with `+FN8`
/// and `+FN16`. They are read one after another, row by row.
///
/// # Errors
/// If a file is not such an image, the sizes of the images differ, or there are no images.
pub fn mean(images: &[PathBuf]) -> Result<Image, ImageError> {
    let mut sum: Option<Sum> = None;
    for path in images {
        add(path, &mut sum)?;
    }
    sum.map(|sum| sum.mean(images.len())).ok_or(ImageError::None)
}

/// The sum of the light of several images, pixel by pixel.
struct Sum {
    width: u32,
    height: u32,
    alpha: bool,
    /// For each pixel, the sums of its channels in linear light, and of its alpha if the images have it. Each image adds 0 to 1. The 24
    /// bits of a `f32` are enough for some hundred images, since the mean has 8 bits.
    light: Vec<f32>,
}

/// Adds the light of an image to the sum. The first image starts the sum.
fn add(path: &Path, sum: &mut Option<Sum>) -> Result<(), ImageError> {
    let file = system::open(path).map_err(|error| ImageError::Io(path.to_owned(), error))?;
    let damaged = |error: png::DecodingError| match error {
        png::DecodingError::IoError(error) => ImageError::Io(path.to_owned(), error),
        error => ImageError::Format(path.to_owned(), error.to_string()),
    };
    let mut reader = Decoder::new(BufReader::new(file)).read_info().map_err(damaged)?;
    let (alpha, wide) = format(reader.info()).map_err(|what| ImageError::Format(path.to_owned(), what))?;
    let (width, height) = reader.info().size();
    let channels = if alpha { 4 } else { 3 };
    let row_length = width as usize * channels;
    let sum = sum.get_or_insert_with(|| Sum {
        width,
        height,
        alpha,
        light: vec![0.0; row_length * height as usize],
    });
    if (sum.width, sum.height, sum.alpha) != (width, height, alpha) {
        return Err(ImageError::Differs(path.to_owned()));
    }
    for light in sum.light.chunks_exact_mut(row_length) {
        let row = reader.next_row().map_err(damaged)?;
        let Some(row) = row else {
            return Err(ImageError::Format(path.to_owned(), "it ends too early".to_owned()));
        };
        match (wide, alpha) {
            (true, false) => add_opaque(light, row.data().as_chunks().0, |bytes| u16::from_be_bytes(*bytes)),
            (true, true) => add_covering(light, row.data().as_chunks().0, |bytes| u16::from_be_bytes(*bytes)),
            (false, false) => add_opaque(light, row.data().as_chunks().0, widened),
            (false, true) => add_covering(light, row.data().as_chunks().0, widened),
        }
    }
    // Reading to the end of the file detects a truncated file.
    reader.finish().map_err(damaged)
}

/// Scales an 8-bit value to 16 bits: 255 becomes 65535.
fn widened([byte]: &[u8; 1]) -> u16 {
    u16::from(*byte) * 257
}

fn add_opaque<const N: usize>(light: &mut [f32], row: &[[u8; N]], number: impl Fn(&[u8; N]) -> u16) {
    let table: &[f32; 65536] = &LIGHT;
    for (light, bytes) in light.iter_mut().zip(row) {
        *light += table[usize::from(number(bytes))];
    }
}

fn add_covering<const N: usize>(light: &mut [f32], row: &[[u8; N]], number: impl Fn(&[u8; N]) -> u16) {
    let table: &[f32; 65536] = &LIGHT;
    for (light, bytes) in light.as_chunks_mut::<4>().0.iter_mut().zip(row.as_chunks::<4>().0) {
        let cover = f32::from(number(&bytes[3])) / 65535.0;
        for (light, bytes) in light.iter_mut().zip(&bytes[..3]) {
            *light += cover * table[usize::from(number(bytes))];
        }
        light[3] += cover;
    }
}

impl Sum {
    #[allow(clippy::cast_precision_loss, reason = "images are counted, not measured")]
    fn mean(self, images: usize) -> Image {
        let Sum { width, height, alpha, light } = self;
        let count = images as f32;
        let bytes = if alpha {
            light.as_chunks::<4>().0.iter().flat_map(|pixel| mean_of_pixel(*pixel, count)).collect()
        } else {
            light.iter().map(|light| number(light / count)).collect()
        };
        Image { width, height, alpha, bytes }
    }
}

/// Returns the mean of a pixel with alpha, as bytes. `count` is the number of images. A fully transparent pixel has no color.
fn mean_of_pixel([r, g, b, cover]: [f32; 4], count: f32) -> [u8; 4] {
    if cover <= 0.0 {
        return [0; 4];
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the conversion saturates")]
    let alpha = (cover / count * 255.0 + 0.5) as u8;
    [number(r / cover), number(g / cover), number(b / cover), alpha]
}

/// Returns the sRGB byte that is nearest to a linear light of 0 to 1, by a table lookup.
fn number(light: f32) -> u8 {
    let (starts, borders) = &*NUMBERS;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is within the table")]
    let place = (light.clamp(0.0, 1.0) * SEARCH_INTERVALS as f32) as usize;
    let mut number = starts[place];
    while number < 255 && light >= borders[usize::from(number)] {
        number += 1;
    }
    number
}

/// The linear light (0 to 1) of each 16-bit sRGB value.
static LIGHT: LazyLock<Box<[f32; 65536]>> = LazyLock::new(|| {
    let mut table = Box::new([0.0; 65536]);
    for (number, light) in (0..=u16::MAX).zip(table.iter_mut()) {
        *light = linear(f64::from(number) / 65535.0);
    }
    table
});

/// The number of equal intervals of linear light from 0 to 1 in the table in which the search for an sRGB byte starts. The byte is then at
/// most a few steps away.
const SEARCH_INTERVALS: usize = 4096;

/// For each table entry, the smallest sRGB byte that light in its range can have. For each byte, the light above which the next byte is
/// nearer.
static NUMBERS: LazyLock<(Vec<u8>, [f32; 255])> = LazyLock::new(|| {
    let mut borders = [0.0; 255];
    for (number, border) in (0..u8::MAX).zip(&mut borders) {
        *border = linear((f64::from(number) + 0.5) / 255.0);
    }
    let mut number = 0;
    let start = |place: usize| {
        let light = place as f32 / SEARCH_INTERVALS as f32;
        while number < 255 && light >= borders[usize::from(number)] {
            number += 1;
        }
        number
    };
    ((0..=SEARCH_INTERVALS).map(start).collect(), borders)
});

/// Converts an sRGB value to linear light, both from 0 to 1.
#[allow(clippy::cast_possible_truncation, reason = "24 bits are enough")]
fn linear(number: f64) -> f32 {
    if number <= 0.04045 { (number / 12.92) as f32 } else { libm::pow((number + 0.055) / 1.055, 2.4) as f32 }
}

/// Returns whether a PNG has an alpha channel, and whether it has 16 bits per channel. Fails for encodings that POV-Ray does not write.
fn format(info: &Info<'_>) -> Result<(bool, bool), String> {
    /// The gamma of 1/2.2 as a PNG stores it, times 100 000. It is the power law that is nearest to sRGB.
    const SRGB_GAMMA: u32 = 45455;
    if info.interlaced {
        return Err("it is interlaced".to_owned());
    }
    // POV-Ray writes an sRGB chunk and a gamma chunk, unless its options set another gamma.
    let gamma = info.gama_chunk.map(png::ScaledFloat::into_scaled);
    if info.srgb.is_none() && gamma.is_some_and(|gamma| gamma.abs_diff(SRGB_GAMMA) > 500) {
        return Err("its colors are not sRGB".to_owned());
    }
    match (info.color_type, info.bit_depth) {
        (ColorType::Rgb, BitDepth::Eight) => Ok((false, false)),
        (ColorType::Rgb, BitDepth::Sixteen) => Ok((false, true)),
        (ColorType::Rgba, BitDepth::Eight) => Ok((true, false)),
        (ColorType::Rgba, BitDepth::Sixteen) => Ok((true, true)),
        (color, depth) => Err(format!("its pixels are {color:?} of {} bits", depth as u8)),
    }
}

impl Image {
    /// Writes the image as an sRGB PNG under a temporary name, and renames it when it is complete.
    ///
    /// # Errors
    /// If the file cannot be written. An existing file of that name then stays unchanged.
    pub fn write(&self, path: &Path) -> Result<(), ImageError> {
        let write = || {
            let (folder, name) = Dir::of_file(path, false)?;
            folder.write_whole(&name, |file| {
                self.encode(file).map_err(|error| FolderError::Io(path.to_owned(), error))
            })
        };
        write().map_err(|error: FolderError| ImageError::Io(path.to_owned(), error.into()))
    }

    fn encode(&self, out: &mut impl Write) -> io::Result<()> {
        let mut encoder = Encoder::new(out, self.width, self.height);
        encoder.set_color(if self.alpha { ColorType::Rgba } else { ColorType::Rgb });
        encoder.set_depth(BitDepth::Eight);
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.bytes)?;
        Ok(writer.finish()?)
    }
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ImageError::None => write!(f, "there are no images to take the mean of"),
            ImageError::Io(path, error) => write!(f, "`{}`: {error}", path.display()),
            ImageError::Format(path, what) => {
                write!(f, "`{}` is no image as POV-Ray writes it: {what}", path.display())
            }
            ImageError::Differs(path) => {
                write!(f, "`{}` is of another size or kind than the images before it", path.display())
            }
        }
    }
}

impl std::error::Error for ImageError {}

#[cfg(test)]
mod tests;
