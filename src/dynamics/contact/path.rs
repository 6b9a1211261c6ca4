//! The motion of a body within a step, for the search of contacts.

use glam::{DQuat, DVec3};

use super::super::{Model, State};
use super::solid::Pose;

/// Values below this part of the coordinates are rounding.
const ROUNDING: f64 = 2e-15;

/// The motion of a body between the two ends of a step: a cubic polynomial through positions and velocities, and a
/// steady rotation. It need not be more accurate, since a touch found on it is then located by steps of the integrator.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    start: Pose,
    duration: f64,
    velocity: DVec3,
    /// x'' at both ends; it is linear in time.
    acceleration: [DVec3; 2],
    /// The mean angular velocity, and the initial one, rad/s.
    pub(super) turning: DVec3,
    pub(super) first_turning: DVec3,
    /// The largest distance that it can cover, m; and the largest angle, rad.
    pub(super) reach: f64,
    pub(super) turn: f64,
}

/// A body at a moment of its path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving {
    pub(super) pose: Pose,
    pub(super) velocity: DVec3,
}

impl Path {
    /// The path of body `i`.
    pub(super) fn of(i: usize, model: &Model, before: &State, after: &State, duration: f64) -> Path {
        let way = after.location[i] - before.location[i];
        let (v, w) = (before.velocity[i], after.velocity[i]);
        let h = duration;
        // The deviation from steady acceleration. In short steps, rounding would look like large accelerations.
        let rest = way - 0.5 * h * (v + w);
        let rounding = ROUNDING * after.location[i].abs().max(before.location[i].abs()).max_element();
        let rest = if rest.abs().max_element() <= rounding { DVec3::ZERO } else { rest };
        let (steady, rest) = ((w - v) / h, rest * (6.0 / (h * h)));
        let acceleration = [steady + rest, steady - rest];
        let turned = turned(i, model, before, after, duration);
        let bend = acceleration[0].length().max(acceleration[1].length());
        Path {
            start: pose(i, model, before),
            duration,
            velocity: v,
            acceleration,
            turning: turned / h,
            first_turning: model.angular_velocity(i, before),
            reach: h * (v.length() + 0.5 * h * bend),
            turn: turned.length(),
        }
    }

    /// The body at a time after the beginning, s.
    pub(super) fn at(&self, time: f64) -> Moving {
        let [a, b] = self.acceleration;
        let bend = (b - a) / self.duration;
        let location = self.start.location + time * (self.velocity + time * (0.5 * a + time * bend / 6.0));
        let velocity = self.velocity + time * (a + 0.5 * time * bend);
        let orientation = if self.turning == DVec3::ZERO {
            self.start.orientation
        } else {
            (DQuat::from_scaled_axis(time * self.turning) * self.start.orientation).normalize()
        };
        Moving { pose: Pose { location, orientation }, velocity }
    }

    /// The largest acceleration of another body relative to this one.
    pub(super) fn bend(&self, other: &Path) -> f64 {
        let apart = |end: usize| (other.acceleration[end] - self.acceleration[end]).length();
        apart(0).max(apart(1))
    }
}

/// The pose of body `i`.
pub(super) fn pose(i: usize, model: &Model, state: &State) -> Pose {
    Pose { location: state.location[i], orientation: model.world_from_body(i, state) }
}

/// The rotation vector of a body, rad. Of the rotations that lead to the end, it is the one that fits the angular
/// velocity.
fn turned(i: usize, model: &Model, before: &State, after: &State, duration: f64) -> DVec3 {
    if before.orientation[i] == after.orientation[i] && before.angular_momentum[i] == DVec3::ZERO {
        return DVec3::ZERO;
    }
    let whole = after.orientation[i] * before.orientation[i].conjugate();
    let whole = if whole.w < 0.0 { -whole } else { whole };
    let short = whole.to_scaled_axis();
    let expected = 0.5 * duration * (model.angular_velocity(i, before) + model.angular_velocity(i, after));
    let axis = if short == DVec3::ZERO { expected.normalize_or_zero() } else { short.normalize_or_zero() };
    let missing = (expected - short).dot(axis) / std::f64::consts::TAU;
    short + missing.round() * std::f64::consts::TAU * axis
}

impl Path {
    /// The same for a body that does not move.
    pub(super) fn stop(&mut self) {
        self.velocity = DVec3::ZERO;
        self.acceleration = [DVec3::ZERO; 2];
        self.turning = DVec3::ZERO;
        (self.reach, self.turn) = (0.0, 0.0);
    }
}
