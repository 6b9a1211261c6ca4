//! Color bars: the colors of a color map, with the numbers of their values.

use super::axis::{Axis, Range};
use super::colors::mixed;
use super::panel::{NUMBERS_ROW, PANEL_PADDING, cut};
use super::room::{GAP, Room};
use super::{PlannedPlot, PlotLine, Strip};
use crate::font::Typeface;
use crate::picture::number::with_sign;
use crate::picture::text::{Text, width};
use crate::scene::{Color, ColorMap, Corner, PlotPlace, Scene};
use crate::simulate::Survey;

/// The number of colors from which the strip is drawn. Between them, colors are mixed.
const COLORS_OF_STRIP: usize = 33;
/// The height of the strip, in lines of text.
const STRIP_HEIGHT: f64 = 0.8;
/// The length of the marks at the numbers, in lines of text.
const MARK_LENGTH: f64 = 0.25;
/// The height of the row with the title, in lines of text.
const TITLE_ROW_HEIGHT: f64 = 1.35;
/// The smallest space between two numbers, in lines of text.
const BETWEEN_NUMBERS: f64 = 0.7;
/// The largest numbers of intervals between numbers that are tried.
const MAX_INTERVALS: [f64; 6] = [6.0, 5.0, 4.0, 3.0, 2.0, 1.0];

/// Returns the height of a color bar, in lines of text.
const fn height() -> f64 {
    2.0 * PANEL_PADDING + NUMBERS_ROW + STRIP_HEIGHT + TITLE_ROW_HEIGHT
}

/// Returns the maps of a scene that have a color bar, with the corner of the bar. A map that no body has needs no bar.
fn shown(scene: &Scene) -> impl Iterator<Item = (usize, &ColorMap, Corner)> {
    let has_bodies = |number: usize| scene.bodies.iter().any(|body| scene.color_map_of(body) == Some(number));
    let maps = scene.color_maps.iter().enumerate();
    maps.filter(move |(number, _)| has_bodies(*number))
        .filter_map(|(number, map)| Some((number, map, map.bar?)))
}

/// Returns the height that the color bars need in corners that `is_here` accepts, if a line of text has this height.
pub(super) fn heights(scene: &Scene, line: f64, is_here: impl Fn(Corner) -> bool) -> f64 {
    shown(scene).filter(|(.., corner)| is_here(*corner)).map(|_| height() * line + GAP).sum()
}

/// Plans the color bars of a scene. `plots` are those that stand in the picture already.
pub(super) fn planned(
    scene: &Scene,
    survey: &Survey,
    plots: &[PlannedPlot],
    [ink, paper]: [Color; 2],
) -> Vec<PlannedPlot> {
    let mut bars: Vec<(Corner, PlannedPlot)> = Vec::new();
    for (number, map, corner) in shown(scene) {
        let before = bars.iter().filter(|(other, _)| *other == corner).map(|(_, bar)| bar.size[1] + GAP);
        let room = Room::of_color_bar(scene, corner, plots, before.sum());
        let range = survey.color_ranges.get(number).copied().unwrap_or([0.0, 1.0]);
        bars.push((corner, bar(scene, (map, corner), range, &room, [ink, paper])));
    }
    bars.into_iter().map(|(_, bar)| bar).collect()
}

/// Returns the axis with the most numbers that have room in this width, and the room that its numbers need beside the strip.
fn axis(range: &Range, wide: f64, line: f64) -> (Axis, f64) {
    let axes = MAX_INTERVALS.map(|count| {
        let axis = Axis::new(range, count);
        let ticks = axis.ticks();
        let widest = ticks.iter().map(|tick| width(&tick.says, line)).fold(line, f64::max);
        let between = ticks.windows(2).map(|pair| pair[1].at - pair[0].at).fold(1.0, f64::min);
        let is_legible = between * (wide - widest) > widest + BETWEEN_NUMBERS * line;
        (axis, widest / 2.0, is_legible)
    });
    let best = axes.iter().position(|(.., is_legible)| *is_legible).unwrap_or(MAX_INTERVALS.len() - 1);
    let (axis, beside, _) = &axes[best];
    (axis.clone(), *beside)
}

fn bar(
    scene: &Scene,
    (map, corner): (&ColorMap, Corner),
    span: [f64; 2],
    room: &Room,
    [ink, paper]: [Color; 2],
) -> PlannedPlot {
    let line = room.line;
    let pad = PANEL_PADDING * line;
    let wide = room.panel_width();
    let range = Range { span, is_wider: false, is_count: map.of.is_count };
    let (axis, beside) = axis(&range, wide - 2.0 * pad, line);
    let beside = pad + beside;
    let size = [wide, height() * line];
    let (left, bottom) = room.corner_of(PlotPlace::Corner(corner), size);
    let foot = pad + NUMBERS_ROW * line;
    let (begin, end) = (beside, wide - beside);
    // A quantity that keeps its value has the color in the middle.
    let strip = Strip {
        from: [begin, foot],
        to: [end, foot + STRIP_HEIGHT * line],
        colors: map.palette.colors(COLORS_OF_STRIP),
    };
    let text = |says: String, at: [f64; 2]| Text {
        name: "color bar",
        says: says.into(),
        x: left + at[0],
        y: bottom.raised(at[1]),
        height: line,
        align: 0.5,
        color: mixed(ink, paper, 0.1),
        typeface: Typeface::usual(),
        anchor: None,
    };
    let title = axis.named(&map.title, map.of.unit().unwrap_or_default());
    let title_at = [wide / 2.0, foot + (STRIP_HEIGHT + 0.5) * line];
    let mut texts = vec![text(cut(&title, wide - 2.0 * pad, line), title_at)];
    let mut lines = Vec::new();
    for tick in axis.ticks() {
        let x = begin + tick.at * (end - begin);
        texts.push(text(with_sign(tick.says, scene.output.decimal), [x, foot - 1.05 * line]));
        let color = mixed(ink, paper, 0.25);
        lines.push(PlotLine { from: [x, foot - MARK_LENGTH * line], to: [x, foot], color, is_axis: true });
    }
    PlannedPlot {
        name: map.title.clone(),
        left,
        bottom,
        size,
        paper,
        strip: Some(strip),
        lines,
        texts,
        curves: Vec::new(),
        dot: 0.0,
    }
}
