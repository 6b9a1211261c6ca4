//! The arcs on which joints lead their bodies.
//!
//! Within a step, the physics engine moves the ends of a joint along straight lines. If the bodies rotate, the ends should describe arcs, so they
//! drift apart. The engine then moves the bodies so that the ends meet again.

use glam::DVec3;
use rapier3d_f64::prelude::{AngularInertia, GenericJoint, JointAxesMask, JointAxis, Pose, RigidBody};

use super::rotation;

/// The motion of a body at one end of a joint in a step. The default is the world, which rests.
#[derive(Default)]
pub(super) struct EndMotion {
    /// The pose before the step.
    pose: Pose,
    /// The mean velocity in the step, m/s, and the mean angular velocity, rad/s.
    velocity: DVec3,
    turning: DVec3,
    /// The mass, kg, and the inverse inertia of a body that forces move.
    mass: Option<(f64, AngularInertia)>,
}

impl EndMotion {
    /// Reads a body that the engine has moved from the pose `from` within a step of `dt`, s.
    pub(super) fn new(body: &RigidBody, from: Pose, dt: f64) -> EndMotion {
        let to = body.position();
        EndMotion {
            pose: from,
            velocity: (to.translation - from.translation) / dt,
            turning: rotation::leading(from.rotation, to.rotation, dt),
            mass: Some((body.mass(), body.mass_properties().effective_world_inv_inertia)),
        }
    }

    /// Reads a body that has followed a given motion in a step of `dt`, s.
    pub(super) fn guided(body: &RigidBody, dt: f64) -> EndMotion {
        let (to, velocity, turning) = (body.position(), body.linvel(), body.angvel());
        let from = rotation::advanced(to.rotation, -turning, dt);
        let pose = Pose::from_parts(to.translation - dt * velocity, from);
        EndMotion { pose, velocity, turning, mass: None }
    }

    /// The radius of gyration of the body about an axis through `place`, m; 0 if forces do not move it.
    fn gyration(&self, place: DVec3, axis: DVec3) -> f64 {
        let Some((mass, inverse_inertia)) = self.mass else { return 0.0 };
        let arm = (place - self.pose.translation).reject_from_normalized(axis);
        (arm.length_squared() + 1.0 / (mass * axis.dot(inverse_inertia * axis))).sqrt()
    }

    /// The velocity of the body's point at `place`, and the mean velocity on its arc in a step of `dt` minus this velocity, m/s.
    fn at(&self, place: DVec3, dt: f64) -> [DVec3; 2] {
        let around = self.turning.cross(place - self.pose.translation);
        [self.velocity + around, 0.5 * dt * self.turning.cross(around)]
    }
}

/// The motion of the ends of a joint relative to each other, in the directions that the joint does not leave free, m/s.
pub(super) struct Drift {
    /// The velocity with which the ends drift apart, because they move along straight lines.
    pub(super) drift: DVec3,
    /// The velocity with which the engine moves the ends towards each other.
    pub(super) back: DVec3,
    /// For a hinge at its limit, the velocity of its turn, at the larger radius of gyration of its two bodies.
    pub(super) turn: f64,
}

/// Returns the motion of the ends of a joint within a step of `dt`, s; `None` for a rope that is not taut. `is_at_limit` tells whether a hinge or
/// slider is at its limit.
pub(super) fn drift(
    joint: &GenericJoint,
    is_at_limit: bool,
    [one, two]: &[EndMotion; 2],
    dt: f64,
) -> Option<Drift> {
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
        return Some(Drift { drift: drift * along, back: -moving.dot(along) * along, turn: 0.0 });
    }
    // The point of the first body at the second end also moves along an arc, and takes the joint's axis with it.
    let [first_velocity, first_arc] = one.at(place, dt);
    let moving = velocity - first_velocity;
    let drift = arc - first_arc - dt * one.turning.cross(moving);
    let is_held = |axis: JointAxesMask| {
        joint.locked_axes.contains(axis) || is_at_limit && joint.limit_axes.contains(axis)
    };
    let held = |vector: DVec3| {
        let mut own = frame.rotation.conjugate() * vector;
        let axes = [JointAxesMask::LIN_X, JointAxesMask::LIN_Y, JointAxesMask::LIN_Z];
        axes.into_iter().enumerate().filter(|(_, axis)| !is_held(*axis)).for_each(|(k, _)| own[k] = 0.0);
        own
    };
    let is_turn_held = is_held(JointAxesMask::ANG_X) && !joint.locked_axes.contains(JointAxesMask::ANG_X);
    let axis = frame.rotation * DVec3::X;
    let turn =
        (two.turning - one.turning).dot(axis) * one.gyration(place, axis).max(two.gyration(place, axis));
    Some(Drift { drift: held(drift), back: held(-moving), turn: if is_turn_held { turn } else { 0.0 } })
}
