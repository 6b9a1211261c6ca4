//! Plots: curves, bars and histograms of measures, on a panel in a corner of the picture.
//!
//! A plot is planned once for a run: its panel, axes, numbers, legend and curves lie in the image plane, where the picture has a width of 2.
//! Of a curve, a frame shows the points up to its time, and a dot at its own values.

mod axis;
mod bars;
mod clip;
mod color_bar;
mod colors;
mod decades;
mod ends;
mod panel;
mod ranges;
mod room;
mod unseen;

use std::sync::Arc;

use self::axis::Axis;
use self::clip::{clipped, simplified};
use self::colors::mixed;
use self::panel::{Legend, Panel};
use self::ranges::{Values, scales};
use self::room::{Room, column};
use super::colors::ink;
use super::occupancy::Rectangle;
use super::text::{Text, Vertical};
use crate::scene::{Color, Corner, Plot, PlotKind, PlotPlace, Scene};
use crate::simulate::{CurvePoint, Frame, Measures, MomentState, Survey};

pub use self::bars::PlotBar;
pub(super) use self::room::free;
pub use self::unseen::UnseenPlot;

/// The height of a line of text in a picture of a plot alone, where the picture has a width of 2.
const LINE_ALONE: f64 = 0.04;
/// The radius of the dots at the present values, relative to the height of a line of text.
const DOT_RADIUS: f64 = 0.17;

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
    /// The strip of colors, for a color bar.
    pub strip: Option<Strip>,
    /// The lines of the grid and of the axes.
    pub lines: Vec<PlotLine>,
    /// The title, the legend and the numbers, in positions of the image plane.
    pub texts: Vec<Text<'static>>,
    /// The curves. Empty if the plot draws bars.
    pub curves: Vec<PlannedCurve>,
    /// The radius of the dots at the present values.
    pub dot: f64,
}

/// The strip of a color bar: a rectangle with the colors of a map from left to right.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// The lower left corner.
    pub from: [f64; 2],
    /// The upper right corner.
    pub to: [f64; 2],
    /// Colors at equal distances, from the left edge to the right one.
    pub colors: Vec<Color>,
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

/// What a frame shows of a plot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlotNow {
    /// What it shows of each curve.
    pub curves: Vec<CurveNow>,
    /// The bars.
    pub bars: Vec<PlotBar>,
}

/// The plots of a scene.
#[derive(Clone, Debug)]
pub(super) struct Plots {
    /// The plots in the order of the scene, then the color bars.
    planned: Vec<PlannedPlot>,
    plots: Vec<Plot>,
    /// The axes of each plot, and the rectangle that they span in its panel.
    axes: Vec<(Axes, Rectangle)>,
    /// The color of each curve or bar of each plot.
    colors: Vec<Vec<Color>>,
    measures: Arc<Measures>,
    aspect: f64,
}

/// The horizontal and the vertical axis of a plot.
type Axes = [Axis; 2];

impl Plots {
    /// Plans the plots of a run. `measures` are those of its scene.
    pub(super) fn new(scene: &Scene, survey: &Survey, measures: Arc<Measures>) -> Plots {
        let aspect = f64::from(scene.output.height) / f64::from(scene.output.width);
        let mut plots = Plots {
            planned: Vec::new(),
            plots: scene.plots.clone(),
            axes: Vec::new(),
            colors: Vec::new(),
            measures,
            aspect,
        };
        for (plot, values) in scene.plots.iter().zip(Values::of_plots(scene, survey)) {
            let room = Room::in_picture(scene, plot, &plots.planned);
            let dark = scene.environment.is_dark();
            let colors = colors::of_curves(scene, plot, dark);
            let (planned, axes) = plan(scene, plot, (&values, &colors), &room, dark);
            plots.planned.push(planned);
            plots.axes.push(axes);
            plots.colors.push(colors);
        }
        let bars =
            color_bar::planned(scene, survey, &plots.planned, ink_and_paper(scene.environment.is_dark()));
        plots.planned.extend(bars);
        plots
    }

    pub(super) fn planned(&self) -> &[PlannedPlot] {
        &self.planned
    }

    /// The rectangles of the panels in the image plane, in the order of `planned`.
    pub(super) fn areas(&self) -> impl Iterator<Item = Rectangle> {
        self.planned.iter().map(|plot| {
            let bottom = plot.bottom.above_middle(self.aspect);
            Rectangle { left: plot.left, right: plot.left + plot.size[0], bottom, top: bottom + plot.size[1] }
        })
    }

    /// What a frame shows of each plot.
    pub(super) fn at(&self, frame: &Frame) -> Vec<PlotNow> {
        let moment = MomentState::now(frame);
        let mut now = Vec::with_capacity(self.plots.len());
        let plots = self.plots.iter().zip(&self.planned).zip(&self.axes).zip(&self.colors);
        for (((plot, planned), (axes, area)), colors) in plots {
            let values: Vec<f64> = match &plot.kind {
                PlotKind::Curves => Vec::new(),
                PlotKind::Bars { .. } => {
                    plot.curves.iter().map(|bar| self.measures.value(&bar.y, &moment)).collect()
                }
                PlotKind::Histogram { bodies, .. } => plot.curves.first().map_or(Vec::new(), |curve| {
                    self.measures.of_present(&curve.y, bodies, &moment).collect()
                }),
            };
            let bars = drawn_bars(&plot.kind, &values, colors, (axes, area));
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
            let curves = plot.curves.iter().zip(&planned.curves).map(curve).collect();
            now.push(PlotNow { curves, bars });
        }
        // Color bars have no curves.
        now.resize(self.planned.len(), PlotNow::default());
        now
    }
}

/// Plans a plot of a scene as a picture of its own, for paper: with dark letters on white, with curves over the whole run, and bars of its last
/// moment. `number` is its index in the scene.
pub(crate) fn plot_alone(scene: &Scene, survey: &Survey, number: usize) -> (PlannedPlot, Vec<PlotBar>) {
    let plot = Plot { place: PlotPlace::Corner(Corner::Top), ..scene.plots[number].clone() };
    let values = &Values::of_plots(scene, survey)[number];
    let colors = colors::of_curves(scene, &plot, false);
    let (planned, (axes, area)) = plan(scene, &plot, (values, &colors), &Room::alone(LINE_ALONE), false);
    let last: Vec<f64> = match values.spread {
        Some(spread) => spread.frames.last().cloned().unwrap_or_default(),
        None => {
            let last = values.curves.iter().map(|points| points.last().and_then(|last| last.at));
            last.map(|at| at.map_or(f64::NAN, |at| at[1])).collect()
        }
    };
    (planned, drawn_bars(&plot.kind, &last, &colors, (&axes, &area)))
}

/// Returns the bars of a plot at a moment, given its values then: one for each bar, or one for each body of a histogram.
fn drawn_bars(
    kind: &PlotKind,
    values: &[f64],
    colors: &[Color],
    (axes, area): (&Axes, &Rectangle),
) -> Vec<PlotBar> {
    match (kind, colors) {
        (PlotKind::Curves, _) | (PlotKind::Histogram { .. }, []) => Vec::new(),
        (PlotKind::Bars { .. }, colors) => {
            bars::beside_each_other(values.iter().copied().zip(colors.iter().copied()), axes, area)
        }
        (PlotKind::Histogram { bins, .. }, [color, ..]) => {
            bars::of_counts(&bars::counts(values, &axes[0], *bins), *color, axes, area)
        }
    }
}

/// Plans a plot, given its values and the colors of its curves or bars. `dark` says whether the background of the picture is dark.
fn plan(
    scene: &Scene,
    plot: &Plot,
    (values, colors): (&Values<'_>, &[Color]),
    room: &Room,
    dark: bool,
) -> (PlannedPlot, (Axes, Rectangle)) {
    let [ink, paper] = ink_and_paper(dark);
    let names: Vec<(&str, Color)> =
        plot.curves.iter().zip(colors).map(|(curve, color)| (curve.name.as_str(), *color)).collect();
    let units = match plot.kind {
        PlotKind::Curves => [plot.x.unit().unwrap_or_default(), unit(plot)],
        PlotKind::Bars { .. } => ["", unit(plot)],
        PlotKind::Histogram { .. } => [unit(plot), ""],
    };
    let is_bars = matches!(plot.kind, PlotKind::Bars { .. });
    let legend = Legend {
        title: plot.title.as_deref(),
        names: if is_bars { &[] } else { &names },
        at_ends: plot.has_names_at_ends,
        below: if is_bars { &names } else { &[] },
        x_name: if is_bars { "" } else { &plot.x_name },
        units,
        sign: scene.output.decimal,
    };
    let scales = scales(scene, plot, values);
    let drawn = |(panel, axes): &(Panel, Axes)| -> Vec<PlannedCurve> {
        let place = |at: [f64; 2]| [axes[0].place(at[0]), axes[1].place(at[1])];
        let drawn: &[_] = if plot.kind == PlotKind::Curves { &values.curves } else { &[] };
        let curve = |(points, color): (&&[CurvePoint], &Color)| PlannedCurve {
            color: *color,
            pale: plot.ahead.then(|| mixed(*color, paper, 0.7)),
            points: simplified(clipped(points, place, |part| inside(&panel.area, part))),
        };
        drawn.iter().zip(colors).map(curve).collect()
    };
    let mut laid_out = Panel::new(plot, &legend, &scales, room);
    let mut curves = drawn(&laid_out);
    let names_at_ends = match legend.at_ends {
        true => ends::heights(&curves, &laid_out.0.area)
            .and_then(|heights| laid_out.0.names_at_ends(&names, &heights)),
        false => Some(Vec::new()),
    };
    // Names without room at the ends of the curves stand above the plot.
    let legend = Legend { at_ends: legend.at_ends && names_at_ends.is_some(), ..legend };
    if names_at_ends.is_none() {
        laid_out = Panel::new(plot, &legend, &scales, room);
        curves = drawn(&laid_out);
    }
    let (panel, axes) = laid_out;
    let mut texts = panel.texts(&axes, &legend, mixed(ink, paper, 0.1));
    texts.extend(names_at_ends.into_iter().flatten());
    let planned = PlannedPlot {
        name: plot.name.clone(),
        left: panel.left,
        bottom: panel.bottom,
        size: panel.size,
        paper,
        strip: None,
        lines: panel.lines(&axes, [0.92, 0.82, 0.25].map(|part| mixed(ink, paper, part))),
        texts,
        curves,
        dot: DOT_RADIUS * room.line,
    };
    let area = panel.area;
    (planned, (axes, area))
}

/// The colors of letters and of the panel, on a `dark` or light background.
fn ink_and_paper(dark: bool) -> [Color; 2] {
    [ink(dark), if dark { Color([0.10, 0.11, 0.13]) } else { Color([0.985, 0.985, 0.98]) }]
}

/// The position in a panel of a point in its plot, which is given from 0 to 1.
fn inside(area: &Rectangle, [across, up]: [f64; 2]) -> [f64; 2] {
    [area.left + across * (area.right - area.left), area.bottom + up * (area.top - area.bottom)]
}

/// The unit of all curves. Empty if they differ, or are formulas.
fn unit(plot: &Plot) -> &str {
    let mut units = plot.curves.iter().map(|curve| curve.y.unit());
    let first = units.next().flatten();
    first.filter(|first| units.all(|unit| unit == Some(first))).unwrap_or_default()
}
