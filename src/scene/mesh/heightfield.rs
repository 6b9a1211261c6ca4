//! Converts a grayscale image into a surface whose heights are the gray levels.

use std::io::BufReader;
use std::path::Path;

use glam::DVec3;
use png::{BitDepth, ColorType, Transformations};

use super::{MOST_BYTES, MeshError};
use crate::physics::Mesh;
use crate::scene::source::file;

/// The maximum number of pixels in an image. Each pixel gives about two triangles, so a heightfield has at most about 8 million triangles.
const MOST_PIXELS: u64 = 1 << 22;

/// Reads a PNG image, with 8 or 16 bits per channel, as a surface of the given size, m. Black is height 0 and white is height `size.y`.
/// Each pixel gives a vertex, and each square of four neighboring pixels gives two triangles, so the surface keeps the full resolution of
/// the image. The height at a colored pixel is given by the luma of its color (Rec. 709). Transparency is ignored.
///
/// POV-Ray's own height fields take less memory, but interpret colors, gamma and the edge of the image differently. With triangles, the
/// rendered image shows the same surface from which jabuka computes the camera and the ground.
pub(in crate::scene) fn heightfield(path: &Path, size: DVec3) -> Result<Mesh, MeshError> {
    let image = read(path)?;
    let [width, depth] = [image.width, image.levels.len() / image.width];
    if width < 2 || depth < 2 {
        return Err(MeshError::new(format!("{width} × {depth} pixels make no surface: 2 × 2 are the least")));
    }
    #[allow(clippy::cast_precision_loss, reason = "the number of pixels is limited")]
    let part = |i: usize, count: usize| i as f64 / (count - 1) as f64 - 0.5;
    let vertex =
        |(i, &level): (usize, &f64)| size * DVec3::new(part(i % width, width), level, part(i / width, depth));
    let vertices = image.levels.iter().enumerate().map(vertex).collect();
    let mut triangles = Vec::with_capacity(2 * (width - 1) * (depth - 1));
    #[allow(clippy::cast_possible_truncation, reason = "the number of pixels is limited")]
    for row in 0..depth - 1 {
        for column in 0..width - 1 {
            let far = (row * width + column) as u32;
            let near = far + width as u32;
            // The vertices of each triangle are counterclockwise as seen from above.
            triangles.extend([[far, near, far + 1], [far + 1, near, near + 1]]);
        }
    }
    let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    Ok(Mesh::surface(&name, vertices, triangles))
}

/// The gray levels of an image, from 0 (black) to 1 (white), row by row.
struct Image {
    width: usize,
    levels: Vec<f64>,
}

fn read(path: &Path) -> Result<Image, MeshError> {
    let not_png = |error: png::DecodingError| MeshError::new(format!("it is no PNG: {error}"));
    let mut decoder = png::Decoder::new(BufReader::new(file::open(path, MOST_BYTES)?));
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(not_png)?;
    let pixels = u64::from(reader.info().width) * u64::from(reader.info().height);
    if pixels > MOST_PIXELS {
        let most = MOST_PIXELS;
        return Err(MeshError::new(format!("it has {pixels} pixels, more than {most}: make it smaller")));
    }
    let length = reader.output_buffer_size().ok_or_else(|| MeshError::new("it is too large"))?;
    let mut bytes = vec![0; length];
    let info = reader.next_frame(&mut bytes).map_err(not_png)?;
    let wide = info.bit_depth == BitDepth::Sixteen;
    let bytes_of_a_pixel = info.color_type.samples() * if wide { 2 } else { 1 };
    let sample = |pixel: &[u8], channel: usize| match wide {
        true => f64::from(u16::from_be_bytes([pixel[2 * channel], pixel[2 * channel + 1]])) / 65535.0,
        false => f64::from(pixel[channel]) / 255.0,
    };
    let level = |pixel: &[u8]| match info.color_type {
        ColorType::Grayscale | ColorType::GrayscaleAlpha => sample(pixel, 0),
        _ => 0.2126 * sample(pixel, 0) + 0.7152 * sample(pixel, 1) + 0.0722 * sample(pixel, 2),
    };
    let levels = bytes[..info.buffer_size()].chunks_exact(bytes_of_a_pixel).map(level).collect();
    Ok(Image { width: info.width as usize, levels })
}
