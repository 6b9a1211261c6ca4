//! When two bodies first touch within a step.
//!
//! Their gap can shrink only so fast: with n the normal between them, by n·v, by what turning moves along n, and by the curvature of
//! the paths. Steps that are safe by this bound lead to the touch, however fast the bodies are. Source: B. V. Mirtich,
//! *Impulse-based dynamic simulation of rigid body systems* (1996), chapter 2 (conservative advancement).

use super::nearest::{Nearest, nearest};
use super::path::Path;
use super::solid::Solid;

/// Bodies touch where their gap is below this part of the coordinates: some roundings. A bounce that is lower than that is none.
pub(super) const TOUCH: f64 = 4e-15;

/// So many safe steps are made at most; what is left then is passed in steps of this part of the whole.
const STEPS: usize = 2_000;
const PART: f64 = 1.0 / 64.0;

/// Two bodies on their ways through a step.
pub(super) struct Approach<'a> {
    pub(super) solids: [&'a Solid; 2],
    pub(super) paths: [&'a Path; 2],
    /// Below this rate a gap does not shrink, m/s.
    pub(super) slight: f64,
    /// At this gap they touch, m.
    pub(super) touch: f64,
}

impl Approach<'_> {
    fn look(&self, time: f64) -> Option<(Nearest, [super::path::Moving; 2])> {
        let moving = self.paths.map(|path| path.at(time));
        let near = nearest(self.solids[0], &moving[0].pose, self.solids[1], &moving[1].pose, f64::INFINITY)?;
        Some((near, moving))
    }

    /// The first time at which they touch and come nearer, s after the beginning, if that is before `end`.
    pub(super) fn first(&self, end: f64) -> Option<f64> {
        let mut time = 0.0;
        for step in 0.. {
            let (near, moving) = self.look(time)?;
            let rate = self.rate(&near, &moving, time);
            let is_touched = near.gap <= self.touch;
            if is_touched && rate < -self.slight {
                return Some(time);
            }
            let safe = self.safe(&near, &moving, is_touched, rate);
            // What touches without coming nearer, or comes nearer without end, is passed in small steps.
            let stuck = (is_touched && rate <= self.slight) || step > STEPS;
            let safe = if stuck { safe.max(PART * end) } else { safe };
            time += safe;
            if time.is_nan() || time >= end {
                return None;
            }
        }
        None
    }

    /// How fast the gap changes, m/s.
    fn rate(&self, near: &Nearest, moving: &[super::path::Moving; 2], time: f64) -> f64 {
        let at = |i: usize| {
            let arm = near.on[i] - moving[i].pose.location;
            let path = self.paths[i];
            let turning = if time == 0.0 { path.first_turning } else { path.turning };
            moving[i].velocity + turning.cross(arm)
        };
        near.normal.dot(at(1) - at(0))
    }

    /// A time within which they cannot touch, s.
    fn safe(&self, near: &Nearest, moving: &[super::path::Moving; 2], is_touched: bool, rate: f64) -> f64 {
        let mut shrink = -near.normal.dot(moving[1].velocity - moving[0].velocity);
        let mut bend = self.paths[0].bend(self.paths[1]);
        for (i, body) in moving.iter().enumerate() {
            let turning = self.paths[i].turning;
            if turning.length_squared() > 0.0 {
                // A body without end turns about a place that can be far away.
                let reach = self.solids[i].reach();
                let reach = if reach.is_finite() {
                    reach
                } else {
                    2.0 * (near.on[i] - body.pose.location).length() + self.solids[1 - i].reach()
                };
                shrink += turning.cross(near.normal).length() * reach;
                bend += turning.length_squared() * reach;
            }
        }
        let gap = near.gap;
        if is_touched {
            // Touched, and not coming nearer: free until the paths bend together again.
            return if bend > 0.0 { 2.0 * rate.max(0.0) / bend } else { f64::INFINITY };
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
