//! Lays out the panel of a plot: where its axes, its numbers and its legend stand.

use super::super::number::with_sign;
use super::super::occupancy::Rectangle;
use super::super::text::{Text, Vertical, width};
use super::axis::{Axis, AxisScale, Tick};
use super::ends::apart;
use super::room::Room;
use super::{Axes, PlotLine};
use crate::font::Typeface;
use crate::lettering::closed;
use crate::scene::{Color, DecimalSign, Plot, PlotPlace};

/// The usual height of a panel in a corner of the picture, relative to its width.
const USUAL_HEIGHT: f64 = 0.64;
/// The smallest usual height of the vertical axis of a panel in a corner, relative to the width of the panel.
const MIN_USUAL_AXIS: f64 = 0.4;
/// The usual height of a panel at a side of the picture, relative to the width of the widest panel there.
const USUAL_HEIGHT_AT_SIDE: f64 = 0.9;
/// The smallest height of the vertical axis at which a plot is easy to read, in lines of text.
const MIN_AXIS: f64 = 4.0;
/// The smallest height of the vertical axis of a plot without room, in lines of text.
const MIN_AXIS_WITHOUT_ROOM: f64 = 1.0;
/// The smallest width of the horizontal axis at which a plot is easy to read, relative to the width of the panel.
const MIN_LEVEL_AXIS: f64 = 0.35;
/// The width of the name of the horizontal axis from which on it stands below the numbers, relative to the width of the panel.
const LONG_NAME: f64 = 0.2;
/// The heights of letters that are tried, relative to the usual height.
const LETTER_HEIGHTS: [f64; 6] = [1.0, 0.88, 0.77, 0.67, 0.58, 0.5];
/// The distance of the contents of a panel from its edges, in lines of text.
pub(super) const PANEL_PADDING: f64 = 0.45;
/// The distance between the numbers of the vertical axis and the axis, in lines of text.
const BESIDE_AXIS: f64 = 0.4;
/// The distance between two rows of the legend, in lines of text.
const LEGEND_ROW: f64 = 1.15;
/// The height of the row with the title, in lines of text.
const TITLE_ROW: f64 = 1.25;
/// The height of the row with the numbers of the horizontal axis, in lines of text.
pub(super) const NUMBERS_ROW: f64 = 1.25;
/// The height of the row with the name of the horizontal axis, in lines of text.
const NAME_ROW: f64 = 1.1;
/// The distance between two numbers of the horizontal axis, and between two of the vertical one, in lines of text. Numbers of the horizontal axis may be
/// farther apart, if they are wide.
const BETWEEN_NUMBERS: [f64; 2] = [2.8, 2.0];
/// Half of the height of a name at the end of a curve, in lines of text.
const HALF_OF_NAME: f64 = 0.4;
/// The smallest distance between two names below bars, in lines of text.
const BETWEEN_NAMES: f64 = 0.5;
/// The largest number of intervals between the numbers of the level and of the vertical axis.
const MAX_INTERVALS: [f64; 2] = [8.0, 6.0];

/// The words of a plot.
pub(super) struct Legend<'a> {
    pub(super) title: Option<&'a str>,
    /// The names of the curves, in their colors.
    pub(super) names: &'a [(&'a str, Color)],
    /// Whether the names of the curves stand at their right ends, and not above the plot.
    pub(super) at_ends: bool,
    /// The names below the bars, in their colors. They stand in place of the numbers and the name of the horizontal axis.
    pub(super) below: &'a [(&'a str, Color)],
    pub(super) x_name: &'a str,
    /// The units of both axes.
    pub(super) units: [&'a str; 2],
    /// The decimal sign of numbers: a point or a comma. Both have the same width.
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
    /// The height of the row with the name of the horizontal axis. 0 if the name stands beside its numbers.
    name_row: f64,
    /// The room of each name below a bar.
    room_of_name: f64,
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
        scales: &[AxisScale; 2],
        room: &Room,
    ) -> (Panel, Axes) {
        let with = |scale: f64| Panel::with_letters(scale * room.line, plot, legend, scales, room);
        let [usual, smaller @ ..] = LETTER_HEIGHTS;
        let (mut panel, mut axes, mut fits) = with(usual);
        for scale in smaller {
            if fits {
                break;
            }
            (panel, axes, fits) = with(scale);
        }
        (panel, axes)
    }

    /// Lays out a plot with letters of a height. Also returns whether all of its words have room.
    fn with_letters(
        line: f64,
        plot: &Plot,
        legend: &Legend<'_>,
        scales: &[AxisScale; 2],
        room: &Room,
    ) -> (Panel, Axes, bool) {
        let (wide, most) = (room.panel_width(), room.max_height());
        let (pad, beside_axis) = (PANEL_PADDING * line, BESIDE_AXIS * line);
        let name_row = if width(legend.x_name, line) > LONG_NAME * wide { NAME_ROW * line } else { 0.0 };
        let title_row = if legend.title.is_some() { TITLE_ROW * line } else { 0.0 };
        // Names that are too wide to stand beside each other stand in two rows in turn.
        let room_of_name =
            (wide - 3.0 * pad - width("0.00", line) - beside_axis) / count_of(legend.below).max(1.0);
        let widest_name = legend.below.iter().map(|(name, _)| width(name, line)).fold(0.0, f64::max);
        let in_turn = legend.below.len() > 1 && widest_name + BETWEEN_NAMES * line > room_of_name;
        let room_of_name = room_of_name * if in_turn { 2.0 } else { 1.0 } - BETWEEN_NAMES * line;
        let name_row = if in_turn { NAME_ROW * line } else { name_row };
        let widest_at_end = legend.names.iter().map(|(name, _)| width(name, line)).fold(0.0, f64::max);
        let beside = if legend.at_ends { widest_at_end + BESIDE_AXIS * line - pad } else { 0.0 };
        let foot = pad + NUMBERS_ROW * line + name_row;
        // The numbers of the vertical axis need its height, which needs the rows of the legend, which need the width of these numbers. Two
        // rounds are enough: the numbers have about the same width with any step.
        let mut upright = scales[1].axis(1.0);
        let (mut numbers, mut names, mut rows, mut high, mut least) =
            (width("0.00", line), Vec::new(), 0.0, 0.0, 0.0);
        for _ in 0..2 {
            let unit = width(&upright.unit(legend.units[1]), line);
            let begin = (pad + numbers + beside_axis).max(pad + unit + 0.9 * line);
            (names, rows) = match legend.at_ends {
                true => (Vec::new(), 1.0),
                false => placed(legend, (begin, pad, wide - pad), line),
            };
            let head = pad + title_row + (LEGEND_ROW * rows + 0.5) * line;
            least = head + foot + MIN_AXIS * line;
            let usual = match plot.place {
                PlotPlace::Corner(_) => (USUAL_HEIGHT * wide).max(head + foot + MIN_USUAL_AXIS * wide),
                _ => USUAL_HEIGHT_AT_SIDE * room.widest,
            };
            high = usual.max(least).min(most.max(head + foot + MIN_AXIS_WITHOUT_ROOM * line));
            let intervals = (high - head - foot) / (BETWEEN_NUMBERS[1] * line);
            upright = scales[1].axis(intervals.clamp(1.0, MAX_INTERVALS[1]));
            numbers = upright.ticks().iter().map(|tick| width(&tick.says, line)).fold(0.0, f64::max);
        }
        let left = pad + numbers + beside_axis;
        let across = wide - left - 2.0 * pad - beside;
        let level = |interval: f64| scales[0].axis((across / interval).clamp(1.0, MAX_INTERVALS[0]));
        let narrow = BETWEEN_NUMBERS[0] * line;
        let ticks = level(narrow).ticks();
        let widest = ticks.iter().map(|tick| width(&tick.says, line)).fold(0.0, f64::max);
        let level = level(narrow.max(widest + 0.8 * line));
        let legend_begin = pad + title_row + 0.8 * line;
        let area = Rectangle {
            left,
            right: wide - 2.0 * pad - beside,
            bottom: foot,
            top: high - legend_begin - (LEGEND_ROW * (rows - 1.0) + 0.85) * line,
        };
        let (left_edge, bottom) = room.corner_of(plot.place, [wide, high]);
        let words = legend.names.iter().map(|(name, _)| *name).chain([legend.x_name]).chain(legend.title);
        let longest = words.map(|words| width(words, line)).fold(0.0, f64::max);
        let fits = least <= most
            && widest_name <= room_of_name
            && longest <= wide - 2.0 * pad
            && across > MIN_LEVEL_AXIS * wide;
        let panel = Panel {
            left: left_edge,
            bottom,
            size: [wide, high],
            area,
            line,
            name_row,
            room_of_name,
            names,
            legend: legend_begin,
        };
        (panel, [level, upright], fits)
    }

    /// The faint lines between those of the grid, then the grid, then the axes.
    pub(super) fn lines(&self, axes: &Axes, [faint, grid, axis]: [Color; 3]) -> Vec<PlotLine> {
        let Rectangle { left, right, bottom, top } = self.area;
        let across = |at: f64| left + at * (right - left);
        let up = |at: f64| bottom + at * (top - bottom);
        let line = |from, to, color| PlotLine { from, to, color, is_axis: color == axis };
        let upright = |x: f64, color| line([x, bottom], [x, top], color);
        let level = |y: f64, color| line([left, y], [right, y], color);
        let [x_between, y_between] = axes.each_ref().map(Axis::between);
        let [x_ticks, y_ticks] = axes.each_ref().map(Axis::ticks);
        let zero = y_ticks.iter().find(|tick| tick.value == 0.0 && tick.at > 1e-9).map(|tick| tick.at);
        let places = |ticks: Vec<Tick>| ticks.into_iter().map(|tick| tick.at).collect::<Vec<f64>>();
        let mut lines = Vec::new();
        for (x, y, color) in [(x_between, y_between, faint), (places(x_ticks), places(y_ticks), grid)] {
            lines.extend(x.into_iter().map(|at| upright(across(at), color)));
            lines.extend(y.into_iter().map(|at| level(up(at), color)));
        }
        lines.extend(zero.map(|at| level(up(at), axis)));
        lines.extend([level(bottom, axis), upright(left, axis)]);
        lines
    }

    /// The names of curves beside their right ends, given the heights of these ends. `None` if they have no room.
    pub(super) fn names_at_ends(
        &self,
        names: &[(&str, Color)],
        heights: &[Option<f64>],
    ) -> Option<Vec<Text<'static>>> {
        if self.area.right - self.area.left < MIN_LEVEL_AXIS * self.size[0] {
            return None;
        }
        let known: Vec<f64> = heights.iter().copied().flatten().collect();
        let half = HALF_OF_NAME * self.line;
        let at = apart(&known, self.line, [self.area.bottom + half, self.area.top - half])?;
        let known = names.iter().zip(heights).filter(|(_, height)| height.is_some());
        let text = |((name, color), y): (&(&str, Color), f64)| Text {
            name: "plot",
            says: (*name).to_owned().into(),
            x: self.left + self.area.right + BESIDE_AXIS * self.line,
            y: self.bottom.raised(y - 0.27 * self.line),
            height: self.line,
            align: 0.0,
            color: *color,
            typeface: Typeface::usual(),
            anchor: None,
        };
        Some(known.map(|(name, _)| name).zip(at).map(text).collect())
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
            typeface: Typeface::usual(),
            anchor: None,
        };
        let pad = PANEL_PADDING * line;
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
        let above = legend.names.iter().zip(&self.names).filter(|_| !legend.at_ends);
        for ((name, color), (x, number)) in above {
            let name = cut(name, self.size[0] - pad - x, line);
            texts.push(text(name, [*x, row - LEGEND_ROW * number * line], 0.0, *color));
        }
        for tick in axes[1].ticks() {
            let y = bottom + tick.at * (top - bottom) - 0.27 * line;
            let says = with_sign(tick.says, legend.sign);
            texts.push(text(says, [left - BESIDE_AXIS * line, y], 1.0, ink));
        }
        let base = bottom - 1.05 * line;
        let mut middle = 0.5;
        for (number, (name, color)) in legend.below.iter().enumerate() {
            let x = left + axes[0].place(middle) * (right - left);
            let row = if number % 2 == 1 { self.name_row } else { 0.0 };
            // Beside the edges of the panel, a name has less room.
            let most = 2.0 * (x - pad).min(self.size[0] - pad - x);
            texts.push(text(cut(name, self.room_of_name.min(most), line), [x, base - row], 0.5, *color));
            middle += 1.0;
        }
        if !legend.below.is_empty() {
            return texts;
        }
        let name = axes[0].named(legend.x_name, legend.units[0]);
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

#[allow(clippy::cast_precision_loss, reason = "there are few names")]
fn count_of(names: &[(&str, Color)]) -> f64 {
    names.len() as f64
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
pub(super) fn cut(words: &str, room: f64, line: f64) -> String {
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
        let legend = Legend {
            title: None,
            names: &names,
            at_ends: false,
            below: &[],
            x_name: "t",
            units: ["s", "J"],
            sign: DecimalSign::Point,
        };
        let (places, rows) = placed(&legend, (1.0, 0.4, 10.0), 1.0);
        assert_eq!(rows, 2.0);
        assert!(places[0] == (1.0, 0.0) && places[1].1 == 0.0 && places[2] == (0.4, 1.0), "{places:?}");
    }
}
