//! The bars of plots: one for each measure, as high as its value at a moment.

use super::super::occupancy::Rectangle;
use super::{Axes, inside};
use crate::scene::Color;

/// The part of its room that a bar fills from left to right.
const FILLED: f64 = 0.7;
/// The smallest height of a drawn bar, relative to the height of the plot.
const MIN_HEIGHT: f64 = 1e-5;

/// A bar of a plot at a moment: a rectangle in the panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlotBar {
    /// The left end of its lower edge.
    pub from: [f64; 2],
    /// The right end of its upper edge.
    pub to: [f64; 2],
    /// Its color.
    pub color: Color,
}

/// Returns the bars of some values beside each other. A value of zero or without a place, such as the speed of an absent body, has no bar.
pub(super) fn beside_each_other(
    values: impl Iterator<Item = (f64, Color)>,
    axes: &Axes,
    area: &Rectangle,
) -> Vec<PlotBar> {
    let mut bars = Vec::new();
    let mut middle = 0.5;
    for (value, color) in values {
        bars.extend(bar([middle - FILLED / 2.0, middle + FILLED / 2.0], value, color, axes, area));
        middle += 1.0;
    }
    bars
}

/// Returns the bar of a value between two values of the horizontal axis. It begins at zero, or at the end of the vertical axis next to
/// zero. `None` if nothing of it is visible.
fn bar(across: [f64; 2], value: f64, color: Color, axes: &Axes, area: &Rectangle) -> Option<PlotBar> {
    let [left, right] = across.map(|end| axes[0].place(end));
    let [zero, end] = [0.0, value].map(|value| axes[1].place(value).clamp(0.0, 1.0));
    let [from, to] = [[left, zero.min(end)], [right, zero.max(end)]].map(|corner| inside(area, corner));
    ((zero - end).abs() > MIN_HEIGHT).then_some(PlotBar { from, to, color })
}
