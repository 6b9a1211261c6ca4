//! Drawings of lines, rectangles and letters, as SVG, PNG and PDF.
//!
//! A drawing is a list of items with positions in pixels. All three kinds of files are written from the same list, by a few lines each: the
//! letters of PNG and PDF are the outlines of the font that pictures have, so they look alike on every machine.

mod canvas;
mod pdf;
mod png;

use crate::font::{Step, Typeface};
use crate::lettering;
use crate::svg::{Anchor, HALF_OF_LETTERS, Rgb, Svg};

#[cfg(feature = "render")]
pub(crate) use self::canvas::Canvas;

/// A part of a drawing. Positions are in pixels, from the upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Item {
    /// A line through points.
    Line { points: Vec<[f64; 2]>, width: f64, color: Rgb },
    /// A filled rectangle, given two opposite corners.
    Rectangle { corners: [[f64; 2]; 2], color: Rgb },
    /// A set text in one line. `at` is the position of its anchor, at half the height of the letters. `size` is the size of the font.
    Text { at: [f64; 2], says: String, anchor: Anchor, size: f64, color: Rgb },
}

/// A drawing on a background of one color.
#[derive(Clone, Debug)]
pub(crate) struct Drawing {
    /// The width and the height, pixels.
    pub(crate) size: [f64; 2],
    pub(crate) background: Rgb,
    pub(crate) items: Vec<Item>,
}

impl Drawing {
    /// Returns the drawing as the text of an SVG file. `fonts` are the fonts of its letters.
    pub(crate) fn svg(&self, fonts: &str) -> String {
        let mut svg = Svg::new(self.size, self.background, fonts);
        for item in &self.items {
            match item {
                Item::Line { points, width, color } => svg.line(points.iter().copied(), *width, *color),
                Item::Rectangle { corners, color } => svg.rectangle(*corners, *color),
                Item::Text { at, says, anchor, size, color } => svg.text(*at, says, *anchor, *size, *color),
            }
        }
        svg.finish()
    }
}

/// Returns the outlines of a text at its place, in pixels from the upper left corner.
fn outlines([x, y]: [f64; 2], says: &str, anchor: Anchor, size: f64) -> Vec<Step> {
    let part = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => 0.5,
        Anchor::End => 1.0,
    };
    let typeface = Typeface::usual();
    let mut left = x - part * size * lettering::width(says, typeface);
    let base = y + HALF_OF_LETTERS * size;
    let mut steps = Vec::new();
    for run in lettering::runs(says) {
        let (size, base) = (size * run.level.size(), base - size * run.level.rise());
        let place = |[across, up]: [f64; 2]| [left + size * across, base - size * up];
        let font = typeface.font(run.weight);
        steps.extend(font.outline(run.letters).into_iter().map(|step| match step {
            Step::Move(to) => Step::Move(place(to)),
            Step::Line(to) => Step::Line(place(to)),
            Step::Curve { control, to } => Step::Curve { control: place(control), to: place(to) },
        }));
        left += size * font.width(run.letters);
    }
    steps
}
