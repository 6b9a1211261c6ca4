//! Plots: curves of measures, on a panel in a corner of the picture.
//!
//! A plot is planned once for a run: its panel, axes, numbers, legend and curves lie in the image plane, where the picture has a width of 2.
//! Of a curve, a frame shows the points up to its time, and a dot at its own values.

mod axis;
mod clip;
mod panel;

use self::axis::{Axis, Range};
use self::clip::{clipped, simplified};
use self::panel::{Legend, Panel};
use super::colors::{ink, seen};
use super::framing::Free;
use super::grid;
use super::labels;
use super::occupancy::Rectangle;
use super::text::{MARGIN, Text, Vertical, least_height};
use crate::scene::{Color, Corner, Measure, MeasureFormula, Output, Plot, PlotPlace, RunMeasure, Scene};
use crate::simulate::{CurvePoint, Frame, Measures, MomentState, Survey};

/// The height of a line of text, relative to the height of the picture.
const SIZE: f64 = 0.036;
/// The smallest height of a line of text, pixels.
const LEAST_PIXELS: f64 = 10.5;

/// The width of a plot, as a fraction of the picture's width.
fn width(plot: &Plot, output: Output) -> f64 {
    /// The usual width.
    const USUAL: f64 = 0.36;
    /// The smallest usual width, pixels: smaller plots cannot be read.
    const LEAST: f64 = 140.0;
    let most = if matches!(plot.place, PlotPlace::Corner(_)) { 0.5 } else { Plot::MAX_WIDTH_AT_SIDE };
    plot.width.unwrap_or_else(|| (LEAST / f64::from(output.width)).clamp(USUAL, most))
}

/// The part of the picture's width that plots at its sides leave free.
pub(super) fn free(scene: &Scene) -> Free {
    let taken = |place: PlotPlace| {
        let plots = scene.plots.iter().filter(|plot| plot.place == place);
        let widths = plots.map(|plot| width(plot, scene.output) + MARGIN / 2.0);
        widths.fold(0.0, f64::max).min(0.44)
    };
    let [left, right] = [PlotPlace::Left, PlotPlace::Right].map(taken);
    // Two wide plots leave a fifth of the picture.
    let scale = 1.0_f64.min(0.8 / (left + right).max(1e-9));
    Free { center: (left - right) * scale, half: 1.0 - (left + right) * scale }
}

/// A plot, as it is drawn. Positions are in the image plane, relative to the lower left corner of the panel, unless noted otherwise.
#[derive(Clone, Debug)]
pub struct PlannedPlot {
    /// The name of the plot.
    pub name: String,
    /// The position of the panel's left edge in the image plane.
    pub left: f64,
    /// The position of the panel's lower edge in the image plane.
    pub bottom: Vertical,
    /// The width and the height of the panel.
    pub size: [f64; 2],
    /// The color of the panel.
    pub paper: Color,
    /// The lines of the grid and of the axes.
    pub lines: Vec<PlotLine>,
    /// The title, the legend and the numbers, in positions of the image plane.
    pub texts: Vec<Text<'static>>,
    /// The curves.
    pub curves: Vec<PlannedCurve>,
    /// The radius of the dots at the present values.
    pub dot: f64,
}

/// A straight line of a plot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlotLine {
    /// The first end.
    pub from: [f64; 2],
    /// The other end.
    pub to: [f64; 2],
    /// The color of the line.
    pub color: Color,
    /// True for an axis, which is drawn over the lines of the grid.
    pub is_axis: bool,
}

/// A curve of a plot.
#[derive(Clone, Debug)]
pub struct PlannedCurve {
    /// The color of the curve.
    pub color: Color,
    /// The color of the part that is still ahead. `None` if this part is not drawn.
    pub pale: Option<Color>,
    /// The points of the curve in order of time, with the times in s. `None` is a gap.
    pub points: Vec<CurvePoint>,
}

/// What a frame shows of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveNow {
    /// The number of points up to the time of the frame.
    pub count: usize,
    /// The position of the frame's own values. `None` if they are outside of the plot, or not finite.
    pub here: Option<[f64; 2]>,
}

/// The plots of a scene.
#[derive(Clone, Debug)]
pub(super) struct Plots {
    planned: Vec<PlannedPlot>,
    plots: Vec<Plot>,
    /// The axes of each plot, and the rectangle that they span in its panel.
    axes: Vec<(Axes, Rectangle)>,
    measures: Measures,
    aspect: f64,
}

/// The horizontal and the vertical axis of a plot.
type Axes = [Axis; 2];

impl Plots {
    /// Plans the plots of a run. `taken` are the parts of the picture where none can stand; the plots are added to it.
    pub(super) fn new(scene: &Scene, survey: &Survey) -> Plots {
        let aspect = f64::from(scene.output.height) / f64::from(scene.output.width);
        let line = (SIZE * 2.0 * aspect).max(least_height(LEAST_PIXELS, scene.output));
        let around = Surroundings {
            free: free(scene),
            widest: 0.0,
            width: 0.0,
            line,
            aspect,
            used: 0.0,
            count: 1,
            column: 1,
            others: 0.0,
            dark: scene.environment.is_dark(),
        };
        let mut points = survey.curves.iter();
        let mut plots = Plots {
            planned: Vec::new(),
            plots: scene.plots.clone(),
            axes: Vec::new(),
            measures: Measures::new(scene),
            aspect,
        };
        for plot in &scene.plots {
            let curves: Vec<&[CurvePoint]> =
                points.by_ref().take(plot.curves.len()).map(Vec::as_slice).collect();
            let used = plots.used(scene, plot);
            let here = || scene.plots.iter().filter(|other| other.place == plot.place);
            let widest = here().map(|other| width(other, scene.output)).fold(0.0, f64::max);
            let count = here().count();
            let is_in_column = |other: &&Plot| column(other.place) == column(plot.place);
            let column = scene.plots.iter().filter(is_in_column).count();
            let others = others(scene, plot.place, aspect);
            let (planned, axes) = plan(
                scene,
                plot,
                &curves,
                Surroundings {
                    widest,
                    width: width(plot, scene.output),
                    used,
                    count,
                    column,
                    others,
                    ..around
                },
            );
            plots.planned.push(planned);
            plots.axes.push(axes);
        }
        plots
    }

    /// The height that a scale bar and other plots already use in the place of a plot.
    fn used(&self, scene: &Scene, plot: &Plot) -> f64 {
        let bar = scene.scale_bar.filter(|bar| PlotPlace::Corner(bar.corner) == plot.place);
        let bar = bar.map_or(0.0, |_| 4.0 * self.aspect * grid::SIZE);
        let others = self.plots.iter().zip(&self.planned).filter(|(other, _)| other.place == plot.place);
        bar + others.map(|(_, planned)| planned.size[1] + panel::GAP).sum::<f64>()
    }

    pub(super) fn planned(&self) -> &[PlannedPlot] {
        &self.planned
    }

    /// The rectangles of the panels in the image plane.
    pub(super) fn areas(&self) -> impl Iterator<Item = Rectangle> {
        self.planned.iter().map(|plot| {
            let bottom = plot.bottom.above_middle(self.aspect);
            Rectangle { left: plot.left, right: plot.left + plot.size[0], bottom, top: bottom + plot.size[1] }
        })
    }

    /// What a frame shows of the curves of each plot.
    pub(super) fn at(&self, frame: &Frame) -> Vec<Vec<CurveNow>> {
        let moment = MomentState::now(frame);
        let mut now = Vec::with_capacity(self.plots.len());
        for ((plot, planned), (axes, area)) in self.plots.iter().zip(&self.planned).zip(&self.axes) {
            let x = self.measures.value(&plot.x, &moment);
            let curve = |(curve, drawn): (&crate::scene::Curve, &PlannedCurve)| {
                let y = self.measures.value(&curve.y, &moment);
                let [across, up] = [axes[0].place(x), axes[1].place(y)];
                let is_inside = [across, up].iter().all(|part| (-1e-9..=1.0 + 1e-9).contains(part));
                CurveNow {
                    count: drawn.points.partition_point(|point| point.time <= frame.time * (1.0 + 1e-12)),
                    here: is_inside.then(|| inside(area, [across, up])),
                }
            };
            now.push(plot.curves.iter().zip(&planned.curves).map(curve).collect());
        }
        now
    }
}

/// Plans a plot of a scene as a picture of its own, for paper: with dark letters on white, and curves over the whole run. `number` is its
/// index in the scene.
pub(crate) fn plot_alone(scene: &Scene, survey: &Survey, number: usize) -> PlannedPlot {
    /// The height of a line of text, relative to half the width of the drawing.
    const LINE: f64 = 0.04;
    let before: usize = scene.plots[..number].iter().map(|plot| plot.curves.len()).sum();
    let plot = Plot { place: PlotPlace::Corner(Corner::Top), ..scene.plots[number].clone() };
    let curves: Vec<&[CurvePoint]> =
        survey.curves.iter().skip(before).take(plot.curves.len()).map(Vec::as_slice).collect();
    plan(
        scene,
        &plot,
        &curves,
        Surroundings {
            free: Free::ALL,
            widest: 1.0,
            width: 1.0,
            line: LINE,
            aspect: 1.0,
            used: 0.0,
            count: 1,
            column: 1,
            others: 0.0,
            dark: false,
        },
    )
    .0
}

/// The picture that a plot stands in.
#[derive(Clone, Copy)]
struct Surroundings {
    /// The part of the picture that plots at its sides leave free.
    free: Free,
    /// The largest width of the plots in its place, as a fraction of the picture's width.
    widest: f64,
    /// The width of the plot, as a fraction of the picture's width.
    width: f64,
    /// The height of a line of text in the image plane.
    line: f64,
    /// The height of the picture, relative to its width.
    aspect: f64,
    /// The height that other plots before it use in its place.
    used: f64,
    /// The number of plots in its place, itself included.
    count: usize,
    /// The number of plots in its column of the picture: at the left, in the middle, or at the right.
    column: usize,
    /// The height of the labels and the scale bar in the corners of this column.
    others: f64,
    /// Whether the background is dark.
    dark: bool,
}

/// Plans a plot, given the points of its curves.
fn plan(
    scene: &Scene,
    plot: &Plot,
    curves: &[&[CurvePoint]],
    around: Surroundings,
) -> (PlannedPlot, (Axes, Rectangle)) {
    let Surroundings { line, dark, .. } = around;
    let (ink, paper) =
        (ink(dark), if dark { Color([0.10, 0.11, 0.13]) } else { Color([0.985, 0.985, 0.98]) });
    let colors = colors(scene, plot, dark);
    let names: Vec<(&str, Color)> =
        plot.curves.iter().zip(&colors).map(|(curve, color)| (curve.name.as_str(), *color)).collect();
    let x_unit = plot.x.unit().unwrap_or_default();
    let legend = Legend {
        title: plot.title.as_deref(),
        names: &names,
        x_name: &plot.x_name,
        units: [x_unit, unit(plot)],
        sign: scene.output.decimal,
    };
    let is_time = plot.x.single == Some(Measure::Run(RunMeasure::Time));
    let is_count = |formula: &MeasureFormula| formula.single.is_some_and(Measure::is_count);
    let level = Range {
        // The whole run, even if the curves begin later or end earlier.
        span: if is_time {
            [0.0, scene.simulation.timeline.end()]
        } else {
            span(curves, 0).unwrap_or([0.0, 1.0])
        },
        is_wider: !is_time,
        is_count: is_count(&plot.x),
    };
    let upright = Range {
        span: plot.range.or_else(|| span(curves, 1)).unwrap_or([0.0, 1.0]),
        is_wider: plot.range.is_none(),
        is_count: plot.curves.iter().all(|curve| is_count(&curve.y)),
    };
    let (panel, axes) = Panel::new(plot, &legend, &[level, upright], around);
    let area = panel.area;
    let place = |at: [f64; 2]| [axes[0].place(at[0]), axes[1].place(at[1])];
    let planned_curves = curves.iter().zip(&colors).map(|(points, color)| PlannedCurve {
        color: *color,
        pale: plot.ahead.then(|| mixed(*color, paper, 0.7)),
        points: simplified(clipped(points, place, |part| inside(&area, part))),
    });
    let planned = PlannedPlot {
        name: plot.name.clone(),
        left: panel.left,
        bottom: panel.bottom,
        size: panel.size,
        paper,
        lines: panel.lines(&axes, mixed(ink, paper, 0.82), mixed(ink, paper, 0.25)),
        texts: panel.texts(&axes, &legend, mixed(ink, paper, 0.1)),
        curves: planned_curves.collect(),
        dot: 0.17 * line,
    };
    (planned, (axes, area))
}

/// The column of the picture that a plot stands in, from the left side to the right side. A plot in a corner stands beside those at a side.
fn column(place: PlotPlace) -> i8 {
    match place {
        PlotPlace::Left => -2,
        PlotPlace::Corner(Corner::TopLeft | Corner::BottomLeft) => -1,
        PlotPlace::Corner(Corner::Top | Corner::Bottom) => 0,
        PlotPlace::Right => 2,
        PlotPlace::Corner(Corner::TopRight | Corner::BottomRight) => 1,
    }
}

/// The height of the labels and the scale bar that stand in the same column as a plot in a corner. Beside plots at a side, they have the
/// rest of the picture.
fn others(scene: &Scene, place: PlotPlace, aspect: f64) -> f64 {
    if !matches!(place, PlotPlace::Corner(_)) {
        return 0.0;
    }
    let is_here = |corner: Corner| column(PlotPlace::Corner(corner)) == column(place);
    let bar = scene.scale_bar.filter(|bar| is_here(bar.corner)).map_or(0.0, |_| 4.0 * aspect * grid::SIZE);
    bar + labels::least_room(scene, is_here)
}

/// The position in a panel of a point in its plot, which is given from 0 to 1.
fn inside(area: &Rectangle, [across, up]: [f64; 2]) -> [f64; 2] {
    [area.left + across * (area.right - area.left), area.bottom + up * (area.top - area.bottom)]
}

/// The lowest and the highest value of a measure in all curves. `None` if there are none.
fn span(curves: &[&[CurvePoint]], measure: usize) -> Option<[f64; 2]> {
    let values = curves.iter().copied().flatten().filter_map(|point| Some(point.at?[measure]));
    values.fold(None, |span: Option<[f64; 2]>, value| {
        let [low, high] = span.unwrap_or([value; 2]);
        Some([low.min(value), high.max(value)])
    })
}

/// The unit of all curves. Empty if they differ, or are formulas.
fn unit(plot: &Plot) -> &'static str {
    let mut units = plot.curves.iter().map(|curve| curve.y.unit());
    let first = units.next().flatten();
    first.filter(|first| units.all(|unit| unit == Some(first))).unwrap_or_default()
}

/// The colors of the curves: that of the only body in a formula, or else one of a palette whose colors can be told apart.
fn colors(scene: &Scene, plot: &Plot, dark: bool) -> Vec<Color> {
    /// The colors of Okabe and Ito, which people with any color vision can tell apart, with a gray and a brown for the black and the yellow.
    const PALETTE: [Color; Plot::MAX_CURVES] = [
        Color([0.0, 0.447, 0.698]),
        Color([0.835, 0.369, 0.0]),
        Color([0.0, 0.62, 0.451]),
        Color([0.8, 0.475, 0.655]),
        Color([0.337, 0.706, 0.914]),
        Color([0.902, 0.624, 0.0]),
        Color([0.35, 0.35, 0.38]),
        Color([0.55, 0.34, 0.16]),
    ];
    let mut free = PALETTE.into_iter().cycle();
    let mut colors: Vec<Color> = Vec::new();
    for curve in &plot.curves {
        let material = curve.y.body().and_then(|body| scene.bodies[body].material);
        let own = material.and_then(|material| scene.materials[material].look.color());
        let own = own.map(|color| seen(color, dark)).filter(|own| {
            let is_legible = dark || own.linear().iter().sum::<f64>() < 1.5;
            is_legible && colors.iter().all(|other| difference(*own, *other) > 0.3)
        });
        let color = own.or_else(|| {
            let mut palette = free
                .by_ref()
                .take(PALETTE.len())
                .map(|color| if dark { mixed(color, Color::WHITE, 0.25) } else { color });
            palette.find(|color| colors.iter().all(|other| difference(*color, *other) > 0.1))
        });
        colors.push(color.unwrap_or(PALETTE[0]));
    }
    colors
}

/// The distance of two colors in sRGB.
fn difference(one: Color, other: Color) -> f64 {
    (glam::DVec3::from_array(one.0) - glam::DVec3::from_array(other.0)).length()
}

/// Mixes a part of a second color into a color.
fn mixed(color: Color, other: Color, part: f64) -> Color {
    Color(std::array::from_fn(|k| color.0[k] + part * (other.0[k] - color.0[k])))
}
