//! The values that each body gets from outside the physics engine in a step.

use glam::DVec3;
use rapier3d_f64::prelude::{PhysicsWorld, RigidBody, RigidBodyHandle};

/// Two angular velocities count as equal if their relative difference is at most this.
const ANGULAR_VELOCITY_TOLERANCE: f64 = 1e-14;

/// The values of a body that are set in the physics engine.
///
/// They are kept here, too. To write a value to the engine takes time, so unchanged values are not written again. To read a value from the
/// engine takes time as well, since the engine's bodies are large.
#[derive(Clone, Copy)]
pub(super) struct EngineInput {
    /// The force, world axes, N.
    pub(super) force: DVec3,
    /// The angular velocity, world axes, rad/s.
    pub(super) turning: DVec3,
    /// Whether the engine looks for surfaces in the body's path, because the body is fast.
    pub(super) is_fast: bool,
}

impl EngineInput {
    /// Reads the values of all bodies.
    pub(super) fn read_all(engine: &PhysicsWorld, handles: &[RigidBodyHandle]) -> Vec<EngineInput> {
        let none = EngineInput { force: DVec3::ZERO, turning: DVec3::ZERO, is_fast: false };
        handles.iter().map(|handle| engine.bodies.get(*handle).map_or(none, EngineInput::read)).collect()
    }

    /// Reads the values of a body.
    pub(super) fn read(body: &RigidBody) -> EngineInput {
        EngineInput { force: body.user_force(), turning: body.angvel(), is_fast: body.is_ccd_enabled() }
    }

    /// Returns true if `wanted` has the same values, up to rounding errors of the angular velocity.
    pub(super) fn is_same(&self, wanted: &EngineInput) -> bool {
        let difference = (self.turning - wanted.turning).length_squared();
        self.force == wanted.force
            && self.is_fast == wanted.is_fast
            && difference
                <= ANGULAR_VELOCITY_TOLERANCE * ANGULAR_VELOCITY_TOLERANCE * wanted.turning.length_squared()
    }

    /// Sets the values of a body.
    pub(super) fn write(&self, body: &mut RigidBody) {
        body.reset_forces(false);
        body.add_force(self.force, false);
        body.set_angvel(self.turning, false);
        body.enable_ccd(self.is_fast);
    }
}
