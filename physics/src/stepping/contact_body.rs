//! What a callback for a contact needs to know of each body.

use glam::DVec3;
use rapier3d_f64::prelude::{AngularInertia, RigidBody};

/// The motion of a body in contact, and its response to impulses.
pub(super) struct ContactBody {
    centre: DVec3,
    velocity: DVec3,
    angular_velocity: DVec3,
    inverse_mass: f64,
    inverse_inertia: AngularInertia,
}

impl ContactBody {
    /// Reads a body at the start of a step of `dt`, s. Its velocity is the one after the step without contacts.
    pub(super) fn new(body: &RigidBody, dt: f64) -> ContactBody {
        let properties = body.mass_properties();
        ContactBody {
            centre: body.translation(),
            velocity: body.linvel() + dt * properties.effective_inv_mass * body.user_force(),
            angular_velocity: body.angvel(),
            inverse_mass: properties.effective_inv_mass.x,
            inverse_inertia: properties.effective_world_inv_inertia,
        }
    }

    /// The velocity of the body's point at `place`, m/s.
    pub(super) fn velocity(&self, place: DVec3) -> DVec3 {
        self.velocity + self.angular_velocity.cross(place - self.centre)
    }

    /// The change of the velocity at one place (m/s) that an impulse (N s) at another place causes.
    pub(super) fn response(&self, impulse: DVec3, [from, to]: [DVec3; 2]) -> DVec3 {
        let turning = self.inverse_inertia * (from - self.centre).cross(impulse);
        self.inverse_mass * impulse + turning.cross(to - self.centre)
    }

    /// The mean velocity in a step of `dt`, s, of a point of the rotating body on its arc, minus the velocity at the start of the arc, m/s.
    pub(super) fn arc(&self, place: DVec3, dt: f64) -> DVec3 {
        let turning = self.angular_velocity;
        0.5 * dt * turning.cross(turning.cross(place - self.centre))
    }
}
