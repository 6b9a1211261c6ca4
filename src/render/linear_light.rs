//! The mean of images, as light adds up.
//!
//! While its shutter is open, a camera sees the mean of the light at its moments. The numbers of an image are not proportional to
//! light: sRGB gives dark tones more numbers than bright ones, so the mean of black and white is 188 of 255, and not 128. So this
//! module turns numbers into light, averages the light, and turns the mean into numbers again. If images have alpha, a color is
//! weighted by its alpha.

use std::fmt;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use png::{BitDepth, ColorType, Decoder, Encoder, Info, SrgbRenderingIntent};

/// An image of 8 bits a channel, in sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Its width, pixels.
    pub width: u32,
    /// Its height, pixels.
    pub height: u32,
    /// Whether it has alpha.
    pub alpha: bool,
    /// Its pixels, row by row from the upper left: red, green, blue, and, if the image has alpha, the opacity.
    pub bytes: Vec<u8>,
}

/// Why images have no mean, or it cannot be written.
#[derive(Debug)]
pub enum ImageError {
    /// There is no image.
    None,
    /// A file cannot be read or written.
    Io(PathBuf, io::Error),
    /// A file is no image, or one that POV-Ray would not have written.
    Format(PathBuf, String),
    /// An image is of another size than the first, or only one of them has alpha.
    Differs(PathBuf),
}

/// The mean of images in linear light: PNGs of 8 or 16 bits in sRGB, as POV-Ray writes them with `+FN8` and `+FN16`. They are
/// read one after another, row by row.
///
/// # Errors
/// If a file is no such image, or the sizes of the images differ.
pub fn mean(images: &[PathBuf]) -> Result<Image, ImageError> {
    let mut sum: Option<Sum> = None;
    for path in images {
        add(path, &mut sum)?;
    }
    sum.map(|sum| sum.mean(images.len())).ok_or(ImageError::None)
}

/// The sum of the light of images.
struct Sum {
    width: u32,
    height: u32,
    alpha: bool,
    /// For each pixel, the light of its channels and, if the image has alpha, its opacity; each image adds from 0 to 1. 24 bits
    /// are enough for the sum of some hundred images, since the mean has 8.
    light: Vec<f32>,
}

/// Adds the light of an image to the sum.
fn add(path: &Path, sum: &mut Option<Sum>) -> Result<(), ImageError> {
    let file = File::open(path).map_err(|error| ImageError::Io(path.to_owned(), error))?;
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
    // Read to the end of the file, to detect a truncated one.
    reader.finish().map_err(damaged)
}

/// A number of 8 bits as one of 16: 255 becomes 65535.
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
            light.as_chunks::<4>().0.iter().flat_map(|pixel| covering(*pixel, count)).collect()
        } else {
            light.iter().map(|light| number(light / count)).collect()
        };
        Image { width, height, alpha, bytes }
    }
}

/// A pixel that covers part of its background. If it covers nothing, it has no color.
fn covering([r, g, b, cover]: [f32; 4], count: f32) -> [u8; 4] {
    if cover <= 0.0 {
        return [0; 4];
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the conversion saturates")]
    let alpha = (cover / count * 255.0 + 0.5) as u8;
    [number(r / cover), number(g / cover), number(b / cover), alpha]
}

/// The number from 0 to 255 with the nearest light, found by looking the light up in the table.
fn number(light: f32) -> u8 {
    let (starts, borders) = &*NUMBERS;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is within the table")]
    let place = (light.clamp(0.0, 1.0) * STARTS as f32) as usize;
    let mut number = starts[place];
    while number < 255 && light >= borders[usize::from(number)] {
        number += 1;
    }
    number
}

/// The light of each number of 16 bits.
static LIGHT: LazyLock<Box<[f32; 65536]>> = LazyLock::new(|| {
    let mut table = Box::new([0.0; 65536]);
    for (number, light) in (0..=u16::MAX).zip(table.iter_mut()) {
        *light = linear(f64::from(number) / 65535.0);
    }
    table
});

/// The size of the table that a search for a number starts from. The number is then at most a few steps away.
const STARTS: usize = 4096;

/// For each entry, the smallest number that its light may have; and for each number, the light above which the next number is
/// nearer.
static NUMBERS: LazyLock<(Vec<u8>, [f32; 255])> = LazyLock::new(|| {
    let mut borders = [0.0; 255];
    for (number, border) in (0..u8::MAX).zip(&mut borders) {
        *border = linear((f64::from(number) + 0.5) / 255.0);
    }
    let mut number = 0;
    let start = |place: usize| {
        let light = place as f32 / STARTS as f32;
        while number < 255 && light >= borders[usize::from(number)] {
            number += 1;
        }
        number
    };
    ((0..=STARTS).map(start).collect(), borders)
});

/// The light of a number of sRGB, both from 0 to 1.
#[allow(clippy::cast_possible_truncation, reason = "24 bits are enough")]
fn linear(number: f64) -> f32 {
    if number <= 0.04045 { (number / 12.92) as f32 } else { libm::pow((number + 0.055) / 1.055, 2.4) as f32 }
}

/// Whether an image has alpha, and whether it has 16 bits. An error if its encoding differs from that of POV-Ray's images.
fn format(info: &Info<'_>) -> Result<(bool, bool), String> {
    /// 1/2.2, as a PNG stores gamma: the single power nearest to sRGB.
    const GAMMA: u32 = 45455;
    if info.interlaced {
        return Err("it is interlaced".to_owned());
    }
    // POV-Ray writes both, unless it is told to write another gamma.
    let gamma = info.gama_chunk.map(png::ScaledFloat::into_scaled);
    if info.srgb.is_none() && gamma.is_some_and(|gamma| gamma.abs_diff(GAMMA) > 500) {
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
    /// Writes a PNG, whole or not at all. It is marked as sRGB, like POV-Ray's.
    ///
    /// # Errors
    /// If it cannot be written; then an existing file of that name is unchanged.
    pub fn write(&self, path: &Path) -> Result<(), ImageError> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let temporary = path.with_file_name(format!(".jabuka-{name}.tmp"));
        // A killed run may have left this file.
        let _ = fs::remove_file(&temporary);
        let write = || {
            // `create_new` follows no link.
            let file = OpenOptions::new().write(true).create_new(true).open(&temporary)?;
            let mut file = BufWriter::new(file);
            self.encode(&mut file)?;
            file.into_inner().map_err(io::IntoInnerError::into_error)?;
            fs::rename(&temporary, path)
        };
        write().map_err(|error| {
            let _ = fs::remove_file(&temporary);
            ImageError::Io(path.to_owned(), error)
        })
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
