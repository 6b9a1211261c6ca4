//! The path of a body, for its trail.

use glam::DVec3;

use super::corners;
use crate::physics::BodySnapshot;
use crate::scene::{Timeline, Trail};

/// The largest number of points of a trail. In longer runs, only every second, fourth, … frame adds a point.
pub(super) const MOST_POINTS: usize = 512;

/// The largest angle between successive straight pieces of a drawn path, rad.
pub(in crate::simulate) const BEND: f64 = 0.06;
/// The largest number of straight pieces between two points of a path.
const MOST_PIECES: f64 = 16.0;

/// The path of a point of a body, up to the present time.
#[derive(Clone, Debug, PartialEq)]
pub struct TrailPath {
    /// The index of the body.
    pub body: usize,
    /// The points of the path by increasing time. The last one is the present position, if the body is present.
    pub points: Vec<TrailPoint>,
    /// The number of frames between two stored points.
    pub stride: usize,
}

/// A point of the path of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrailPoint {
    /// The time at which the body passed the point, s.
    pub time: f64,
    /// The position of the point in world axes, m.
    pub location: DVec3,
    /// The velocity of the body at the point, in world axes, m/s.
    pub velocity: DVec3,
    /// The number of the frame, for a point that is stored for later frames. `None` at an impact, and for interpolated and present
    /// positions.
    pub frame: Option<usize>,
    /// The value at this time that the color of the trail follows. It is interpolated linearly between two frames. `None` if the color
    /// stays, or if the value is not finite.
    pub value: Option<f64>,
}

impl TrailPoint {
    /// Interpolates the position (m) between this point and the next at a time (s), by a cubic that matches locations and velocities at
    /// both points. The result is exact under a constant force.
    pub fn towards(&self, next: &TrailPoint, time: f64) -> DVec3 {
        let span = next.time - self.time;
        if span <= 0.0 || self.velocity.dot(next.velocity) <= 0.0 {
            // A body that reverses between two points is slow or had an impact, so a straight line is as good as any curve.
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

    /// Interpolates the value that the color follows, linearly in time. `None` if it is unknown at one of the points.
    pub fn value_towards(&self, next: &TrailPoint, time: f64) -> Option<f64> {
        between([self.value, next.value], (time - self.time) / (next.time - self.time))
    }

    /// The velocity (m/s) at a time (s), on the same path as [`towards`](Self::towards).
    pub(in crate::simulate) fn velocity_towards(&self, next: &TrailPoint, time: f64) -> DVec3 {
        let (span, way) = (next.time - self.time, next.location - self.location);
        if span <= 0.0 || self.velocity.dot(next.velocity) <= 0.0 {
            return if span > 0.0 { way / span } else { next.velocity };
        }
        let s = (time - self.time) / span;
        6.0 * s * (1.0 - s) / span * way
            + (1.0 - s) * (1.0 - 3.0 * s) * self.velocity
            + s * (3.0 * s - 2.0) * next.velocity
    }

    /// The number of straight pieces that the path to the next point is drawn with.
    pub fn pieces_towards(&self, next: &TrailPoint) -> f64 {
        let bend = self.velocity.angle_between(next.velocity);
        if bend.is_finite() { (bend / BEND).ceil().clamp(1.0, MOST_PIECES) } else { 1.0 }
    }

    pub(super) fn of(time: f64, body: &BodySnapshot, trail: Trail) -> TrailPoint {
        let (location, velocity) = body.point(trail.at);
        TrailPoint { time, location, velocity, frame: None, value: None }
    }
}

/// Returns the value at a part, from 0 to 1, of the way between two values.
pub(super) fn between([from, to]: [Option<f64>; 2], part: f64) -> Option<f64> {
    let (from, to) = (from?, to?);
    Some(if part.is_finite() { from + part * (to - from) } else { to })
}

/// Removes the part of a path before a time (s). The path then starts at exactly that time, which may lie between two points.
pub(super) fn cut(points: &mut Vec<TrailPoint>, from: f64) {
    let before = points.iter().take_while(|point| point.time <= from).count();
    let Some(last) = before.checked_sub(1) else { return };
    if let Some(&next) = points.get(before) {
        let point = points[last];
        let part = (from - point.time) / (next.time - point.time);
        let velocity = point.velocity.lerp(next.velocity, part);
        points[last] = TrailPoint {
            time: from,
            location: point.towards(&next, from),
            velocity,
            frame: None,
            value: point.value_towards(&next, from),
        };
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

/// The number of frames between two stored points of a trail: the smallest power of two that keeps the trail within [`MOST_POINTS`].
/// `time` is the time of the present frame, s, and `frame` its index.
pub(super) fn stride(trail: Trail, timeline: &Timeline, time: f64, frame: usize) -> usize {
    let within =
        trail.duration.map_or(usize::MAX, |duration| frames_within(timeline.frames_during(duration, time)));
    (within.min(frame) / MOST_POINTS + 1).next_power_of_two()
}

/// Removes the impacts between two stored points if there are more than [`corners::MOST`].
pub(super) fn thin(path: &mut Vec<(usize, TrailPoint)>) {
    let mut kept = Vec::with_capacity(path.len());
    for run in path.chunk_by(|a, b| a.1.frame.is_none() && b.1.frame.is_none()) {
        if run[0].1.frame.is_some() || run.len() <= 2 * corners::MAX_CORNER_IMPACTS {
            kept.extend_from_slice(run);
        }
    }
    *path = kept;
}
