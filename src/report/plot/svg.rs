//! Writes a picture of lines and texts as SVG.

use super::{BACKGROUND_COLOR, Item, Picture};
use crate::svg::Svg;

/// The fonts of the texts. Their letters have one width, as those of the PNG.
const FONTS: &str = "DejaVu Sans Mono, Menlo, Consolas, monospace";

/// Returns the picture as the text of an SVG file.
pub fn svg(picture: &Picture) -> String {
    let mut svg = Svg::new([picture.width, picture.height], BACKGROUND_COLOR, FONTS);
    for item in &picture.items {
        match item {
            Item::Line { points, width, color } => svg.line(points.iter().copied(), *width, *color),
            Item::Text { at, text, anchor, large, color } => {
                svg.text(*at, text, *anchor, if *large { 18.0 } else { 14.0 }, *color);
            }
        }
    }
    svg.finish()
}
