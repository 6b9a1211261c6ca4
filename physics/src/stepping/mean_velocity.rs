//! The velocities of bodies that joints hold.
//!
//! The physics engine solves each step twice: first with a correction of the joints' errors of position, then without it. It moves the
//! bodies by the first solution, and keeps the velocities of the second one. These velocities are perpendicular to the joints' levers at
//! the start of the step. The levers rotate by an angle φ within the step, so the next step multiplies the speed by cos φ. A pendulum
//! would lose its energy: at the angular velocity ω, the speed would fall by the part ½ ω² Δt in each second.
//!
//! The mean velocity of a step is its displacement divided by its duration. With this velocity, the step is symmetric in time, and loses no
//! energy. This is the method SHAKE with linearised constraints. Source: E. Hairer, C. Lubich and G. Wanner, *Geometric Numerical
//! Integration*, VII.1.4. So bodies on joints get their mean velocity. They do not get it if a contact, a limit that has just been hit or an
//! overstretched rope pushes them. The engine then moves them to correct an overlap or a length, and this displacement must not become a
//! velocity.
//!
//! Either all bodies of a mechanism get their mean velocity, or none of them. Otherwise a joint would act on one of its bodies and not on the other one, and the mechanism would gain or lose momentum.

use std::f64::consts::TAU;

use glam::DVec3;
use rapier3d_f64::prelude::{JointAxesMask, JointAxis, PhysicsWorld, Pose, RigidBody, RigidBodyHandle};

use super::super::{Model, State};
use super::joint::Joints;
use super::joint_arcs::{self, Drift, EndMotion};
use super::mechanisms::Mechanisms;
use super::touch::Touch;
use super::{bodies, rotation};

/// The largest excess length of a rope that still counts as the effect of the rope's rotation, as a multiple of that effect.
const MAX_ROTATION_STRETCH: f64 = 4.0;
/// The ends of a mechanism's joints drift apart in a step, and the engine moves them towards each other. Each of the two motions is one
/// vector, with the components of all joints. The motions count as equal if the cosine of the angle between them is at least this, and if
/// [`MAX_SQUARED_RATIO`] allows it.
const PARALLEL_COSINE: f64 = 0.95;
/// The largest ratio of the square of the second motion to the square of the first motion.
const MAX_SQUARED_RATIO: f64 = 2.0;
/// The largest rotation of a body within a step, rad, with which its mechanism gets mean velocities. With a larger rotation, the mechanism
/// keeps the velocities of the engine, because mean velocities make such steps unstable.
const MAX_AVERAGED_ROTATION: f64 = 0.2;
/// The largest excess length of a rope that has no effect, as a fraction of the rope's length.
const ROPE_LENGTH_TOLERANCE: f64 = 1e-7;

/// A body after a step of the physics engine.
pub(super) struct Stepped<'a> {
    /// The body in the engine.
    pub(super) body: &'a RigidBody,
    /// Its pose before the step.
    pub(super) from: Pose,
    /// Whether the engine stopped it at a surface.
    pub(super) is_stopped: bool,
}

/// Tells which bodies get their mean velocity.
pub(super) struct MeanVelocity {
    /// For each joint, whether at the start of the step it was a rope that was longer than its rotation explains, or a hinge or slider at
    /// its limit.
    is_stopped: Vec<bool>,
    mechanisms: Mechanisms,
    /// For each body that only hinges to the world hold, the axis of the last one, a unit vector in the engine's frame of the body. Hinges to
    /// fixed and guided bodies count as well. Such a body gets the mean of its angular velocity about this axis only, because the small
    /// moments of inertia of rods would make errors about other axes grow. Two movable bodies on one hinge get the mean about all axes. If
    /// they did not, their changes of angular momentum would not cancel.
    axis: Vec<Option<DVec3>>,
    /// For each body, whether it gets its mean velocity after the present step.
    gets_mean: Vec<bool>,
}

impl MeanVelocity {
    pub(super) fn new(
        engine: &PhysicsWorld,
        joints: &Joints,
        mechanisms: Mechanisms,
        bodies: usize,
    ) -> MeanVelocity {
        let mut axis = joints.hinge_axes(engine, bodies);
        (0..bodies).filter(|&body| mechanisms.is_joined(body)).for_each(|body| axis[body] = None);
        MeanVelocity {
            is_stopped: vec![false; joints.len()],
            mechanisms,
            axis,
            gets_mean: vec![false; bodies],
        }
    }

    /// Whether a body can move and is held by a joint.
    pub(super) fn is_held(&self, body: usize) -> bool {
        self.mechanisms.is_held(body)
    }

    /// Whether a body has got its mean velocity in the last step, and a motor moves its mechanism.
    pub(super) fn is_led_by_motors(&self, body: usize) -> bool {
        self.gets_mean[body] && self.mechanisms.has_motor(body)
    }

    /// Measures the ropes and the limits of joints at the start of a step of `dt`, s.
    ///
    /// If the ends move across the rope with relative velocity v, a step makes a taut rope of length L longer by ½ (v dt)²/L. Returns the
    /// largest of these lengths, m.
    pub(super) fn begin(
        &mut self,
        engine: &PhysicsWorld,
        joints: &Joints,
        (model, state): (&Model, &State),
        dt: f64,
    ) -> f64 {
        let mut longest = 0.0_f64;
        for (k, is_stopped) in self.is_stopped.iter_mut().enumerate() {
            let Some(joint) = joints.get(engine, k).filter(|joint| !joint.limit_axes.is_empty()) else {
                continue;
            };
            let end = |side: usize, frame: Pose| match joints.bodies(k)[side] {
                Some(body) => {
                    let pose = bodies::pose(state, body) * frame;
                    let arm = pose.translation - state.location[body];
                    (pose, state.velocity[body] + model.angular_velocity(body, state).cross(arm))
                }
                None => (frame, DVec3::ZERO),
            };
            let (one, two) = (end(0, joint.local_frame1), end(1, joint.local_frame2));
            let (between, velocity) = (two.0.translation - one.0.translation, two.1 - one.1);
            let limits = |axis: JointAxis| joint.limits[axis as usize];
            *is_stopped = if !joint.coupled_axes.is_empty() {
                let length = limits(JointAxis::LinX).max;
                let across = velocity.reject_from(between).length_squared() * dt * dt;
                let by_rotation = 0.5 * across / between.length();
                if between.length() + by_rotation >= length {
                    longest = longest.max(by_rotation);
                }
                between.length() - length
                    > MAX_ROTATION_STRETCH * by_rotation + ROPE_LENGTH_TOLERANCE * length
            } else if joint.limit_axes == JointAxesMask::LIN_X {
                let limits = limits(JointAxis::LinX);
                let place = between.dot(one.0.rotation * DVec3::X);
                place <= limits.min || place >= limits.max
            } else {
                let limits = limits(JointAxis::AngX);
                let turn = one.0.rotation.conjugate() * two.0.rotation;
                let angle = 2.0 * libm::atan2(turn.x, turn.w);
                let middle = 0.5 * (limits.min + limits.max);
                libm::remainder(angle - middle, TAU).abs() >= 0.5 * (limits.max - limits.min)
            };
        }
        longest
    }

    /// Finds the bodies that get their mean velocity, after the physics engine has made a step of `dt`, s. `handles` holds the engine's handle
    /// of each body. `stepped` returns what is known of a body after the step.
    ///
    /// The engine moves the ends of joints towards each other because they have drifted apart on straight lines instead of arcs, or because
    /// joints give way. A motion of the second kind must not become a velocity.
    pub(super) fn end<'a>(
        &mut self,
        (engine, handles): (&'a PhysicsWorld, &[RigidBodyHandle]),
        joints: &Joints,
        stepped: impl Fn(usize) -> Option<Stepped<'a>>,
        dt: f64,
    ) {
        let Self { is_stopped, mechanisms, gets_mean, .. } = self;
        let mut excluded = vec![false; gets_mean.len()];
        for i in mechanisms.held() {
            let Some(Stepped { body, is_stopped, .. }) = stepped(i) else { continue };
            excluded[mechanisms.number(i)] |= is_stopped
                || body.angvel().length_squared() * dt * dt > MAX_AVERAGED_ROTATION * MAX_AVERAGED_ROTATION
                || is_touched(engine, handles, body);
        }
        // For each mechanism, the sums of a·a, a·b and b·b over its joints. a is the velocity with which the ends drift apart, and b is the one with
        // which the engine moves them towards each other.
        let mut motions = vec![[0.0; 3]; gets_mean.len()];
        for (k, &is_stopped) in is_stopped.iter().enumerate() {
            let ends = joints.bodies(k);
            let held = ends.into_iter().flatten().find(|&body| mechanisms.is_held(body));
            let (Some(joint), Some(held)) = (joints.get(engine, k), held) else { continue };
            let end = |body: Option<usize>| {
                let stepped = body.and_then(&stepped);
                stepped.map_or_else(EndMotion::default, |Stepped { body, from, .. }| {
                    if body.is_dynamic() {
                        EndMotion::new(body, from, dt)
                    } else {
                        EndMotion::guided(body, dt)
                    }
                })
            };
            let is_rope = !joint.coupled_axes.is_empty();
            excluded[mechanisms.number(held)] |= is_stopped && is_rope;
            let is_at_limit = is_stopped || joint.limits.iter().any(|limit| limit.impulse != 0.0);
            let Some(ends) = joint_arcs::drift(joint, is_at_limit, &ends.map(end), dt) else { continue };
            let Drift { drift, back, turn } = ends;
            let products = [drift.length_squared(), drift.dot(back), back.length_squared() + turn * turn];
            for (sum, product) in motions[mechanisms.number(held)].iter_mut().zip(products) {
                *sum += product;
            }
        }
        for i in mechanisms.held() {
            let number = mechanisms.number(i);
            let [drift, product, back] = motions[number];
            let are_equal =
                product >= PARALLEL_COSINE * (drift * back).sqrt() && back <= MAX_SQUARED_RATIO * drift;
            gets_mean[i] = are_equal && !excluded[number];
        }
    }

    /// Returns the mean velocity and the mean angular velocity of a body in a step of `dt`, as the engine counts it. `from` is the pose of
    /// the body in the engine before the step, and `turning` is the angular velocity that the engine gave it. `None` if the body keeps the
    /// velocities of the engine.
    pub(super) fn mean(
        &self,
        (i, body): (usize, &RigidBody),
        from: Pose,
        turning: DVec3,
        dt: f64,
    ) -> Option<(DVec3, DVec3)> {
        if !self.gets_mean[i] {
            return None;
        }
        let to = body.position();
        let velocity = (to.translation - from.translation) / dt;
        let mean = rotation::leading(from.rotation, to.rotation, dt);
        let mean = match self.axis[i] {
            None => mean,
            Some(axis) => {
                let axis = from.rotation * axis;
                turning + (mean - turning).dot(axis) * axis
            }
        };
        Some((velocity, mean))
    }
}

/// Returns true if any contact may have pushed a body in the last step.
///
/// The engine keeps only the impulses of its second solution. A contact that has pushed in the first solution, and so has moved the body,
/// leaves no gap.
fn is_touched(engine: &PhysicsWorld, handles: &[RigidBodyHandle], body: &RigidBody) -> bool {
    let pose = |body: usize| {
        let body = engine.bodies.get(handles[body])?;
        body.is_dynamic().then(|| *body.position())
    };
    let pairs =
        body.colliders().iter().flat_map(|collider| engine.narrow_phase.contact_pairs_with(*collider));
    let slop = engine.integration_parameters.allowed_linear_error();
    pairs.flat_map(Touch::of_pair).any(|touch| touch.push().is_some() || touch.depth(pose) > -slop)
}
