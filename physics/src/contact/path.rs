//! The path of a body within a step, which the search for contacts uses.

use glam::{DQuat, DVec3};

use super::super::{Model, State};
use super::solid::Pose;

/// Deviations count as rounding errors if they are below this fraction of the coordinates.
const COORDINATE_ROUNDING: f64 = 2e-15;

/// Rotations count as equal if they differ by at most this angle, rad: some rounding errors of orientations.
const ROTATION_ROUNDING: f64 = 1e-14;

/// The path of a body between the two ends of a step: a cubic polynomial through positions and velocities, and a rotation whose angular
/// velocity changes evenly. This accuracy is sufficient: if a touch is found on the path, steps of the integrator then locate it exactly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    start: Pose,
    duration: f64,
    velocity: DVec3,
    /// The acceleration at the beginning and at the end of the step, m/s². It is linear in time.
    acceleration: [DVec3; 2],
    /// The mean angular velocity in the step; `first_turning` is that at its beginning. World axes, rad/s.
    turning: DVec3,
    first_turning: DVec3,
    /// Upper bounds of the motion in the step: the distance of the center of mass, m, and the angle of rotation (`turn`), rad.
    pub(super) reach: f64,
    pub(super) turn: f64,
}

/// The pose and the velocity of a body at one moment of its path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving {
    pub(super) pose: Pose,
    pub(super) velocity: DVec3,
    /// The angular velocity, world axes, rad/s.
    pub(super) turning: DVec3,
}

impl Path {
    /// Computes the path of body `i` from the states at both ends of the step. `duration` is the length of the step, s.
    pub(super) fn of(i: usize, model: &Model, before: &State, after: &State, duration: f64) -> Path {
        let way = after.location[i] - before.location[i];
        let (v, w) = (before.velocity[i], after.velocity[i]);
        let h = duration;
        // The deviation from constant acceleration. In short steps, a rounding error would look like a large acceleration.
        let rest = way - 0.5 * h * (v + w);
        let rounding =
            COORDINATE_ROUNDING * after.location[i].abs().max(before.location[i].abs()).max_element();
        let rest = if rest.abs().max_element() <= rounding { DVec3::ZERO } else { rest };
        let (steady, rest) = ((w - v) / h, rest * (6.0 / (h * h)));
        let acceleration = [steady + rest, steady - rest];
        let turned = turned(i, model, before, after, duration);
        let first_turning = model.angular_velocity(i, before);
        let turning = 0.5 * (first_turning + model.angular_velocity(i, after));
        // In short steps, a rounding error of the orientation would look like a large angular velocity.
        let turning = if (turned - h * turning).length() <= ROTATION_ROUNDING { turning } else { turned / h };
        let bend = acceleration[0].length().max(acceleration[1].length());
        Path {
            start: pose(i, model, before),
            duration,
            velocity: v,
            acceleration,
            turning,
            first_turning,
            reach: h * (v.length() + 0.5 * h * bend),
            turn: turned.length() + h * (turning - first_turning).length(),
        }
    }

    /// Returns the pose and velocity of the body `time` seconds after the beginning of the step.
    pub(super) fn at(&self, time: f64) -> Moving {
        let [a, b] = self.acceleration;
        let bend = (b - a) / self.duration;
        let location = self.start.location + time * (self.velocity + time * (0.5 * a + time * bend / 6.0));
        let velocity = self.velocity + time * (a + 0.5 * time * bend);
        let orientation = if self.turns() {
            let part = time / self.duration;
            let turn = time * self.first_turning.lerp(self.turning, part);
            (DQuat::from_scaled_axis(turn) * self.start.orientation).normalize()
        } else {
            self.start.orientation
        };
        let turning = self.first_turning + 2.0 * time / self.duration * (self.turning - self.first_turning);
        Moving { pose: Pose { location, orientation }, velocity, turning }
    }

    /// Returns true if the body rotates in the step.
    pub(super) fn turns(&self) -> bool {
        self.turning != DVec3::ZERO || self.first_turning != DVec3::ZERO
    }

    /// Returns the largest angular velocity of the body in the step, rad/s, and its angular acceleration, rad/s².
    pub(super) fn spin(&self) -> (f64, f64) {
        let change = 2.0 * (self.turning - self.first_turning);
        let last = self.first_turning + change;
        (self.first_turning.length().max(last.length()), change.length() / self.duration)
    }

    /// Returns the largest acceleration of another body relative to this one, m/s².
    pub(super) fn bend(&self, other: &Path) -> f64 {
        let apart = |end: usize| (other.acceleration[end] - self.acceleration[end]).length();
        apart(0).max(apart(1))
    }
}

/// Returns the pose of body `i` in a state.
pub(crate) fn pose(i: usize, model: &Model, state: &State) -> Pose {
    Pose { location: state.location[i], orientation: model.world_from_body(i, state) }
}

/// Returns the rotation vector of a body in a step, world axes, rad. Full turns are chosen to fit the angular velocity.
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
    /// Changes this path into that of a body at rest.
    pub(super) fn stop(&mut self) {
        self.velocity = DVec3::ZERO;
        self.acceleration = [DVec3::ZERO; 2];
        (self.turning, self.first_turning) = (DVec3::ZERO, DVec3::ZERO);
        (self.reach, self.turn) = (0.0, 0.0);
    }
}
