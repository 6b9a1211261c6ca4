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
    /// The mean velocity in the step, m/s, and the mean angular velocity, rad/s.
    velocity: DVec3,
    turning: DVec3,
}

impl EndMotion {
    /// Reads a body that the engine has moved from the pose `from` within a step of `dt`, s.
    pub(super) fn new(body: &RigidBody, from: Pose, dt: f64) -> EndMotion {
        let to = body.position();
        EndMotion {
            pose: from,
            velocity: (to.translation - from.translation) / dt,
            turning: rotation::leading(from.rotation, to.rotation, dt),
        }
    }

    /// Reads a body that has followed a given motion in a step of `dt`, s.
    pub(super) fn guided(body: &RigidBody, dt: f64) -> EndMotion {
        let (to, velocity, turning) = (body.position(), body.linvel(), body.angvel());
        let from = rotation::advanced(to.rotation, -turning, dt);
        EndMotion { pose: Pose::from_parts(to.translation - dt * velocity, from), velocity, turning }
    }

    /// The velocity of the body's point at `place`, and the mean velocity on its arc in a step of `dt` minus this velocity, m/s.
    fn at(&self, place: DVec3, dt: f64) -> [DVec3; 2] {
        let around = self.turning.cross(place - self.pose.translation);
        [self.velocity + around, 0.5 * dt * self.turning.cross(around)]
    }
}

/// Returns the velocity with which the ends of a joint drift apart in a step of `dt`, s, because they move along straight lines, and the velocity
/// with which the engine moves the ends towards each other, m/s. Both are relative velocities in the directions that the joint does not leave free.
/// `None` for a rope that is not taut.
pub(super) fn drift(joint: &GenericJoint, [one, two]: &[EndMotion; 2], dt: f64) -> Option<[DVec3; 2]> {
    let frame = one.pose * joint.local_frame1;
    let place = (two.pose * joint.local_frame2).translation;
    let [velocity, arc] = two.at(place, dt);
    if !joint.coupled_axes.is_empty() {
        // A rod or a rope: only the distance between the ends counts. It grows by ½ (v dt)²/L if they move across it with relative velocity v.
        if !joint.limit_axes.is_empty() && joint.limits[JointAxis::LinX as usize].impulse == 0.0 {
            return None;
        }
        let between = place - frame.translation;
        let [first_velocity, first_arc] = one.at(frame.translation, dt);
        let moving = velocity - first_velocity;
        let along = between.normalize();
        let across = moving.reject_from_normalized(along).length_squared();
        let drift = (arc - first_arc).dot(along) + 0.5 * dt * across / between.length();
        return Some([drift * along, -moving.dot(along) * along]);
    }
    // The point of the first body at the second end also moves along an arc, and takes the joint's axis with it.
    let [first_velocity, first_arc] = one.at(place, dt);
    let moving = velocity - first_velocity;
    let drift = arc - first_arc - dt * one.turning.cross(moving);
    let held = |vector: DVec3| {
        let mut own = frame.rotation.conjugate() * vector;
        let free = |axis: JointAxesMask| !joint.locked_axes.contains(axis);
        let axes = [JointAxesMask::LIN_X, JointAxesMask::LIN_Y, JointAxesMask::LIN_Z];
        axes.into_iter().enumerate().filter(|(_, axis)| free(*axis)).for_each(|(k, _)| own[k] = 0.0);
        own
    };
    Some([held(drift), held(-moving)])
}
