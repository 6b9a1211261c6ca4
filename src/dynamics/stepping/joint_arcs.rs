//! The arcs on which joints lead their bodies.
//!
//! Within a step, the physics engine moves the ends of a joint along straight lines. If the bodies rotate, the ends should describe arcs, so they
//! drift apart. The engine then moves the bodies so that the ends meet again.

use glam::DVec3;
use rapier3d_f64::prelude::{GenericJoint, JointAxesMask, JointAxis, Pose, RigidBody};

use super::rotation;

/// The motion of a body at one end of a joint in a step. The default is the world, which rests.
#[derive(Default)]
pub(super) struct EndMotion {
    /// The pose before the step.
    pose: Pose,
    /// The velocity that the engine keeps after the step, m/s, and the angular velocity, rad/s.
    velocity: DVec3,
    turning: DVec3,
    /// How much faster the engine moved the body (m/s) and rotated it (rad/s) than with these velocities.
    correction: DVec3,
    turning_correction: DVec3,
}

impl EndMotion {
    /// Reads a body that the engine has moved from the pose `from` within a step of `dt`, s.
    pub(super) fn new(body: &RigidBody, from: Pose, dt: f64) -> EndMotion {
        let to = body.position();
        let (velocity, turning) = (body.linvel(), body.angvel());
        EndMotion {
            pose: from,
            velocity,
            turning,
            correction: (to.translation - from.translation) / dt - velocity,
            turning_correction: rotation::leading(from.rotation, to.rotation, dt) - turning,
        }
    }

    /// Reads a body with a given motion. The engine corrects neither its place nor its orientation.
    pub(super) fn guided(body: &RigidBody) -> EndMotion {
        EndMotion {
            pose: *body.position(),
            velocity: body.linvel(),
            turning: body.angvel(),
            ..EndMotion::default()
        }
    }

    /// The velocity of the body's point at `place`, the mean velocity on its arc in a step of `dt` minus this velocity, and the correction
    /// there, m/s.
    fn at(&self, place: DVec3, dt: f64) -> [DVec3; 3] {
        let arm = place - self.pose.translation;
        let around = self.turning.cross(arm);
        [
            self.velocity + around,
            0.5 * dt * self.turning.cross(around),
            self.correction + self.turning_correction.cross(arm),
        ]
    }
}

/// Returns the velocity with which the ends of a joint drift apart in a step of `dt`, s, because they move along straight lines, and the velocity
/// with which the engine moves the ends towards each other, m/s. Both are relative velocities in the directions that the joint does not leave free.
/// `None` for a rope that is not taut.
pub(super) fn drift(joint: &GenericJoint, [one, two]: &[EndMotion; 2], dt: f64) -> Option<[DVec3; 2]> {
    let frame = one.pose * joint.local_frame1;
    let place = (two.pose * joint.local_frame2).translation;
    let [velocity, arc, correction] = two.at(place, dt);
    if !joint.coupled_axes.is_empty() {
        // A rod or a rope: only the distance between the ends counts. It grows by ½ (v dt)²/L if they move across it with relative velocity v.
        if !joint.limit_axes.is_empty() && joint.limits[JointAxis::LinX as usize].impulse == 0.0 {
            return None;
        }
        let between = place - frame.translation;
        let [first_velocity, first_arc, first_correction] = one.at(frame.translation, dt);
        let across = (velocity - first_velocity).reject_from(between).length_squared();
        let along = between.normalize();
        let drift = (arc - first_arc).dot(along) + 0.5 * dt * across / between.length();
        return Some([drift * along, -(correction - first_correction).dot(along) * along]);
    }
    // The point of the first body at the second end also moves along an arc, and takes the joint's axis with it.
    let [first_velocity, first_arc, first_correction] = one.at(place, dt);
    let drift = arc - first_arc - dt * one.turning.cross(velocity - first_velocity);
    let held = |vector: DVec3| {
        let mut own = frame.rotation.conjugate() * vector;
        let free = |axis: JointAxesMask| !joint.locked_axes.contains(axis);
        let axes = [JointAxesMask::LIN_X, JointAxesMask::LIN_Y, JointAxesMask::LIN_Z];
        axes.into_iter().enumerate().filter(|(_, axis)| free(*axis)).for_each(|(k, _)| own[k] = 0.0);
        own
    };
    Some([held(drift), held(first_correction - correction)])
}
