//! Collects the values of the bodies in histograms, in bounded memory.

use crate::scene::{PlotKind, Scene};
use crate::simulate::{Measures, MomentState};

/// The largest number of values that a histogram keeps. A run with more values keeps those of evenly chosen frames.
const MAX_VALUES: usize = 2_000_000;

/// The values of the bodies in a histogram.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spread {
    /// The lowest and the highest value at any frame. `None` if there are no values.
    pub span: Option<[f64; 2]>,
    /// The values at all frames of a short run, and at evenly chosen frames of a long one. The last frame is always among them. Absent bodies
    /// and values that are not finite are left out.
    pub frames: Vec<Vec<f64>>,
}

/// Collects the values of all histograms of a scene.
pub(super) struct Spreads<'a> {
    scene: &'a Scene,
    spreads: Vec<Spread>,
}

impl<'a> Spreads<'a> {
    pub(super) fn new(scene: &'a Scene) -> Spreads<'a> {
        let is_histogram = |kind: &PlotKind| matches!(kind, PlotKind::Histogram { .. });
        let count = scene.plots.iter().filter(|plot| is_histogram(&plot.kind)).count();
        Spreads { scene, spreads: vec![Spread::default(); count] }
    }

    /// Adds the values of the next frame. `measures` are those of the scene.
    pub(super) fn see(&mut self, moment: &MomentState<'_>, measures: &Measures, frame: usize) {
        let frames = self.scene.simulation.timeline.frames();
        let mut spreads = self.spreads.iter_mut();
        for plot in &self.scene.plots {
            let PlotKind::Histogram { bodies, .. } = &plot.kind else { continue };
            let (Some(spread), Some(curve)) = (spreads.next(), plot.curves.first()) else { continue };
            let mut values: Vec<f64> = measures.of_present(&curve.y, bodies, moment).collect();
            values.retain(|value| value.is_finite());
            spread.add(values, frame, frames.saturating_mul(bodies.len()).div_ceil(MAX_VALUES).max(1));
        }
    }

    /// Returns the values of each histogram, in the order of the scene.
    pub(super) fn finish(self) -> Vec<Spread> {
        self.spreads
    }
}

impl Spread {
    /// Adds the values of the next frame. Of the frames, every `stride`-th is kept, and the last one.
    fn add(&mut self, values: Vec<f64>, frame: usize, stride: usize) {
        for value in &values {
            let [low, high] = self.span.unwrap_or([*value; 2]);
            self.span = Some([low.min(*value), high.max(*value)]);
        }
        // The frame before is only kept if it is one of the chosen ones.
        if frame > 0 && !(frame - 1).is_multiple_of(stride) {
            self.frames.pop();
        }
        self.frames.push(values);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_run_keeps_every_nth_frame_and_the_last_one() {
        let mut spread = Spread::default();
        for frame in 0..24_u32 {
            spread.add(vec![f64::from(frame)], frame as usize, 10);
        }
        assert_eq!(spread.frames, [[0.0], [10.0], [20.0], [23.0]]);
        assert_eq!(spread.span, Some([0.0, 23.0]));
    }
}
