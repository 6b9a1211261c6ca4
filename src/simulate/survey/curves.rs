//! Collects the points of the curves in plots, in bounded memory.
//!
//! The frames of a long run are divided into equal groups. Of each group, a curve keeps the points with the lowest and the highest values, so
//! that no peak is lost, even one of a single frame.

use crate::scene::{Plot, Scene};
use crate::simulate::{Measures, MomentState};

/// The number of groups of frames. A run with at most this many frames keeps all points.
const MAX_GROUPS: usize = 600;

/// Half a turn, degrees.
const HALF_TURN: f64 = 180.0;

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// The time of the frame, s.
    pub time: f64,
    /// The two measures. `None` where they have no finite value, such as the speed of an absent body, or no place on a logarithmic axis: the
    /// curve has a gap there.
    pub at: Option<[f64; 2]>,
}

/// The values of a curve that are left out because a logarithmic axis has no place for them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeftOut {
    /// The number of frames at which a value is not positive.
    pub frames: usize,
    /// The number of frames at which the values are finite.
    pub of: usize,
}

/// Collects the curves of all plots.
pub(super) struct Curves<'a> {
    plots: &'a [Plot],
    /// The number of frames in a group.
    stride: usize,
    /// The curves of all plots, in their order.
    curves: Vec<Thinned>,
    /// The last value of each curve.
    last: Vec<f64>,
    /// The time of these values, s.
    last_time: f64,
    left_out: Vec<LeftOut>,
}

impl<'a> Curves<'a> {
    pub(super) fn new(scene: &'a Scene) -> Curves<'a> {
        let plots = &scene.plots;
        let count = plots.iter().map(|plot| plot.curves.len()).sum();
        Curves {
            plots,
            stride: scene.simulation.timeline.frames().div_ceil(MAX_GROUPS).max(1),
            curves: vec![Thinned::default(); count],
            last: vec![f64::NAN; count],
            last_time: 0.0,
            left_out: vec![LeftOut::default(); count],
        }
    }

    /// Adds the points of the next frame. `measures` are those of the scene.
    pub(super) fn see(&mut self, moment: &MomentState<'_>, measures: &Measures) {
        let last_time = std::mem::replace(&mut self.last_time, moment.time());
        let mut curves = self.curves.iter_mut().zip(&mut self.left_out).zip(&mut self.last);
        for plot in self.plots {
            let x = measures.value(&plot.x, moment);
            // The start of the run has no place on a logarithmic axis of the time. No curve misses it.
            let is_counted = x > 0.0 || !(plot.is_logarithmic[0] && plot.is_over_time());
            for (curve, ((points, left_out), last)) in plot.curves.iter().zip(&mut curves) {
                let at = [x, measures.value(&curve.y, moment)];
                if curve.y.jumps_by_a_turn() && (at[1] - *last).abs() > HALF_TURN / curve.y.unit_size() {
                    // The angle goes on at the other end of its range. A line between the two would show values that it never has.
                    points.gap.get_or_insert(0.5 * (last_time + moment.time()));
                }
                *last = at[1];
                let known = Some(at).filter(|at| at.iter().all(|value| value.is_finite()));
                let at = known.filter(|at| plot.has_place(*at));
                left_out.of += usize::from(known.is_some() && is_counted);
                left_out.frames += usize::from(known.is_some() && at.is_none() && is_counted);
                points.add(CurvePoint { time: moment.time(), at }, self.stride);
            }
        }
    }

    /// Returns the points of each curve of all plots, and how many of its values are left out.
    pub(super) fn finish(self) -> (Vec<Vec<CurvePoint>>, Vec<LeftOut>) {
        (self.curves.into_iter().map(Thinned::finish).collect(), self.left_out)
    }
}

/// The points that a curve keeps.
#[derive(Clone, Default)]
struct Thinned {
    kept: Vec<CurvePoint>,
    /// The number of points in the present group.
    count: usize,
    /// The first point of the group, then those with the lowest and the highest values of each measure, then the last point.
    group: Option<[CurvePoint; 6]>,
    /// The time of the first gap in the group, s.
    gap: Option<f64>,
}

impl Thinned {
    fn add(&mut self, point: CurvePoint, stride: usize) {
        match point.at {
            Some(at) => self.widen(point, at),
            None => {
                self.gap.get_or_insert(point.time);
            }
        }
        self.count += 1;
        if self.count >= stride {
            self.close();
        }
    }

    /// Adds a point to the group.
    fn widen(&mut self, point: CurvePoint, at: [f64; 2]) {
        let group = self.group.get_or_insert([point; 6]);
        for measure in 0..2 {
            let of = |kept: CurvePoint| kept.at.map_or(f64::NAN, |at| at[measure]);
            if at[measure] < of(group[1 + measure]) {
                group[1 + measure] = point;
            }
            if at[measure] > of(group[3 + measure]) {
                group[3 + measure] = point;
            }
        }
        group[5] = point;
    }

    /// Ends the group: keeps its points in order of time.
    fn close(&mut self) {
        self.count = 0;
        let mut points: Vec<CurvePoint> = self.group.take().into_iter().flatten().collect();
        points.extend(self.gap.take().map(|time| CurvePoint { time, at: None }));
        points.sort_by(|one, other| one.time.total_cmp(&other.time));
        for point in points {
            let is_known = self
                .kept
                .last()
                .is_some_and(|last| *last == point || last.at.is_none() && point.at.is_none());
            if !is_known {
                self.kept.push(point);
            }
        }
    }

    fn finish(mut self) -> Vec<CurvePoint> {
        self.close();
        self.kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run of a million frames with a spike of a single frame, and a gap.
    #[test]
    fn a_long_curve_keeps_its_peaks_and_gaps_in_bounded_memory() {
        let frames: u32 = 1_000_000;
        let mut curve = Thinned::default();
        for frame in 0..frames {
            let time = f64::from(frame);
            let value = if frame == 777_777 { 5.0 } else { libm::sin(time / 1000.0) };
            let is_there = !(200_000..300_000).contains(&frame);
            curve.add(CurvePoint { time, at: is_there.then_some([time, value]) }, 1_000_000 / MAX_GROUPS);
        }
        let points = curve.finish();
        assert!(points.len() <= 6 * (MAX_GROUPS + 2), "{}", points.len());
        assert!(points.iter().any(|point| point.at == Some([777_777.0, 5.0])));
        assert_eq!(points.iter().filter(|point| point.at.is_none()).count(), 1);
        assert!(points.is_sorted_by(|one, other| one.time < other.time));
        let ends = [points[0].time, points[points.len() - 1].time];
        assert_eq!(ends, [0.0, 999_999.0]);
    }

    #[test]
    fn a_curve_that_is_undefined_at_every_other_frame_needs_no_more_memory() {
        let mut curve = Thinned::default();
        for frame in 0..100_000_u32 {
            let time = f64::from(frame);
            let at = (frame % 2 == 0).then_some([time, libm::sin(time)]);
            curve.add(CurvePoint { time, at }, 200);
        }
        let points = curve.finish();
        assert!(points.len() <= 7 * 500, "{}", points.len());
        assert!(points.iter().any(|point| point.at.is_none()));
    }

    #[test]
    fn a_short_curve_keeps_all_points() {
        let mut curve = Thinned::default();
        let points: Vec<CurvePoint> = [3.0, 1.0, 1.0, 2.0]
            .into_iter()
            .enumerate()
            .map(|(frame, value)| CurvePoint { time: frame as f64, at: Some([frame as f64, value]) })
            .collect();
        points.iter().for_each(|point| curve.add(*point, 1));
        assert_eq!(curve.finish(), points);
    }
}
