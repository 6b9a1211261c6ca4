//! Sudden changes of given velocities: a pusher stops at once, or a table is pulled away.
//!
//! A contact or a rope would pass such a change on to the bodies at it in full, as if it could pull and push. The step therefore ends at the
//! change: bodies that part there leave each other, and bodies that approach have an impact.

use super::World;
use crate::Motion;
use crate::contact::Collider;

/// A velocity changes suddenly if its change exceeds what the accelerations explain by more than this fraction of the speed.
const SUDDEN_CHANGE: f64 = 1e-6;

/// Smaller changes do not count: a fraction of the largest closing speed so far, or of the typical change of velocity by forces in a step.
const SLIGHT_CHANGE: f64 = 1e-8;

/// The time of a sudden change is found to this fraction of the step.
const TIME_ERROR: f64 = 1e-12;

/// The margin by which changes are searched beyond the end of a step, as a fraction of the step. The next step may begin later by rounding
/// errors.
const SEARCH_MARGIN: f64 = 1e-9;

/// A sudden change of the velocity of a body with a given motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jump {
    pub(super) body: usize,
    /// The times right before and right after the change, from the start of the search, s.
    pub(super) before: f64,
    pub(super) after: f64,
}

impl World {
    /// Returns the first sudden change of a given velocity in the `dt` seconds after time `t`, s. `None` if there is none, or if it does not
    /// matter.
    pub(super) fn next_jump(&self, t: f64, dt: f64) -> Option<Jump> {
        // Without contacts, ropes and limits, nothing can part.
        if self.collider.is_none() && !self.solver.has_events() {
            return None;
        }
        let fastest = self.collider.as_ref().map_or(0.0, Collider::fastest);
        let slight = SLIGHT_CHANGE * fastest.max(self.solver.usual_change(self.step));
        let first = |(body, motion): (usize, &dyn Motion)| {
            let reach = self.collider.as_ref().map_or(0.0, |collider| collider.reach(body));
            let (before, after) = jump(motion, (t, dt), reach, slight)?;
            Some(Jump { body, before, after })
        };
        self.model.guided().filter_map(first).min_by(|a, b| a.before.total_cmp(&b.before))
    }

    /// Gives a body its velocity after a sudden change at time `t`, s. What it held up or pushed goes on without it, and what it now
    /// approaches has an impact.
    pub(super) fn pass_jump(&mut self, jump: Jump, t: f64) {
        self.model.place(t, &mut self.state);
        self.let_held_by_go(&[jump.body]);
        if self.collider.is_some() {
            self.meet(t, false);
        } else {
            self.decide_contacts(t);
        }
        self.integrator.discontinuity();
    }
}

/// Returns the times, in seconds after `t`, right before and right after the first sudden change of a motion within `dt` seconds. `reach`
/// is the size of the body, m. Changes of the speed below `slight`, m/s, do not count.
///
/// The accelerations at both ends of an interval explain the change of a smooth velocity, up to an error. Halving the interval divides this
/// error by eight, so it soon vanishes. A sudden change stays as large as it was, in one of the halves.
fn jump(motion: &dyn Motion, (t, dt): (f64, f64), reach: f64, slight: f64) -> Option<(f64, f64)> {
    let at = |time: f64| {
        let given = motion.at(t + time);
        let turning = if given.angular_velocity.length_squared() > 0.0 {
            motion.angular_acceleration(t + time)
        } else {
            glam::DVec3::ZERO
        };
        (time, [given.velocity, reach * given.angular_velocity], [given.acceleration, reach * turning])
    };
    type Moment = (f64, [glam::DVec3; 2], [glam::DVec3; 2]);
    // How far the change of velocity between two moments is from the explained one, and from being sudden, m/s.
    let excess = |a: &Moment, b: &Moment| {
        let left = |i: usize| b.1[i] - a.1[i] - 0.5 * (b.0 - a.0) * (a.2[i] + b.2[i]);
        let speed: f64 = [a, b].iter().flat_map(|moment| moment.1).map(glam::DVec3::length).sum();
        left(0).length() + left(1).length() - SUDDEN_CHANGE * speed - slight
    };
    let (mut early, mut late) = (at(0.0), at(dt * (1.0 + SEARCH_MARGIN)));
    if excess(&early, &late) <= 0.0 {
        return None;
    }
    while late.0 - early.0 > TIME_ERROR * dt {
        let middle = at(0.5 * (early.0 + late.0));
        if middle.0 <= early.0 || middle.0 >= late.0 {
            break;
        }
        if excess(&early, &middle) > 0.0 {
            late = middle;
        } else if excess(&middle, &late) > 0.0 {
            early = middle;
        } else {
            return None;
        }
    }
    Some((early.0, late.0))
}
