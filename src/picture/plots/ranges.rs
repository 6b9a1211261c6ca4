//! What the axes of plots must show, from the values of the whole run.

use super::axis::{Axis, AxisScale, Range};
use super::bars;
use crate::scene::{Plot, PlotKind, Scene};
use crate::simulate::{CurvePoint, Spread, Survey};

/// The ends of a linear axis without values, and those of a logarithmic one.
const SPANS_OF_UNKNOWN_VALUES: [[f64; 2]; 2] = [[0.0, 1.0], [0.1, 1.0]];

/// The values of a plot in the whole run.
#[derive(Clone, Debug)]
pub(super) struct Values<'a> {
    /// The points of each curve or bar.
    pub(super) curves: Vec<&'a [CurvePoint]>,
    /// The values of the bodies in a histogram. `None` for another plot.
    pub(super) spread: Option<&'a Spread>,
}

impl<'a> Values<'a> {
    /// Returns the values of each plot of a scene.
    pub(super) fn of_plots(scene: &Scene, survey: &'a Survey) -> Vec<Values<'a>> {
        let (mut points, mut spreads) = (survey.curves.iter(), survey.spreads.iter());
        let values = |plot: &Plot| Values {
            curves: points.by_ref().take(plot.curves.len()).map(Vec::as_slice).collect(),
            spread: match plot.kind {
                PlotKind::Histogram { .. } => spreads.next(),
                PlotKind::Curves | PlotKind::Bars { .. } => None,
            },
        };
        scene.plots.iter().map(values).collect()
    }

    /// The lowest and the highest value of a measure in all curves. `None` if there are none.
    fn span(&self, measure: usize) -> Option<[f64; 2]> {
        span(&self.curves, measure)
    }
}

/// Returns what the horizontal and the vertical axis of a plot must show.
pub(super) fn scales(scene: &Scene, plot: &Plot, values: &Values<'_>) -> [AxisScale; 2] {
    let unknown = |axis: usize| SPANS_OF_UNKNOWN_VALUES[usize::from(plot.is_logarithmic[axis])];
    let scale = |axis: usize, range: Range| match plot.is_logarithmic[axis] {
        true => AxisScale::Logarithmic(range),
        false => AxisScale::Linear(range),
    };
    let is_count = plot.curves.iter().all(|curve| curve.y.is_count);
    let upright = |of_values: Option<[f64; 2]>, is_count: bool| Range {
        span: plot.range.or(of_values).unwrap_or(unknown(1)),
        is_wider: plot.range.is_none(),
        is_count,
    };
    match &plot.kind {
        PlotKind::Curves => {
            let end = scene.simulation.timeline.end() / plot.x.unit_size();
            let level = Range {
                // The whole run, even if the curves begin later or end earlier.
                span: plot.x_range.unwrap_or_else(|| match (plot.is_over_time(), plot.is_logarithmic[0]) {
                    (true, false) => [0.0, end],
                    // The first frame is at time 0, which has no place.
                    (true, true) => [values.span(0).map_or(end / 10.0, |[begin, _]| begin), end],
                    (false, _) => values.span(0).unwrap_or(unknown(0)),
                }),
                is_wider: plot.x_range.is_none() && !plot.is_over_time(),
                is_count: plot.x.is_count,
            };
            [scale(0, level), scale(1, upright(values.span(1), is_count))]
        }
        PlotKind::Bars { .. } => {
            let with_zero = values.span(1).map(|[low, high]| [low.min(0.0), high.max(0.0)]);
            let names = u8::try_from(plot.curves.len()).unwrap_or(u8::MAX);
            [AxisScale::Names(names), scale(1, upright(with_zero, is_count))]
        }
        PlotKind::Histogram { bins, .. } => {
            let spread = values.spread.filter(|spread| spread.span.is_some());
            let span = plot.x_range.or(spread.and_then(|spread| spread.span)).unwrap_or(unknown(0));
            // The bins end at the lowest and the highest value, which are seldom whole.
            let level = Range { span, is_wider: false, is_count: false };
            let axis = Axis::new(&level, 1.0);
            let counts = spread.iter().flat_map(|spread| &spread.frames);
            let counts = counts.flat_map(|values| bars::counts(values, &axis, *bins));
            let most = counts.fold(1.0, f64::max);
            [AxisScale::Linear(level), scale(1, upright(Some([0.0, most]), true))]
        }
    }
}

/// The lowest and the highest value of a measure in several curves. `None` if there are none.
pub(super) fn span(curves: &[&[CurvePoint]], measure: usize) -> Option<[f64; 2]> {
    let values = curves.iter().copied().flatten().filter_map(|point| Some(point.at?[measure]));
    values.fold(None, |span: Option<[f64; 2]>, value| {
        let [low, high] = span.unwrap_or([value; 2]);
        Some([low.min(value), high.max(value)])
    })
}
