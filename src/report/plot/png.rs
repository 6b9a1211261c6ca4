//! Draws a picture of lines and texts into a PNG.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use super::{BACKGROUND_COLOR, Item, Picture};
use crate::drawing::Canvas;
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
    let mut canvas = Canvas::new(width, height, BACKGROUND_COLOR);
    for item in &picture.items {
        match item {
            Item::Line { points, width, color } => canvas.line(points, *width, *color),
            Item::Text { at, text, anchor, large, color } => {
                draw(&mut canvas, *at, text, *anchor, *large, *color);
            }
        }
    }
    canvas.png()
}

/// Draws a text in one line. A question mark replaces each character that the font lacks.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    clippy::cast_possible_wrap,
    reason = "places are within some thousand pixels"
)]
fn draw(canvas: &mut Canvas, [x, y]: [f64; 2], text: &str, anchor: Anchor, large: bool, color: Rgb) {
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
                    (0..canvas.width as i64).contains(&x) && (0..canvas.height as i64).contains(&y);
                if is_within && *part > 0 {
                    canvas.blend(x as usize, y as usize, color, *part);
                }
            }
        }
    }
}
