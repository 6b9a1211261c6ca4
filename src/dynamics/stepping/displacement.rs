//! The velocities of bodies that joints hold.
//!
//! The physics engine solves each step twice: first with a correction of the joints' errors of position, then without it. It moves the
//! bodies by the first solution, and keeps the velocities of the second one. These are perpendicular to the joints' levers at the start of
//! the step. The levers rotate by an angle φ within the step, so the next step would take 1 − cos φ of the speed away, and pendulums would
//! lose their energy: a body of angular velocity ω by ½ ω² Δt of its speed per second.
//!
//! The displacement in the step, divided by its length, is the mean velocity. With it, a step is symmetric in time, and no energy is lost:
//! it is the method SHAKE, with a linearised constraint. Source: E. Hairer, C. Lubich and G. Wanner, *Geometric Numerical Integration*,
//! VII.1.4. So bodies on joints get their mean velocity, unless contacts, limits or overstretched ropes push them. Those push bodies apart
//! without a lasting velocity.

use glam::DVec3;
use rapier3d_f64::prelude::{JointAxis, PhysicsWorld, Pose, RigidBody};

use super::super::{Model, State};
use super::joint::Joints;
use super::touch::Touch;
use super::{bodies, spin};

/// The largest excess length of a rope that still counts as the effect of its rotation, relative to that effect.
const ROTATION: f64 = 4.0;
/// The largest excess length of a rope that has no effect, relative to the length of the rope.
const TAUT: f64 = 1e-7;

/// Tells which bodies get their mean velocity.
pub(super) struct Displacement {
    /// For each joint, whether it is a rope that was longer at the start of the step than its rotation explains.
    overstretched: Vec<bool>,
    /// For each body, whether a joint holds it.
    held: Vec<bool>,
    /// For each body, whether it gets its mean velocity after the present step.
    gets_mean: Vec<bool>,
}

impl Displacement {
    pub(super) fn new(bodies: usize, joints: &Joints) -> Displacement {
        let held = joints.held(bodies);
        Displacement { overstretched: vec![false; joints.len()], gets_mean: held.clone(), held }
    }

    /// Measures the ropes at the start of a step of `dt`, s.
    ///
    /// If the ends move across the rope with relative velocity v, a step makes a taut rope of length L longer by ½ (v dt)²/L.
    pub(super) fn begin(
        &mut self,
        engine: &PhysicsWorld,
        joints: &Joints,
        (model, state): (&Model, &State),
        dt: f64,
    ) {
        for (k, overstretched) in self.overstretched.iter_mut().enumerate() {
            let Some(joint) = joints.get(engine, k).filter(|joint| !joint.coupled_axes.is_empty()) else {
                continue;
            };
            let end = |side: usize, frame: Pose| match joints.bodies(k)[side] {
                Some(body) => {
                    let place = bodies::pose(state, body) * frame.translation;
                    let arm = place - state.location[body];
                    (place, state.velocity[body] + model.angular_velocity(body, state).cross(arm))
                }
                None => (frame.translation, DVec3::ZERO),
            };
            let (one, two) = (end(0, joint.local_frame1), end(1, joint.local_frame2));
            let (between, velocity) = (two.0 - one.0, two.1 - one.1);
            let length = joint.limits[JointAxis::LinX as usize].max;
            let across = velocity.reject_from(between).length_squared() * dt * dt;
            let by_rotation = 0.5 * across / between.length();
            *overstretched = between.length() - length > ROTATION * by_rotation + TAUT * length;
        }
    }

    /// Finds the bodies that get their mean velocity, after the physics engine has made a step.
    pub(super) fn end(&mut self, engine: &PhysicsWorld, joints: &Joints) {
        self.gets_mean.clone_from(&self.held);
        for (k, overstretched) in self.overstretched.iter().enumerate() {
            let Some(joint) = joints.get(engine, k) else { continue };
            let is_rope = !joint.coupled_axes.is_empty();
            let is_pushing = joint.limits.iter().any(|limit| limit.impulse != 0.0);
            if is_pushing && (!is_rope || *overstretched) {
                joints.bodies(k).into_iter().flatten().for_each(|body| self.gets_mean[body] = false);
            }
        }
    }

    /// Returns the mean velocity and the mean angular velocity of a body in a step of `dt`, as the physics engine counts it. `from` is the
    /// pose of the body in the engine before the step. `None` if the body keeps the velocities of the engine.
    pub(super) fn mean(
        &self,
        engine: &PhysicsWorld,
        i: usize,
        body: &RigidBody,
        from: Pose,
        dt: f64,
    ) -> Option<(DVec3, DVec3)> {
        if !self.gets_mean[i] || is_touched(engine, body) {
            return None;
        }
        let to = body.position();
        Some(((to.translation - from.translation) / dt, spin::leading(from.rotation, to.rotation, dt)))
    }
}

/// Returns true if any contact pushed a body in the last step.
fn is_touched(engine: &PhysicsWorld, body: &RigidBody) -> bool {
    let pairs =
        body.colliders().iter().flat_map(|collider| engine.narrow_phase.contact_pairs_with(*collider));
    pairs.flat_map(Touch::of_pair).any(|touch| touch.push().is_some())
}
