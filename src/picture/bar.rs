//! The scale bar: a line with the length that it represents. This length is true at the center of the bounds that the camera frames.

use glam::DVec3;

use super::framing::Free;
use super::grid::{LEAST_PIXELS, SIZE};
use super::length::{prefixed, value};
use super::occupancy::Rectangle;
use super::plots;
use super::screen::Screen;
use super::stage::Scenery;
use super::text::{MARGIN, Text, Vertical, across_free, is_top, usual_height};
use crate::decimal::round_below;
use crate::font::Typeface;
use crate::scene::{Color, DecimalSign, Output, ScaleBar, Scene};

/// A scale bar in the image plane, where the picture has a width of 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// The horizontal position of the left end, from -1 to 1.
    pub from: f64,
    /// The horizontal position of the right end, from -1 to 1.
    pub to: f64,
    /// The vertical position of the bar.
    pub y: Vertical,
    /// The thickness of the bar, in units of the image plane.
    pub thickness: f64,
    /// The distance from the bar up to the base line of its number, in units of the image plane.
    pub above: f64,
    /// The color of the bar.
    pub color: Color,
}

impl Bar {
    /// The area that the bar covers in a picture with the given ratio of height to width.
    pub(super) fn area(&self, aspect: f64) -> Rectangle {
        let middle = self.y.above_middle(aspect);
        let half = 2.5 * self.thickness;
        Rectangle { left: self.from, right: self.to, bottom: middle - half, top: middle + half }
    }
}

/// The scale bars of all frames.
#[derive(Clone, Debug)]
pub(super) struct ScaleBars {
    bar: ScaleBar,
    /// The center of the framed bounds, m. The bar is true to scale at this point.
    middle: DVec3,
    /// The height of a line of text in the image plane.
    height: f64,
    ink: Color,
    /// The part of the picture that plots at its sides leave free.
    free: Free,
    sign: DecimalSign,
}

/// Returns the height that a scale bar with its number needs in the image plane.
pub(super) fn room(output: Output) -> f64 {
    2.0 * number_height(output)
}

/// Returns the height of a scale bar's number in the image plane.
fn number_height(output: Output) -> f64 {
    usual_height(SIZE, LEAST_PIXELS, output)
}

impl ScaleBars {
    pub(super) fn new(scene: &Scene, bar: ScaleBar, scenery: &Scenery, ink: Color) -> ScaleBars {
        let middle = (scenery.bounds.min + scenery.bounds.max) / 2.0;
        let height = number_height(scene.output);
        ScaleBars { bar, middle, height, ink, free: plots::free(scene), sign: scene.output.decimal }
    }

    /// The length that the bar represents, m, and its width in the image plane of a camera. `None` if the center of the framed bounds is
    /// behind the camera.
    pub(super) fn extent(&self, screen: &Screen) -> Option<(f64, f64)> {
        let point = screen.project(self.middle)?;
        let quarter = 0.5 / point.scale;
        let length = self.bar.length.unwrap_or_else(|| round_below(quarter));
        Some((length, length * point.scale))
    }

    /// Returns the bar and its number in the image plane of a camera. `None` if the center of the framed bounds is behind the camera.
    pub(super) fn on(&self, screen: &Screen) -> Option<(Bar, Text<'static>)> {
        let (length, width) = self.extent(screen)?;
        let (x, align) = across_free(self.bar.corner, self.free);
        let left = x - align * width;
        let y = match is_top(self.bar.corner) {
            true => Vertical::Top(MARGIN + 1.6 * self.height),
            false => Vertical::Bottom(MARGIN + 0.25 * self.height),
        };
        let above = 0.45 * self.height;
        let bar = Bar { from: left, to: left + width, y, thickness: 0.005, above, color: self.ink };
        let (unit, symbol) = prefixed(length);
        let number = Text {
            name: "scale bar",
            says: format!("{} {symbol}", value(length / unit, self.sign)).into(),
            x: left + width / 2.0,
            y: y.raised(above),
            height: self.height,
            align: 0.5,
            color: self.ink,
            typeface: Typeface::usual(),
            anchor: None,
        };
        Some((bar, number))
    }
}
