//! Finds the time at which two bodies first touch within a step.
//!
//! The rate at which their gap shrinks is bounded by the velocity and the rotation along the normal n, and by the
//! curvature of the paths. Steps that are safe by this bound lead to the touch at any speed. Near it, each place has a
//! bound of its own: one corner can leave the floor while another comes down. Source: B. V. Mirtich, *Impulse-based
//! dynamic simulation of rigid body systems* (1996), chapter 2 (conservative advancement).

use glam::DVec3;

use super::nearest::{Nearest, nearest};
use super::path::{Moving, Path};
use super::solid::{Pose, Solid};
use super::touch::touches;

/// Bodies touch if their gap is below this part of the coordinates, a few roundings. Lower bounces are ignored.
pub(super) const TOUCH: f64 = 4e-15;

/// Bodies nearer than this part of the smaller one are examined place by place.
const CLOSE: f64 = 0.01;

/// Rounding beyond an edge can make a place's gap too small by this part of the smaller body.
const SLACK: f64 = 1e-8;

/// The largest number of safe steps. The rest is covered in steps of this part of the whole.
const STEPS: usize = 2_000;
const PART: f64 = 1.0 / 64.0;

/// Two bodies on their paths through a step.
pub(super) struct Approach<'a> {
    pub(super) solids: [&'a Solid; 2],
    pub(super) paths: [&'a Path; 2],
    /// Below this rate a gap does not shrink, m/s.
    pub(super) slight: f64,
    /// At this gap they touch, m.
    pub(super) touch: f64,
}

/// The place where two bodies are nearest, and all other places where they are nearer than `within`, m.
pub(super) fn places(solids: [&Solid; 2], poses: [&Pose; 2], near: Nearest, within: f64) -> Vec<Nearest> {
    let mut all = vec![near];
    let [a, b] = solids;
    let has_one = |ball: &Solid, other: &Solid| ball.is_ball() && other.parts().len() == 1;
    if !has_one(a, b) && !has_one(b, a) {
        // No place is nearer than the nearest one. One that seems so lies on the far side of an edge.
        let slack = SLACK * a.size().min(b.size());
        let others = touches(a, poses[0], b, poses[1], within);
        let others = others.iter().map(|touch| touch.meeting).filter(|other| other.gap >= near.gap - slack);
        all.extend(others.map(|other| Nearest { gap: other.gap.max(near.gap), ..other }));
    }
    all
}

/// Whether both are convex. If neither rotates, a plane between them at the nearest place bounds their gap everywhere.
pub(super) fn are_convex(solids: [&Solid; 2]) -> bool {
    solids.iter().all(|solid| solid.parts().len() == 1 && !solid.is_surface())
}

/// Bodies nearer than this are examined place by place, m.
pub(super) fn close(solids: [&Solid; 2]) -> f64 {
    CLOSE * solids[0].size().min(solids[1].size()).min(f64::MAX)
}

impl Approach<'_> {
    /// The first time before `end` at which they touch and approach, s after the beginning.
    pub(super) fn first(&self, end: f64) -> Option<f64> {
        let close = close(self.solids);
        let turns = self.paths.map(|path| path.turning != DVec3::ZERO || path.first_turning != DVec3::ZERO);
        let is_shift = are_convex(self.solids) && turns == [false; 2];
        let mut time = 0.0;
        for step in 0.. {
            let moving = self.paths.map(|path| path.at(time));
            let poses = [&moving[0].pose, &moving[1].pose];
            let near = nearest(self.solids[0], poses[0], self.solids[1], poses[1], f64::INFINITY)?;
            let (shrink, bend) = self.bounds(&near, &moving);
            let mut safe =
                if is_shift { f64::INFINITY } else { self.until(near.gap.max(close), shrink, bend) };
            let mut is_stuck = step > STEPS;
            if is_shift || near.gap <= close {
                let near = if is_shift { vec![near] } else { places(self.solids, poses, near, close) };
                for place in near {
                    let rate = self.rate(&place, &moving, time);
                    let is_touched = place.gap <= self.touch;
                    if is_touched && rate < -self.slight {
                        return Some(time);
                    }
                    safe = safe.min(self.until(place.gap, -rate, bend));
                    is_stuck |= is_touched && rate <= self.slight;
                }
            }
            // Touching without approach, and endless approach, are passed in small steps.
            time += if is_stuck { safe.max(PART * end) } else { safe };
            if time.is_nan() || time >= end {
                return None;
            }
        }
        None
    }

    /// The rate of a gap, m/s.
    fn rate(&self, place: &Nearest, moving: &[Moving; 2], time: f64) -> f64 {
        let at = |i: usize| {
            let arm = place.on[i] - moving[i].pose.location;
            let path = self.paths[i];
            let turning = if time == 0.0 { path.first_turning } else { path.turning };
            moving[i].velocity + turning.cross(arm)
        };
        place.normal.dot(at(1) - at(0))
    }

    /// The largest rate at which the gap of any two places can shrink, m/s, and a bound of its second derivative, m/s².
    fn bounds(&self, near: &Nearest, moving: &[Moving; 2]) -> (f64, f64) {
        let velocity = moving[1].velocity - moving[0].velocity;
        let mut shrink = -near.normal.dot(velocity);
        let mut bend = self.paths[0].bend(self.paths[1]);
        for (i, body) in moving.iter().enumerate() {
            let turning = self.paths[i].turning;
            if turning.length_squared() > 0.0 {
                // An infinite body rotates about a place that can be far away.
                let reach = self.solids[i].reach();
                let reach = if reach.is_finite() {
                    reach
                } else {
                    2.0 * (near.on[i] - body.pose.location).length() + self.solids[1 - i].reach()
                };
                shrink += turning.cross(near.normal).length() * reach;
                // The normal rotates as well.
                bend += turning.length_squared() * reach + 2.0 * turning.length() * velocity.length();
            }
        }
        (shrink, bend)
    }

    /// A lower bound of the time in which a gap closes, s.
    fn until(&self, gap: f64, shrink: f64, bend: f64) -> f64 {
        if gap <= self.touch {
            // Touching without approach: free until the paths bend together again.
            return if bend > 0.0 { 2.0 * (-shrink).max(0.0) / bend } else { f64::INFINITY };
        }
        let root = (shrink * shrink + 2.0 * bend * gap).sqrt();
        // The smallest positive root of gap − shrink t − ½ bend t², without cancellation.
        if shrink > 0.0 {
            2.0 * gap / (shrink + root)
        } else if bend > 0.0 {
            (root - shrink) / bend
        } else {
            f64::INFINITY
        }
    }
}
