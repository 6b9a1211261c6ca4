//! Draws a picture of lines and texts into a PNG.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use super::{BACKGROUND_COLOR, Item, Picture};
use crate::svg::{Anchor, Rgb};

/// Returns the picture as the bytes of a PNG file.
///
/// # Errors
/// If the picture cannot be encoded.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a picture is some thousand pixels high"
)]
pub fn png(picture: &Picture) -> Result<Vec<u8>, png::EncodingError> {
    let (width, height) = (picture.width.ceil() as usize, picture.height.ceil() as usize);
    let mut canvas = Canvas { width, height, rgb: BACKGROUND_COLOR.repeat(width * height) };
    for item in &picture.items {
        match item {
            Item::Line { points, width, color } => canvas.line(points, *width, *color),
            Item::Text { at, text, anchor, large, color } => {
                canvas.text(*at, text, *anchor, *large, *color);
            }
        }
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&canvas.rgb)?;
    writer.finish()?;
    Ok(bytes)
}

struct Canvas {
    width: usize,
    height: usize,
    rgb: Vec<u8>,
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    clippy::cast_possible_wrap,
    reason = "places are within some thousand pixels"
)]
impl Canvas {
    /// Draws a polyline. The opacity of a pixel follows from the distance of its center from the nearest segment.
    fn line(&mut self, points: &[[f64; 2]], width: f64, color: Rgb) {
        let reach = width / 2.0 + 1.0;
        let bound = |axis: usize, end: usize| {
            let places = points.iter().map(|point| point[axis]);
            let (min, max) = places.fold((f64::MAX, 0.0_f64), |(min, max), at| (min.min(at), max.max(at)));
            let begin = ((min - reach).max(0.0) as usize).min(end);
            begin..((max + reach).ceil() as usize + 1).clamp(begin, end)
        };
        let (columns, rows) = (bound(0, self.width), bound(1, self.height));
        let mut covered = vec![0.0_f32; columns.len() * rows.len()];
        for pair in points.windows(2) {
            let [[ax, ay], [bx, by]] = [pair[0], pair[1]];
            let across = (ax.min(bx) - reach).max(0.0) as usize..=(ax.max(bx) + reach).max(0.0) as usize;
            let down = (ay.min(by) - reach).max(0.0) as usize..=(ay.max(by) + reach).max(0.0) as usize;
            let (dx, dy) = (bx - ax, by - ay);
            let length = (dx * dx + dy * dy).max(1e-12);
            for y in down.filter(|y| rows.contains(y)) {
                for x in across.clone().filter(|x| columns.contains(x)) {
                    let (px, py) = (x as f64 + 0.5 - ax, y as f64 + 0.5 - ay);
                    let along = ((px * dx + py * dy) / length).clamp(0.0, 1.0);
                    let (ox, oy) = (px - along * dx, py - along * dy);
                    let part = (width / 2.0 + 0.5 - (ox * ox + oy * oy).sqrt()).clamp(0.0, 1.0) as f32;
                    let here = &mut covered[(y - rows.start) * columns.len() + x - columns.start];
                    *here = here.max(part);
                }
            }
        }
        if columns.is_empty() {
            return;
        }
        for (y, parts) in rows.zip(covered.chunks(columns.len())) {
            let row = &mut self.rgb[3 * (y * self.width + columns.start)..];
            for (pixel, part) in row.as_chunks_mut::<3>().0.iter_mut().zip(parts) {
                if *part > 0.0 {
                    mix(pixel, color, (part * 255.0).round() as u8);
                }
            }
        }
    }

    /// Draws a text in one line. A question mark replaces each character that the font lacks.
    fn text(&mut self, [x, y]: [f64; 2], text: &str, anchor: Anchor, large: bool, color: Rgb) {
        let letters = if large { RasterHeight::Size20 } else { RasterHeight::Size16 };
        let advance = get_raster_width(FontWeight::Regular, letters) as f64;
        let width = advance * text.chars().count() as f64;
        let begin = match anchor {
            Anchor::Start => x,
            Anchor::Middle => x - width / 2.0,
            Anchor::End => x - width,
        };
        let top = (y - letters.val() as f64 / 2.0).round() as i64;
        for (place, c) in text.chars().enumerate() {
            let glyph = get_raster(c, FontWeight::Regular, letters)
                .or_else(|| get_raster('?', FontWeight::Regular, letters));
            let Some(glyph) = glyph else { continue };
            let left = (begin + place as f64 * advance).round() as i64;
            for (row, parts) in glyph.rows().enumerate() {
                for (column, part) in parts.iter().enumerate() {
                    let (x, y) = (left + column as i64, top + row as i64);
                    let is_within =
                        (0..self.width as i64).contains(&x) && (0..self.height as i64).contains(&y);
                    if is_within && *part > 0 {
                        let start = 3 * (y as usize * self.width + x as usize);
                        if let Some(pixel) = self.rgb[start..].first_chunk_mut::<3>() {
                            mix(pixel, color, *part);
                        }
                    }
                }
            }
        }
    }
}

/// Blends a color into a pixel. `part` is the opacity of the color, 0 to 255.
fn mix(pixel: &mut [u8; 3], color: Rgb, part: u8) {
    for (byte, ink) in pixel.iter_mut().zip(color) {
        let (ground, ink, part) = (u32::from(*byte), u32::from(ink), u32::from(part));
        let mixed = (ground * (255 - part) + ink * part + 127) / 255;
        *byte = u8::try_from(mixed).unwrap_or(u8::MAX);
    }
}
