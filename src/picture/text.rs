//! A text in the picture, and its position.

use std::borrow::Cow;

use glam::DVec3;

use super::framing::Free;
use super::occupancy::Rectangle;
use crate::font::Typeface;
use crate::lettering;
use crate::scene::{Color, Corner, Output};

/// The distance of texts from the edges of the picture, which has a width of 2.
pub(super) const MARGIN: f64 = 0.035;

/// The distance between the base lines of two successive lines of text, relative to the height of a line.
pub const LINE: f64 = 1.15;

/// The extents of letters above and below their base line, relative to the height of a line.
const ABOVE: f64 = 0.75;
const BELOW: f64 = 0.25;

/// A text in the image plane, on one or several lines. x goes from -1 at the left edge of the picture to 1 at the right edge; y has the same scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Text<'a> {
    /// The source of the text: the name of a label, `grid`, or `scale bar`.
    pub name: &'a str,
    /// The words of the text, with a line break between two lines, and with the marks of [`lettering`] around subscripts and superscripts.
    pub says: Cow<'a, str>,
    /// The horizontal position of the text's reference point, which `align` selects.
    pub x: f64,
    /// The vertical position of the base line of the first line.
    pub y: Vertical,
    /// The height of a line of text.
    pub height: f64,
    /// The part of each line that is at `x`: 0 for its start, 0.5 for its middle, 1 for its end.
    pub align: f64,
    /// The color of the text.
    pub color: Color,
    /// The fonts in which the text is set.
    pub typeface: &'a Typeface,
    /// The point of the world that the text names, m. `None` for a text that names no point.
    pub anchor: Option<DVec3>,
}

impl Text<'_> {
    /// The distance from the base line of the first line down to that of the last.
    pub(super) fn below(&self) -> f64 {
        below(self.says.matches('\n').count() + 1, self.height)
    }

    /// The rectangle that the text covers, in a picture with the given ratio of height to width.
    pub(super) fn area(&self, aspect: f64) -> Rectangle {
        let wide = self.height * lettering::width(&self.says, self.typeface);
        let (left, base) = (self.x - self.align * wide, self.y.above_middle(aspect));
        Rectangle {
            left,
            right: left + wide,
            bottom: base - self.below() - BELOW * self.height,
            top: base + ABOVE * self.height,
        }
    }
}

/// A vertical position in a picture with a width of 2. Distances from the upper and lower edges are independent of the picture's height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Vertical {
    /// A distance above the middle of the picture.
    Middle(f64),
    /// A distance below the upper edge of the picture.
    Top(f64),
    /// A distance above the lower edge of the picture.
    Bottom(f64),
}

impl Vertical {
    /// The distance above the middle of a picture with the given ratio of height to width.
    pub fn above_middle(self, aspect: f64) -> f64 {
        match self {
            Vertical::Middle(height) => height,
            Vertical::Top(inset) => aspect - inset,
            Vertical::Bottom(inset) => inset - aspect,
        }
    }

    /// Moves the position up by a distance.
    #[must_use]
    pub fn raised(self, by: f64) -> Vertical {
        match self {
            Vertical::Middle(height) => Vertical::Middle(height + by),
            Vertical::Top(inset) => Vertical::Top(inset - by),
            Vertical::Bottom(inset) => Vertical::Bottom(inset + by),
        }
    }
}

/// The distance from the base line of the first of some lines down to that of the last.
#[allow(clippy::cast_precision_loss, reason = "there are few lines")]
pub(super) fn below(rows: usize, height: f64) -> f64 {
    rows.saturating_sub(1) as f64 * LINE * height
}

/// Converts the height of a line of text from pixels to units of the image plane, in which the picture has a width of 2.
pub(super) fn least_height(pixels: f64, output: Output) -> f64 {
    2.0 * pixels / f64::from(output.width)
}

/// The usual height of a line of text in the image plane, where the picture has a width of 2. `size` is relative to the shorter side of the
/// picture. The letters have at least `least` pixels.
pub(super) fn usual_height(size: f64, least: f64, output: Output) -> f64 {
    let aspect = f64::from(output.height) / f64::from(output.width);
    (2.0 * aspect.min(1.0) * size).max(least_height(least, output))
}

/// Returns the width of a text in the usual font for a line height.
pub(super) fn width(says: &str, height: f64) -> f64 {
    height * lettering::width(says, Typeface::usual())
}

/// The horizontal position of a text in a corner, and its alignment.
pub(super) fn across(corner: Corner) -> (f64, f64) {
    match corner {
        Corner::TopLeft | Corner::BottomLeft => (MARGIN - 1.0, 0.0),
        Corner::Top | Corner::Bottom => (0.0, 0.5),
        Corner::TopRight | Corner::BottomRight => (1.0 - MARGIN, 1.0),
    }
}

/// The horizontal position of a text in a corner of the part of the picture that is free, and its alignment.
pub(super) fn across_free(corner: Corner, free: Free) -> (f64, f64) {
    match across(corner).1 {
        0.5 => (free.center, 0.5),
        0.0 => (MARGIN + (free.center - free.half), 0.0),
        align => (free.center + free.half - MARGIN, align),
    }
}

/// True if a corner is at the upper edge of the picture.
pub(super) fn is_top(corner: Corner) -> bool {
    matches!(corner, Corner::TopLeft | Corner::Top | Corner::TopRight)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_are_from_the_middle_and_from_the_edges() {
        for (height, expected) in
            [(Vertical::Middle(0.1), 0.1), (Vertical::Top(0.1), 0.4), (Vertical::Bottom(0.1), -0.4)]
        {
            assert!((height.above_middle(0.5) - expected).abs() < 1e-12, "{height:?}");
            assert!((height.raised(0.2).above_middle(0.5) - expected - 0.2).abs() < 1e-12, "{height:?}");
        }
    }
}
