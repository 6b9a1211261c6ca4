//! A camera that goes along with the motion, slowly and smoothly.
//!
//! It keeps its direction, and shows all that moves at each time. Its aim is a moving average of the middle of the motion, and its distance is
//! a moving average of the largest distance that is needed nearby.

use glam::{DVec3, DVec4};

use super::camera::Placed;
use crate::simulate::{Bounds, Stretch};

/// The number of intervals between the points of a track.
const INTERVALS_OF_TRACK: usize = 128;
/// The number of points on each side of a point over which averages are taken: those of an eighth of the run.
const POINTS_ON_EACH_SIDE: usize = 16;

/// The aims and the views of a camera at equal intervals of time.
#[derive(Clone, Debug)]
pub(super) struct Track {
    /// The time of the first point, s.
    begin: f64,
    /// The time from one point to the next, s.
    interval: f64,
    /// The points at which the camera aims, m, each with the width in view there, m.
    points: Vec<DVec4>,
}

impl Track {
    /// Plans the track of a camera along a course, with a width in view of at least `least` (m). `placed` has the direction and the lens of the
    /// camera. `None` without a course, or for a course of points, which have no size.
    #[allow(clippy::cast_precision_loss, reason = "there are few points")]
    pub(super) fn new(course: &[Stretch], placed: &Placed, least: f64) -> Option<Track> {
        let (first, last) = course.first().zip(course.last())?;
        let interval = (last.until - first.from) / INTERVALS_OF_TRACK as f64;
        if interval <= 0.0 {
            return None;
        }
        let times = || (0..=INTERVALS_OF_TRACK).map(|number| first.from + interval * number as f64);
        let middles: Vec<DVec4> = times().map(|time| middle(course, time).extend(0.0)).collect();
        let aims: Vec<DVec4> =
            (0..=INTERVALS_OF_TRACK).map(|number| average(number, |at| beyond(&middles, at))).collect();
        let needed = |(time, aim): (f64, &DVec4)| {
            placed.view_for(around(course, time, interval), aim.truncate()).max(least)
        };
        let needed: Vec<f64> = times().zip(&aims).map(needed).collect();
        // The average of largest values is at least as large as each value.
        let largest_near = |at: isize| {
            let at = usize::try_from(at).unwrap_or(0).min(INTERVALS_OF_TRACK);
            let near = &needed
                [at.saturating_sub(POINTS_ON_EACH_SIDE)..=(at + POINTS_ON_EACH_SIDE).min(INTERVALS_OF_TRACK)];
            DVec4::W * near.iter().copied().fold(0.0, f64::max)
        };
        let point = |(number, aim): (usize, &DVec4)| *aim + average(number, largest_near);
        let points: Vec<DVec4> = aims.iter().enumerate().map(point).collect();
        let is_seen = points.iter().all(|point| point.is_finite() && point.w > 0.0);
        is_seen.then_some(Track { begin: first.from, interval, points })
    }

    /// The aim at a time (s), and the width in view there, m.
    #[allow(clippy::cast_possible_truncation, reason = "the position is within the track")]
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_wrap, reason = "there are few points")]
    pub(super) fn at(&self, time: f64) -> (DVec3, f64) {
        let position = ((time - self.begin) / self.interval).clamp(0.0, INTERVALS_OF_TRACK as f64);
        let number = (position as isize).min(INTERVALS_OF_TRACK as isize - 1);
        let points = [-1, 0, 1, 2].map(|offset| beyond(&self.points, number + offset));
        let point = spline(points, position - number as f64);
        (point.truncate(), point.w)
    }

    /// The smallest width in view, m, and the one that the camera exceeds for half of the time, m.
    pub(super) fn views(&self) -> [f64; 2] {
        let mut views: Vec<f64> = self.points.iter().map(|point| point.w).collect();
        views.sort_by(f64::total_cmp);
        [views[0], views[INTERVALS_OF_TRACK / 2]]
    }

    /// The mean height of the aims, m.
    #[allow(clippy::cast_precision_loss, reason = "there are few points")]
    pub(super) fn height(&self) -> f64 {
        self.points.iter().fold(0.0, |sum, point| sum + point.y) / self.points.len() as f64
    }
}

/// The box around all that moves from an interval before a time to an interval after it. At a time at which nothing moves, it is where
/// something moved before.
fn around(course: &[Stretch], time: f64, interval: f64) -> Bounds {
    let from = course.partition_point(|stretch| stretch.until < time - interval);
    let until = course.partition_point(|stretch| stretch.from <= time + interval);
    let near = course.get(from..until).unwrap_or_default().iter().map(|stretch| stretch.bounds);
    near.reduce(Bounds::union).unwrap_or(course[from.saturating_sub(1)].bounds)
}

/// The middle of what moves at a time, on a straight line through the middles of the two stretches beside this time.
fn middle(course: &[Stretch], time: f64) -> DVec3 {
    let after = course.partition_point(|stretch| stretch.middle() <= time).clamp(1, course.len().max(2) - 1);
    let (Some(before), Some(after)) = (course.get(after - 1), course.get(after)) else {
        return course[0].bounds.middle();
    };
    let part = (time - before.middle()) / (after.middle() - before.middle());
    before.bounds.middle().lerp(after.bounds.middle(), part)
}

/// Returns a point of a series. Beyond its ends, it goes on as it does inside, point by point about its end.
fn beyond(points: &[DVec4], at: isize) -> DVec4 {
    let last = points.len() - 1;
    match usize::try_from(at) {
        Err(_) => 2.0 * points[0] - points[at.unsigned_abs().min(last)],
        Ok(at) if at > last => 2.0 * points[last] - points[last - (at - last).min(last)],
        Ok(at) => points[at],
    }
}

/// The weighted average of values near a point, by a Hann window.
#[allow(clippy::cast_possible_wrap, clippy::cast_precision_loss, reason = "there are few points")]
fn average(number: usize, value: impl Fn(isize) -> DVec4) -> DVec4 {
    let half = POINTS_ON_EACH_SIDE as isize;
    let weight =
        |offset: isize| 0.5 + 0.5 * libm::cos(std::f64::consts::PI * offset as f64 / (half + 1) as f64);
    let (mut sum, mut total) = (DVec4::ZERO, 0.0);
    for offset in -half..=half {
        sum += value(number as isize + offset) * weight(offset);
        total += weight(offset);
    }
    sum / total
}

/// A point between the second and the third of four points, on the spline of Catmull and Rom. Source: E. Catmull & R. Rom, *A class of local
/// interpolating splines*, 1974.
fn spline([before, from, to, after]: [DVec4; 4], part: f64) -> DVec4 {
    let [start, end] = [(to - before) / 2.0, (after - from) / 2.0];
    let (square, cube) = (part * part, part * part * part);
    from * (2.0 * cube - 3.0 * square + 1.0)
        + start * (cube - 2.0 * square + part)
        + to * (3.0 * square - 2.0 * cube)
        + end * (cube - square)
}
