//! Writes drawings as PNG.

use super::canvas::Canvas;
use super::{Drawing, Item, outlines};

impl Drawing {
    /// Returns the drawing as the bytes of a PNG file, `width` pixels wide.
    ///
    /// # Errors
    /// If the picture cannot be encoded.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a picture is some thousand pixels high"
    )]
    pub(crate) fn png(&self, width: u32) -> Result<Vec<u8>, png::EncodingError> {
        let scale = f64::from(width) / self.size[0];
        let height = libm::round(self.size[1] * scale).max(1.0) as usize;
        let mut canvas = Canvas::new(width as usize, height, self.background);
        let scaled = |at: [f64; 2]| at.map(|part| part * scale);
        for item in &self.items {
            match item {
                Item::Line { points, width, color } => {
                    let points: Vec<[f64; 2]> = points.iter().copied().map(scaled).collect();
                    match points[..] {
                        [[x, y], [right, bottom]] if x == right || y == bottom => {
                            canvas.rule([[x, y], [right, bottom]], width * scale, *color);
                        }
                        _ => canvas.line(&points, width * scale, *color),
                    }
                }
                Item::Rectangle { corners, color } => {
                    // Whole pixels make crisp edges.
                    let [one, other] = corners.map(|corner| scaled(corner).map(libm::round));
                    canvas.area(&[vec![one, [other[0], one[1]], other, [one[0], other[1]]]], *color);
                }
                Item::Text { at, says, anchor, size, color } => {
                    canvas.letters(&outlines(scaled(*at), says, *anchor, size * scale), *color);
                }
            }
        }
        canvas.png()
    }
}
