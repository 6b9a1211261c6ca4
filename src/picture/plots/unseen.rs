//! Finds plots and curves that no picture shows, or not as a whole.

use super::super::occupancy::Rectangle;
use super::ranges::span;
use super::{Plots, column};
use crate::decimal::decimal_step;
use crate::scene::{Measure, PlotKind, Scene, Subject};
use crate::simulate::{CurvePoint, LeftOut, Survey};

/// A plot without room in the picture, or a curve of which no picture shows a point. The numbers of plots and bodies are their indices in
/// the scene, those of curves their indices in the plot.
#[derive(Clone, Debug, PartialEq)]
pub enum UnseenPlot {
    /// A plot leaves the picture.
    Outside {
        /// The plot.
        plot: usize,
    },
    /// A plot covers another one.
    Covers {
        /// The plot.
        plot: usize,
        /// The plot that it covers. This one comes before it in the scene.
        other: usize,
        /// Whether the two stand side by side, and not above each other.
        is_beside: bool,
    },
    /// All values of a curve are outside of a range of its plot.
    OutOfRange {
        /// The axis with the range: 0 is the horizontal one, 1 the vertical one.
        axis: usize,
        /// The plot of the curve.
        plot: usize,
        /// The curve.
        curve: usize,
        /// The lowest and the highest value of the curve along this axis.
        values: [f64; 2],
        /// A range that contains these values and the given range.
        fit: [f64; 2],
    },
    /// A logarithmic axis has no place for some values of a curve.
    NotPositive {
        /// The plot of the curve.
        plot: usize,
        /// The curve.
        curve: usize,
        /// How many of its values are left out.
        left_out: LeftOut,
    },
    /// A body that a curve names is never there.
    NeverThere {
        /// The plot of the curve.
        plot: usize,
        /// The curve.
        curve: usize,
        /// The body.
        body: usize,
    },
    /// A curve has no finite value at any frame.
    Undefined {
        /// The plot of the curve.
        plot: usize,
        /// The curve.
        curve: usize,
    },
}

/// The largest part of a plot outside of the picture or over another plot that counts as a rounding error, in the image plane.
const MAX_ROUNDING: f64 = 1e-6;

impl Plots {
    /// Finds the plots and curves of a run that no picture shows.
    pub(in super::super) fn unseen(&self, scene: &Scene, survey: &Survey) -> Vec<UnseenPlot> {
        let areas: Vec<Rectangle> = self.areas().collect();
        let mut unseen = Vec::new();
        let mut points = survey.curves.iter().zip(&survey.left_out);
        let mut spreads = survey.spreads.iter();
        for (plot, planned) in self.planned.iter().take(self.plots.len()).enumerate() {
            unseen.extend(self.without_room(plot, &areas));
            for curve in 0..self.plots[plot].curves.len() {
                let Some((points, left_out)) = points.next() else { continue };
                if matches!(self.plots[plot].kind, PlotKind::Histogram { .. }) {
                    if spreads.next().is_some_and(|spread| spread.span.is_none()) {
                        unseen.push(UnseenPlot::Undefined { plot, curve });
                    }
                    continue;
                }
                if left_out.frames > 0 {
                    unseen.push(UnseenPlot::NotPositive { plot, curve, left_out: *left_out });
                    if left_out.frames == left_out.of {
                        continue;
                    }
                }
                let drawn = planned.curves.get(curve).map_or(&points[..], |drawn| &drawn.points);
                if drawn.iter().all(|point| point.at.is_none()) {
                    unseen.push(self.without_points(scene, [plot, curve], points));
                }
            }
        }
        unseen
    }

    /// Returns why a plot has no room. `None` if it has.
    fn without_room(&self, plot: usize, areas: &[Rectangle]) -> Option<UnseenPlot> {
        let area = areas[plot];
        let covered = areas[..plot].iter().position(|other| {
            let across = area.right.min(other.right) - area.left.max(other.left);
            let up = area.top.min(other.top) - area.bottom.max(other.bottom);
            across.min(up) > MAX_ROUNDING
        });
        let beyond = [area.right - 1.0, -1.0 - area.left, area.top - self.aspect, -self.aspect - area.bottom];
        if beyond.into_iter().any(|beyond| beyond > MAX_ROUNDING) {
            return Some(UnseenPlot::Outside { plot });
        }
        let column = |plot: usize| column(self.plots[plot].place);
        covered.map(|other| UnseenPlot::Covers { plot, other, is_beside: column(plot) != column(other) })
    }

    /// Returns why no picture shows a point of a curve. `points` are those of the run.
    fn without_points(&self, scene: &Scene, [plot, curve]: [usize; 2], points: &[CurvePoint]) -> UnseenPlot {
        let of_plot = &self.plots[plot];
        // The axis on which the values are outside comes first. A curve can also pass a corner of its plot.
        let ranges = [of_plot.x_range, of_plot.range];
        let of_axis = |axis: usize| Some((axis, span(&[points], axis)?, ranges[axis]?));
        let is_outside =
            |(_, values, range): &(usize, [f64; 2], [f64; 2])| values[1] < range[0] || values[0] > range[1];
        let given = || [1, 0].into_iter().filter_map(of_axis);
        if let Some((axis, values, range)) = given().find(is_outside).or_else(|| given().next()) {
            let (low, high) = (values[0].min(range[0]), values[1].max(range[1]));
            let step = decimal_step(high - low) / 10.0;
            let fit = [libm::floor(low / step + 1e-9) * step, libm::ceil(high / step - 1e-9) * step];
            return UnseenPlot::OutOfRange { axis, plot, curve, values, fit };
        }
        let inputs = of_plot.x.inputs.iter().chain(&of_plot.curves[curve].y.inputs);
        let end = scene.simulation.timeline.end();
        let never = inputs.into_iter().find_map(|measure| match measure {
            Measure::Body(Subject::One(body), _) if !scene.bodies[*body].presence.overlaps(0.0, end) => {
                Some(*body)
            }
            _ => None,
        });
        match never {
            Some(body) => UnseenPlot::NeverThere { plot, curve, body },
            None => UnseenPlot::Undefined { plot, curve },
        }
    }
}
