//! The bars of plots: one for each measure, as high as its value at a moment, or one for each bin of a histogram.

use super::super::occupancy::Rectangle;
use super::axis::Axis;
use super::{Axes, inside};
use crate::scene::Color;

/// The part of its room that a bar fills from left to right.
const FILLED_PART_OF_SLOT: f64 = 0.7;
/// The part of a bin that a bar of a histogram leaves free on each side.
const FREE_IN_BIN: f64 = 0.03;
/// The largest part of a bin that counts as a rounding error at its edge.
const MAX_ROUNDING: f64 = 1e-9;
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
        bars.extend(bar(
            [middle - FILLED_PART_OF_SLOT / 2.0, middle + FILLED_PART_OF_SLOT / 2.0],
            value,
            color,
            axes,
            area,
        ));
        middle += 1.0;
    }
    bars
}

/// Returns how many of some values are in each of equal parts of an axis. A value at the edge of two parts is in the upper one, and a value
/// at the high end is in the last.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the position is within the axis")]
pub(super) fn counts(values: &[f64], axis: &Axis, bins: u8) -> Vec<f64> {
    let mut counts = vec![0.0; usize::from(bins)];
    let is_inside = |place: &f64| (-MAX_ROUNDING..=1.0 + MAX_ROUNDING).contains(place);
    for place in values.iter().map(|value| axis.place(*value)).filter(is_inside) {
        let bin =
            (libm::floor(place * f64::from(bins) + MAX_ROUNDING).max(0.0) as usize).min(counts.len() - 1);
        counts[bin] += 1.0;
    }
    counts
}

/// Returns the bars of a histogram.
#[allow(clippy::cast_precision_loss, reason = "there are few bins")]
pub(super) fn of_counts(counts: &[f64], color: Color, axes: &Axes, area: &Rectangle) -> Vec<PlotBar> {
    let [low, high] = [axes[0].low, axes[0].high];
    let bins = counts.len().max(1) as f64;
    let mut number = 0.0;
    let mut bars = Vec::new();
    for count in counts {
        let ends = [number + FREE_IN_BIN, number + 1.0 - FREE_IN_BIN];
        let across = ends.map(|end| low + (high - low) * end / bins);
        bars.extend(bar(across, *count, color, axes, area));
        number += 1.0;
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

#[cfg(test)]
mod tests {
    use super::super::axis::Range;
    use super::*;

    #[test]
    fn each_value_is_counted_once_and_edges_belong_to_the_upper_bin() {
        let axis = Axis::new(&Range { span: [0.0, 1.0], is_wider: false, is_count: false }, 1.0);
        let values: Vec<f64> = (0..=10).map(|tenth| f64::from(tenth) / 10.0).collect();
        assert_eq!(counts(&values, &axis, 5), [2.0, 2.0, 2.0, 2.0, 3.0]);
        assert_eq!(counts(&[-1.0, 0.3, f64::NAN, 2.0], &axis, 2), [1.0, 0.0]);
        for bins in 1..=200 {
            assert_eq!(counts(&values, &axis, bins).iter().sum::<f64>(), 11.0, "{bins}");
        }
    }
}
