//! Lays out the panel of a plot: where its axes, its numbers and its legend stand.

use super::super::number::with_sign;
use super::super::occupancy::Rectangle;
use super::super::text::{MARGIN, Text, Vertical, across_free, is_top, width};
use super::axis::{Axis, Range, Tick};
use super::{Axes, PlotLine, Surroundings};
use crate::lettering::closed;
use crate::scene::{Color, DecimalSign, Plot, PlotPlace};

/// The distance between two plots.
pub(super) const GAP: f64 = 0.02;
/// The height of a panel, relative to its width.
const SHAPE: f64 = 0.64;
/// The largest height of a panel at a side of the picture, relative to its width.
const TALLEST: f64 = 0.9;
/// The least height of the axes, in lines of text.
const LEAST_LINES: f64 = 4.0;

/// The words of a plot.
pub(super) struct Legend<'a> {
    pub(super) title: Option<&'a str>,
    /// The names of the curves, in their colors.
    pub(super) names: &'a [(&'a str, Color)],
    pub(super) x_name: &'a str,
    /// The units of both axes.
    pub(super) units: [&'a str; 2],
    /// The sign before the decimals of numbers. It has the same width as a point.
    pub(super) sign: DecimalSign,
}

/// The layout of a plot.
pub(super) struct Panel {
    pub(super) left: f64,
    pub(super) bottom: Vertical,
    pub(super) size: [f64; 2],
    /// The rectangle between the axes, relative to the lower left corner of the panel.
    pub(super) area: Rectangle,
    /// The height of a line of text.
    line: f64,
    /// The height of the row with the name of the level axis. 0 if the name stands beside its numbers.
    name_row: f64,
    /// The position of each name of the legend: from the left, and the number of the row.
    names: Vec<(f64, f64)>,
    /// The distance from the upper edge of the panel to the base line of the first row of the legend.
    legend: f64,
}

impl Panel {
    /// Lays out a plot. If its words need more room than there is, its letters get smaller, and its longest words are cut.
    pub(super) fn new(
        plot: &Plot,
        legend: &Legend<'_>,
        ranges: &[Range; 2],
        around: Surroundings,
    ) -> (Panel, Axes) {
        /// The heights of letters that are tried, relative to the usual height.
        const SCALES: [f64; 6] = [1.0, 0.88, 0.77, 0.67, 0.58, 0.5];
        let mut layout = None;
        for scale in SCALES {
            let (panel, axes, fits) = Panel::with_letters(scale * around.line, plot, legend, ranges, around);
            layout = Some((panel, axes));
            if fits {
                break;
            }
        }
        // The list of scales is not empty.
        layout.unwrap_or_else(|| {
            let (panel, axes, _) = Panel::with_letters(around.line, plot, legend, ranges, around);
            (panel, axes)
        })
    }

    /// Lays out a plot with letters of a height. Also returns whether all of its words have room.
    #[allow(clippy::cast_precision_loss, reason = "there are few plots")]
    fn with_letters(
        line: f64,
        plot: &Plot,
        legend: &Legend<'_>,
        ranges: &[Range; 2],
        Surroundings { width: share, widest, free, aspect, used, count, column, others, .. }: Surroundings,
    ) -> (Panel, Axes, bool) {
        let wide = (2.0 * share).min(2.0 - 2.0 * MARGIN);
        let (pad, count, column) = (0.45 * line, count as f64, column as f64);
        // All plots of a column of the picture share the height that a scale bar and labels leave.
        let most = (2.0 * aspect - 2.0 * MARGIN - others - (column - 1.0) * GAP) / column;
        // A long name of the level axis stands below its numbers.
        let is_long = width(legend.x_name, line) > 0.2 * wide;
        let name_row = if is_long { 1.1 * line } else { 0.0 };
        let title_row = if legend.title.is_some() { 1.25 * line } else { 0.0 };
        let foot = pad + 1.25 * line + name_row;
        // The numbers of the upright axis need its height, which needs the rows of the legend, which need the width of these numbers. Two
        // rounds are enough: the numbers have about the same width with any step.
        let mut upright = Axis::new(&ranges[1], 1.0);
        let (mut numbers, mut names, mut rows, mut high, mut least) =
            (width("0.00", line), Vec::new(), 0.0, 0.0, 0.0);
        for _ in 0..2 {
            let unit = width(&upright.unit(legend.units[1]), line);
            let begin = (pad + numbers + 0.4 * line).max(pad + unit + 0.9 * line);
            (names, rows) = placed(legend, (begin, pad, wide - pad), line);
            let head = pad + title_row + (1.15 * rows + 0.5) * line;
            least = head + foot + LEAST_LINES * line;
            let usual = match plot.place {
                PlotPlace::Corner(_) => (SHAPE * wide).max(head + foot + 0.4 * wide),
                _ => TALLEST * 2.0 * widest,
            };
            // A panel that has no room at all still has axes.
            high = usual.max(least).min(most.max(head + foot + line));
            upright = Axis::new(&ranges[1], ((high - head - foot) / (2.0 * line)).clamp(1.0, 6.0));
            numbers = upright.ticks().iter().map(|tick| width(&tick.says, line)).fold(0.0, f64::max);
        }
        let left = pad + numbers + 0.4 * line;
        let room = wide - left - 2.0 * pad;
        let level = Axis::new(&ranges[0], (room / (2.8 * line)).clamp(1.0, 8.0));
        let widest_number = level.ticks().iter().map(|tick| width(&tick.says, line)).fold(0.0, f64::max);
        let level =
            Axis::new(&ranges[0], (room / (widest_number + 0.8 * line).max(2.8 * line)).clamp(1.0, 8.0));
        let legend_begin = pad + title_row + 0.8 * line;
        let area = Rectangle {
            left,
            right: wide - 2.0 * pad,
            bottom: foot,
            top: high - legend_begin - (1.15 * (rows - 1.0) + 0.85) * line,
        };
        let beside = Vertical::Middle((count * high + (count - 1.0) * GAP) / 2.0 - used - high);
        let ((x, align), bottom) = match plot.place {
            PlotPlace::Corner(corner) if is_top(corner) => {
                (across_free(corner, free), Vertical::Top(MARGIN + used + high))
            }
            PlotPlace::Corner(corner) => (across_free(corner, free), Vertical::Bottom(MARGIN + used)),
            PlotPlace::Left => ((MARGIN - 1.0, 0.0), beside),
            PlotPlace::Right => ((1.0 - MARGIN, 1.0), beside),
        };
        let words = legend.names.iter().map(|(name, _)| *name).chain([legend.x_name]).chain(legend.title);
        let longest = words.map(|words| width(words, line)).fold(0.0, f64::max);
        let fits = least <= most && longest <= wide - 2.0 * pad && room > 0.35 * wide;
        let panel = Panel {
            left: x - align * wide,
            bottom,
            size: [wide, high],
            area,
            line,
            name_row,
            names,
            legend: legend_begin,
        };
        (panel, [level, upright], fits)
    }

    /// The lines of the grid, then the axes.
    pub(super) fn lines(&self, axes: &Axes, grid: Color, axis: Color) -> Vec<PlotLine> {
        let Rectangle { left, right, bottom, top } = self.area;
        let across = |tick: Tick| left + tick.at * (right - left);
        let up = |tick: Tick| bottom + tick.at * (top - bottom);
        let line =
            |from, to, is_axis| PlotLine { from, to, color: if is_axis { axis } else { grid }, is_axis };
        let upright = |x: f64, is_axis| line([x, bottom], [x, top], is_axis);
        let level = |y: f64, is_axis| line([left, y], [right, y], is_axis);
        let [x_ticks, y_ticks] = axes.each_ref().map(Axis::ticks);
        let mut lines: Vec<PlotLine> = x_ticks.into_iter().map(|tick| upright(across(tick), false)).collect();
        let zero = y_ticks.iter().find(|tick| tick.value == 0.0 && tick.at > 1e-9).cloned();
        lines.extend(y_ticks.into_iter().map(|tick| level(up(tick), false)));
        lines.extend(zero.map(|tick| level(up(tick), true)));
        lines.extend([level(bottom, true), upright(left, true)]);
        lines
    }

    /// The title, the legend, and the numbers and units of the axes.
    pub(super) fn texts(&self, axes: &Axes, legend: &Legend<'_>, ink: Color) -> Vec<Text<'static>> {
        let Rectangle { left, right, bottom, top } = self.area;
        let line = self.line;
        let text = |says: String, at: [f64; 2], align: f64, color: Color| Text {
            name: "plot",
            says: says.into(),
            x: self.left + at[0],
            y: self.bottom.raised(at[1]),
            height: line,
            align,
            color,
        };
        let pad = 0.45 * line;
        let mut texts = Vec::new();
        let room = self.size[0] - 2.0 * pad;
        if let Some(title) = legend.title {
            let at = [self.size[0] / 2.0, self.size[1] - pad - 0.8 * line];
            texts.push(text(cut(title, room, line), at, 0.5, ink));
        }
        let row = self.size[1] - self.legend;
        let unit = axes[1].unit(legend.units[1]);
        if !unit.is_empty() {
            texts.push(text(unit, [pad, row], 0.0, ink));
        }
        for ((name, color), (x, number)) in legend.names.iter().zip(&self.names) {
            let name = cut(name, self.size[0] - pad - x, line);
            texts.push(text(name, [*x, row - 1.15 * number * line], 0.0, *color));
        }
        for tick in axes[1].ticks() {
            let y = bottom + tick.at * (top - bottom) - 0.27 * line;
            texts.push(text(with_sign(tick.says, legend.sign), [left - 0.4 * line, y], 1.0, ink));
        }
        let base = bottom - 1.05 * line;
        let unit = axes[0].unit(legend.units[0]);
        let name =
            if unit.is_empty() { legend.x_name.to_owned() } else { format!("{} ({unit})", legend.x_name) };
        // The name stands in place of the last numbers, or in a row of its own.
        let end = self.size[0] - pad;
        let begin_of_name = if self.name_row > 0.0 { end } else { end - width(&name, line) - 0.5 * line };
        for tick in axes[0].ticks() {
            let x = left + tick.at * (right - left);
            if x + width(&tick.says, line) / 2.0 < begin_of_name {
                texts.push(text(with_sign(tick.says, legend.sign), [x, base], 0.5, ink));
            }
        }
        texts.push(text(cut(&name, room, line), [end, base - self.name_row], 1.0, ink));
        texts
    }
}

/// Places the names of the curves in rows from `begin` to `end`; rows after the first, and a first name without room, start at `margin`.
/// Returns the positions, and the number of rows.
fn placed(legend: &Legend<'_>, (begin, margin, end): (f64, f64, f64), line: f64) -> (Vec<(f64, f64)>, f64) {
    let (mut x, mut row) = (begin, 0.0);
    let place = |(name, _): &(&str, Color)| {
        let wide = width(name, line);
        if x + wide > end && x > margin {
            (x, row) = (margin, row + 1.0);
        }
        let at = (x, row);
        x += wide + 0.9 * line;
        at
    };
    let names: Vec<(f64, f64)> = legend.names.iter().map(place).collect();
    (names, row + 1.0)
}

/// Cuts words that are wider than `room`: an ellipsis replaces their end.
fn cut(words: &str, room: f64, line: f64) -> String {
    if width(words, line) <= room {
        return words.to_owned();
    }
    let mut cut: String = words.to_owned();
    let with_ellipsis = |cut: &str| format!("{}…", closed(cut.trim_end().to_owned()));
    while !cut.is_empty() && width(&with_ellipsis(&cut), line) > room {
        cut.pop();
    }
    with_ellipsis(&cut)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_words_are_cut_and_short_ones_kept() {
        assert_eq!(cut("height", 9.0, 1.0), "height");
        let short = cut("Höchstgeschwindigkeit", 5.0, 1.0);
        assert!(short.starts_with("Höch") && short.ends_with('…') && width(&short, 1.0) <= 5.0, "{short}");
    }

    #[test]
    fn names_stand_in_rows_within_the_panel() {
        let names = [("first", Color::WHITE), ("second", Color::WHITE), ("a much longer name", Color::WHITE)];
        let legend =
            Legend { title: None, names: &names, x_name: "t", units: ["s", "J"], sign: DecimalSign::Point };
        let (places, rows) = placed(&legend, (1.0, 0.4, 10.0), 1.0);
        assert_eq!(rows, 2.0);
        assert!(places[0] == (1.0, 0.0) && places[1].1 == 0.0 && places[2] == (0.4, 1.0), "{places:?}");
    }
}
