//! Finds the time at which two bodies first touch within a step.
//!
//! The rate at which their gap closes is bounded by the velocity and the rotation along the normal n, and by the curvature of the paths.
//! Time steps that are safe by this bound lead to the first touch at any speed. When the bodies are close, each pair of nearby points has
//! a bound of its own: one corner can leave the floor while another comes down. The lowest point of a nearly flat rim runs around the rim
//! faster than any point of the body moves, so a rim has a bound of its own, see `rim_bound.rs`. Source: B. V. Mirtich, *Impulse-based dynamic
//! simulation of rigid body systems* (1996), chapter 2 (conservative advancement).

use glam::DVec3;

use super::closest_points::{ClosestPoints, nearest};
use super::flush::slide_past;
use super::path::{Moving, Path};
use super::solid::{Pose, Solid};
use super::touch::touches;

/// Bodies touch if their gap is below this fraction of their coordinates: a few rounding errors. Bounces that are lower than this are
/// ignored.
pub(super) const COORDINATE_ROUNDING: f64 = 4e-15;

/// If the gap of two bodies is below this fraction of the smaller one's size, all pairs of nearby points are examined.
const NEARBY_GAP: f64 = 0.01;

/// The tolerance for the gap at a pair of points, as a fraction of the smaller body's size. Beyond an edge, rounding errors can make this
/// gap too small.
const GAP_TOLERANCE: f64 = 1e-8;

/// The largest number of safe time steps in one search. After them, each step covers at least the fraction [`MIN_STEP_FRACTION`] of
/// the whole interval.
const MAX_SAFE_STEPS: usize = 2_000;
/// The shortest time step after [`MAX_SAFE_STEPS`], as a fraction of the whole interval.
const MIN_STEP_FRACTION: f64 = 1.0 / 64.0;

/// The search for the first touch of two bodies on their paths through a step.
pub(super) struct Approach<'a> {
    pub(super) solids: [&'a Solid; 2],
    pub(super) paths: [&'a Path; 2],
    /// Gaps that close at less than this rate do not count as approaching, m/s.
    pub(super) slight: f64,
    /// The gap at which the two bodies count as touching, m.
    pub(super) touch: f64,
}

/// Returns the closest points of two bodies, `near`, and all other pairs of points that are closer than `within`, m.
pub(super) fn places(
    solids: [&Solid; 2],
    poses: [&Pose; 2],
    near: ClosestPoints,
    within: f64,
) -> Vec<ClosestPoints> {
    let mut all = vec![near];
    let [a, b] = solids;
    let has_one = |ball: &Solid, other: &Solid| ball.is_ball() && other.parts().len() == 1;
    if !has_one(a, b) && !has_one(b, a) {
        // No pair of points is closer than the closest points. A pair that seems closer lies on the far side of an edge.
        let slack = GAP_TOLERANCE * a.size().min(b.size());
        let others = touches(a, poses[0], b, poses[1], within);
        let others = others.iter().map(|touch| touch.meeting).filter(|other| other.gap >= near.gap - slack);
        all.extend(others.map(|other| ClosestPoints { gap: other.gap.max(near.gap), ..other }));
    }
    all
}

/// Returns true if both bodies are single convex solids. If neither rotates, a plane between their closest points bounds their gap
/// everywhere.
pub(super) fn are_convex(solids: [&Solid; 2]) -> bool {
    solids.iter().all(|solid| solid.parts().len() == 1 && !solid.is_surface())
}

/// Returns the gap, m, below which all pairs of nearby points of two bodies are examined.
pub(super) fn close(solids: [&Solid; 2]) -> f64 {
    NEARBY_GAP * solids[0].size().min(solids[1].size()).min(f64::MAX)
}

/// Computes the rate of the gap at one pair of points of two moving bodies, m/s. It is negative while the bodies approach.
fn rate(place: &ClosestPoints, moving: &[Moving; 2]) -> f64 {
    let [first, second] = velocities(place, moving);
    place.normal.dot(second - first)
}

/// Computes the velocities of two moving bodies at one pair of points, m/s.
fn velocities(place: &ClosestPoints, moving: &[Moving; 2]) -> [DVec3; 2] {
    [0, 1].map(|i| {
        let arm = place.on[i] - moving[i].pose.location;
        moving[i].velocity + moving[i].turning.cross(arm)
    })
}

impl Approach<'_> {
    /// Returns the first time before `end` at which the bodies touch and approach, in seconds after the beginning of the step. `None` if
    /// they do not.
    pub(super) fn first(&self, end: f64) -> Option<f64> {
        let close = close(self.solids);
        let is_shift = are_convex(self.solids) && !self.paths.iter().any(|path| path.turns());
        let mut time = 0.0;
        for step in 0.. {
            let moving = self.paths.map(|path| path.at(time));
            let poses = [&moving[0].pose, &moving[1].pose];
            let near = nearest(self.solids[0], poses[0], self.solids[1], poses[1], f64::INFINITY)?;
            let (shrink, bend) = self.bounds(&near, &moving);
            let mut safe =
                if is_shift { f64::INFINITY } else { self.until(near.gap.max(close), shrink, bend) };
            let mut is_stuck = step > MAX_SAFE_STEPS;
            if is_shift || near.gap <= close {
                let near = if is_shift {
                    vec![near]
                } else {
                    safe = safe.min(self.until_rims(&near, &moving, bend, end - time));
                    places(self.solids, poses, near, close)
                };
                for place in near {
                    let rate = rate(&place, &moving);
                    let is_touched = place.gap <= self.touch;
                    let slides =
                        is_touched && slide_past(self.solids, poses, &place, velocities(&place, &moving));
                    if is_touched && rate < -self.slight && !slides {
                        return Some(time);
                    }
                    // What slides past may soon lie on the other body.
                    let until =
                        if slides { MIN_STEP_FRACTION * end } else { self.until(place.gap, -rate, bend) };
                    safe = safe.min(until);
                    is_stuck |= is_touched && (rate <= self.slight || slides);
                }
            }
            // If the bodies touch without approaching, or approach endlessly, the search goes on in small time steps.
            time += if is_stuck { safe.max(MIN_STEP_FRACTION * end) } else { safe };
            if time.is_nan() || time >= end {
                return None;
            }
        }
        None
    }

    /// Computes the largest rate at which the gap of any pair of points can close, m/s, and a bound of the gap's second derivative, m/s².
    fn bounds(&self, near: &ClosestPoints, moving: &[Moving; 2]) -> (f64, f64) {
        let velocity = moving[1].velocity - moving[0].velocity;
        let mut shrink = -near.normal.dot(velocity);
        let mut bend = self.paths[0].bend(self.paths[1]);
        for (i, body) in moving.iter().enumerate() {
            if self.paths[i].turns() {
                let (fastest, changing) = self.paths[i].spin();
                // A body of infinite size can touch far from its center, so the contact point bounds its reach.
                let reach = self.solids[i].reach();
                let reach = if reach.is_finite() {
                    reach
                } else {
                    2.0 * (near.on[i] - body.pose.location).length() + self.solids[1 - i].reach()
                };
                shrink += body.turning.cross(near.normal).length() * reach;
                // The contact normal rotates with the body as well.
                bend += (fastest * fastest + changing) * reach + 2.0 * fastest * velocity.length();
            }
        }
        (shrink, bend)
    }

    /// Computes a lower bound of the time after which a gap can be closed, s. `shrink` is its closing rate, m/s, and `bend` bounds its
    /// second derivative, m/s².
    fn until(&self, gap: f64, shrink: f64, bend: f64) -> f64 {
        if gap <= self.touch {
            // The bodies touch without approaching: they cannot overlap until their paths bend together again.
            return if bend > 0.0 { 2.0 * (-shrink).max(0.0) / bend } else { f64::INFINITY };
        }
        let root = (shrink * shrink + 2.0 * bend * gap).sqrt();
        // The smallest positive root of gap − shrink t − ½ bend t², in a form without cancellation.
        if shrink > 0.0 {
            2.0 * gap / (shrink + root)
        } else if bend > 0.0 {
            (root - shrink) / bend
        } else {
            f64::INFINITY
        }
    }
}
