//! The room that a plot has in the picture. A plot at a side takes its room from the bodies, which the camera frames in the rest of the
//! picture. A plot in a corner shares it with other plots, labels and the scale bar.

use super::super::bar;
use super::super::framing::Free;
use super::super::labels;
use super::super::text::{MARGIN, Vertical, across_free, is_top, usual_height};
use super::{PlannedPlot, color_bar};
use crate::scene::{Corner, Output, Plot, PlotPlace, Scene};

/// The usual height of a line of text, as a fraction of the picture's shorter side.
const USUAL_LINE: f64 = 0.036;
/// The smallest usual height of a line of text, pixels. Smaller letters cannot be read.
const MIN_LINE: f64 = 10.5;
/// The usual width of a plot, as a fraction of the picture's width.
const USUAL_WIDTH: f64 = 0.36;
/// The usual width of a color bar, as a fraction of the picture's width.
const COLOR_BAR_WIDTH: f64 = 0.26;
/// The smallest usual width of a plot, pixels. Smaller plots cannot be read.
const MIN_WIDTH: f64 = 140.0;
/// The largest usual width of a plot in a corner, as a fraction of the picture's width.
const MAX_WIDTH_IN_CORNER: f64 = 0.5;
/// The largest part that the plots at a side take of the picture's width, with the space beside them.
const MAX_TAKEN_AT_SIDE: f64 = 0.44;
/// The largest part that the plots at both sides take of the picture's width.
const MAX_TAKEN_AT_SIDES: f64 = 0.8;
/// The vertical distance between two plots in the image plane, where the picture has a width of 2.
pub(super) const GAP: f64 = 0.02;

/// The room of a plot in the picture. Lengths are in the image plane, where the picture has a width of 2, unless noted otherwise.
#[derive(Clone, Copy)]
pub(super) struct Room {
    /// The height of a line of text.
    pub(super) line: f64,
    /// The width of the plot.
    pub(super) width: f64,
    /// The width of the widest plot in the same place.
    pub(super) widest: f64,
    /// The part of the picture that plots at its sides leave free.
    free: Free,
    /// The height of the picture, relative to its width.
    aspect: f64,
    /// The height that the scale bar, and plots before this one, use in the same place.
    used: f64,
    /// The number of plots in the same place, this one included.
    count: usize,
    /// The number of plots in the same column of the picture, this one included.
    column: usize,
    /// The height of the labels and the scale bar in the corners of this column.
    others: f64,
}

impl Room {
    /// Returns the room of a plot in the picture of a scene. `before` are the plots before it.
    pub(super) fn in_picture(scene: &Scene, plot: &Plot, before: &[PlannedPlot]) -> Room {
        let (output, aspect) = (scene.output, aspect(scene.output));
        let here = || scene.plots.iter().filter(|other| other.place == plot.place);
        let is_in_column = |other: &&Plot| column(other.place) == column(plot.place);
        Room {
            line: line(output),
            width: 2.0 * width(plot, output),
            widest: here().map(|other| 2.0 * width(other, output)).fold(0.0, f64::max),
            free: free(scene),
            aspect,
            used: used(scene, plot.place, before),
            count: here().count(),
            column: scene.plots.iter().filter(is_in_column).count(),
            others: others(scene, plot.place),
        }
    }

    /// Returns the room of a color bar. `plots` are those that stand in the picture already; `before` is the height of earlier color bars in
    /// the same corner.
    pub(super) fn of_color_bar(scene: &Scene, corner: Corner, plots: &[PlannedPlot], before: f64) -> Room {
        let (place, output) = (PlotPlace::Corner(corner), scene.output);
        let wide = 2.0 * (MIN_WIDTH / f64::from(output.width)).clamp(COLOR_BAR_WIDTH, MAX_WIDTH_IN_CORNER);
        Room {
            line: line(output),
            width: wide,
            widest: wide,
            free: free(scene),
            aspect: aspect(output),
            used: used(scene, place, plots) + before,
            count: 1,
            column: 1,
            others: 0.0,
        }
    }

    /// Returns the room of a plot in a picture of its own, whose letters have this height.
    pub(super) fn alone(line: f64) -> Room {
        Room {
            line,
            width: 2.0,
            widest: 2.0,
            free: Free::ALL,
            aspect: 1.0,
            used: 0.0,
            count: 1,
            column: 1,
            others: 0.0,
        }
    }

    /// Returns the width of the panel.
    pub(super) fn panel_width(&self) -> f64 {
        self.width.min(2.0 - 2.0 * MARGIN)
    }

    /// Returns the largest height of the panel with which all plots of the column have room. They share the height that labels and the
    /// scale bar leave.
    #[allow(clippy::cast_precision_loss, reason = "there are few plots")]
    pub(super) fn max_height(&self) -> f64 {
        let column = self.column as f64;
        (2.0 * self.aspect - 2.0 * MARGIN - self.others - (column - 1.0) * GAP) / column
    }

    /// Returns the left and the lower edge of a panel with this width and height.
    #[allow(clippy::cast_precision_loss, reason = "there are few plots")]
    pub(super) fn corner_of(&self, place: PlotPlace, [wide, high]: [f64; 2]) -> (f64, Vertical) {
        let count = self.count as f64;
        let beside = Vertical::Middle((count * high + (count - 1.0) * GAP) / 2.0 - self.used - high);
        let ((x, align), bottom) = match place {
            PlotPlace::Corner(corner) if is_top(corner) => {
                (across_free(corner, self.free), Vertical::Top(MARGIN + self.used + high))
            }
            PlotPlace::Corner(corner) => {
                (across_free(corner, self.free), Vertical::Bottom(MARGIN + self.used))
            }
            PlotPlace::Left => ((MARGIN - 1.0, 0.0), beside),
            PlotPlace::Right => ((1.0 - MARGIN, 1.0), beside),
        };
        (x - align * wide, bottom)
    }
}

/// Returns the height of a picture, relative to its width.
fn aspect(output: Output) -> f64 {
    f64::from(output.height) / f64::from(output.width)
}

/// Returns the height of a line of text.
fn line(output: Output) -> f64 {
    usual_height(USUAL_LINE, MIN_LINE, output)
}

/// Returns the height that the scale bar and plots use in a place. `before` are the plots that stand in the picture already.
fn used(scene: &Scene, place: PlotPlace, before: &[PlannedPlot]) -> f64 {
    let scale_bar = scene.scale_bar.filter(|bar| PlotPlace::Corner(bar.corner) == place);
    let bar = scale_bar.map_or(0.0, |_| bar::room(scene.output));
    let before = scene.plots.iter().zip(before).filter(|(other, _)| other.place == place);
    bar + before.map(|(_, planned)| planned.size[1] + GAP).sum::<f64>()
}

/// Returns the width of a plot, as a fraction of the picture's width.
fn width(plot: &Plot, output: Output) -> f64 {
    let most = match plot.place {
        PlotPlace::Corner(_) => MAX_WIDTH_IN_CORNER,
        PlotPlace::Left | PlotPlace::Right => Plot::MAX_WIDTH_AT_SIDE,
    };
    plot.width.unwrap_or_else(|| (MIN_WIDTH / f64::from(output.width)).clamp(USUAL_WIDTH, most))
}

/// Returns the part of the picture's width that plots at its sides leave free.
pub(in super::super) fn free(scene: &Scene) -> Free {
    let taken = |place: PlotPlace| {
        let plots = scene.plots.iter().filter(|plot| plot.place == place);
        let widths = plots.map(|plot| width(plot, scene.output) + MARGIN / 2.0);
        widths.fold(0.0, f64::max).min(MAX_TAKEN_AT_SIDE)
    };
    let [left, right] = [PlotPlace::Left, PlotPlace::Right].map(taken);
    let scale = 1.0_f64.min(MAX_TAKEN_AT_SIDES / (left + right).max(1e-9));
    Free { center: (left - right) * scale, half: 1.0 - (left + right) * scale, ..Free::ALL }
}

/// Returns the column of the picture that a plot stands in, numbered from left to right. A plot in a corner stands beside those at a side.
pub(super) fn column(place: PlotPlace) -> i8 {
    match place {
        PlotPlace::Left => -2,
        PlotPlace::Corner(Corner::TopLeft | Corner::BottomLeft) => -1,
        PlotPlace::Corner(Corner::Top | Corner::Bottom) => 0,
        PlotPlace::Corner(Corner::TopRight | Corner::BottomRight) => 1,
        PlotPlace::Right => 2,
    }
}

/// Returns the height of the labels, the scale bar and the color bars that stand in the same column as a plot in a corner. Beside plots at a side, they have
/// the rest of the picture.
fn others(scene: &Scene, place: PlotPlace) -> f64 {
    if !matches!(place, PlotPlace::Corner(_)) {
        return 0.0;
    }
    let is_here = |corner: Corner| column(PlotPlace::Corner(corner)) == column(place);
    let bar = scene.scale_bar.filter(|bar| is_here(bar.corner)).map_or(0.0, |_| bar::room(scene.output));
    bar + labels::least_room(scene, is_here) + color_bar::heights(scene, line(scene.output), is_here)
}
