//! The path of a body, for its trail.

use glam::DVec3;

use super::corners;
use crate::dynamics::BodySnapshot;
use crate::scene::Trail;

/// The largest number of points of a trail. With more frames, only every second, fourth, … is kept.
pub(super) const MOST_POINTS: usize = 512;

/// The path of a body, or of a point of it, up to a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// The index of the body.
    pub body: usize,
    /// Points of the path, the oldest first; the last is the present one.
    pub points: Vec<Passed>,
    /// The number of frames from one kept point to the next.
    pub stride: usize,
}

/// A point of the path of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passed {
    /// The time, s.
    pub time: f64,
    /// The position, m.
    pub location: DVec3,
    /// The velocity, m/s.
    pub velocity: DVec3,
    /// The number of its frame, if the point is kept for later frames; `None` at an impact.
    pub frame: Option<usize>,
}

impl Passed {
    /// The position between this point and a later one, m, on a cubic that matches locations and velocities at both. So the path under a
    /// constant force is exact, for any distance of the points.
    pub fn towards(&self, next: &Passed, time: f64) -> DVec3 {
        let span = next.time - self.time;
        if span <= 0.0 || self.velocity.dot(next.velocity) <= 0.0 {
            // A body that reverses in between was hit, or is slow: a straight line is as good as any curve.
            let part = if span > 0.0 { (time - self.time) / span } else { 1.0 };
            return self.location.lerp(next.location, part);
        }
        let s = (time - self.time) / span;
        let (s2, s3) = (s * s, s * s * s);
        (2.0 * s3 - 3.0 * s2 + 1.0) * self.location
            + (s3 - 2.0 * s2 + s) * span * self.velocity
            + (3.0 * s2 - 2.0 * s3) * next.location
            + (s3 - s2) * span * next.velocity
    }

    pub(super) fn of(time: f64, body: &BodySnapshot, trail: Trail) -> Passed {
        let (location, velocity) = body.point(trail.at);
        Passed { time, location, velocity, frame: None }
    }
}

/// Cuts a path to the part from a time on, which may lie between two of its points.
pub(super) fn cut(points: &mut Vec<Passed>, from: f64) {
    let before = points.iter().take_while(|point| point.time <= from).count();
    let Some(last) = before.checked_sub(1) else { return };
    if let Some(&next) = points.get(before) {
        let point = points[last];
        let part = (from - point.time) / (next.time - point.time);
        let velocity = point.velocity.lerp(next.velocity, part);
        points[last] = Passed { time: from, location: point.towards(&next, from), velocity, frame: None };
    }
    points.drain(..last);
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the conversion saturates, and a saturated number means the same"
)]
fn frames_within(intervals: f64) -> usize {
    intervals as usize
}

/// The number of frames from one kept point of a trail to the next at a frame: the smallest power of two that keeps the trail within
/// [`MOST_POINTS`].
pub(super) fn stride(trail: Trail, interval: f64, frame: usize) -> usize {
    let within = trail.duration.map_or(usize::MAX, |duration| frames_within(duration / interval));
    (within.min(frame) / MOST_POINTS + 1).next_power_of_two()
}

/// Drops impacts beyond the limit between two kept points of a path.
pub(super) fn thin(way: &mut Vec<(usize, Passed)>) {
    let mut kept = Vec::with_capacity(way.len());
    for run in way.chunk_by(|a, b| a.1.frame.is_none() && b.1.frame.is_none()) {
        if run[0].1.frame.is_some() || run.len() <= 2 * corners::MOST {
            kept.extend_from_slice(run);
        }
    }
    *way = kept;
}
