//! The description of a rigid body at one moment.

use glam::{DQuat, DVec3};

use super::Shape;

/// A rigid body at one moment, as it enters a [`World`](super::World) and can be read back from it.
///
/// All bodies are alike: only the inertia distinguishes a sphere from an axes triad. A body without a force has zero force, and a body at
/// rest has zero velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidBody {
    /// Mass, kg. A body whose mass is not positive does not move.
    pub mass: f64,
    /// Electric charge, C.
    pub charge: f64,
    /// Principal moments of inertia about the centre of mass, kg m². No torque rotates a body about an axis whose moment is zero.
    pub inertia: DVec3,
    /// The rotation from the principal axes of inertia to the body's frame. It is the identity, except for compounds and meshes. A world
    /// stores the orientation of the principal axes.
    pub principal_axes: DQuat,
    /// Location of the centre of mass, m.
    pub location: DVec3,
    /// Orientation: the rotation from the body's frame to the world's (`world_from_body`).
    pub orientation: DQuat,
    /// Velocity of the centre of mass, m/s.
    pub velocity: DVec3,
    /// Angular velocity, world axes, rad/s.
    pub angular_velocity: DVec3,
    /// A constant force at the centre of mass, world axes, N.
    pub force: DVec3,
    /// A constant torque, world axes, N m.
    pub torque: DVec3,
    /// A fixed body neither moves nor rotates, whatever its velocity or the forces on it.
    pub fixed: bool,
}

impl RigidBody {
    /// A homogeneous solid of `shape` and `mass` (kg), at rest at the origin, without charge or forces. A body of unbounded shape is
    /// fixed.
    #[must_use]
    pub fn new(shape: &Shape, mass: f64) -> Self {
        Self {
            mass,
            charge: 0.0,
            inertia: shape.inertia(mass),
            principal_axes: shape.principal_axes(),
            location: DVec3::ZERO,
            orientation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            force: DVec3::ZERO,
            torque: DVec3::ZERO,
            fixed: shape.is_unbounded(),
        }
    }

    /// The same body with its centre of mass at `location`, m.
    #[must_use]
    pub fn with_location(self, location: DVec3) -> Self {
        Self { location, ..self }
    }

    /// The same body with `orientation` (`world_from_body`).
    #[must_use]
    pub fn with_orientation(self, orientation: DQuat) -> Self {
        Self { orientation, ..self }
    }

    /// The same body moving at `velocity`, m/s.
    #[must_use]
    pub fn with_velocity(self, velocity: DVec3) -> Self {
        Self { velocity, ..self }
    }

    /// The same body rotating at `angular_velocity`, world axes, rad/s.
    #[must_use]
    pub fn with_angular_velocity(self, angular_velocity: DVec3) -> Self {
        Self { angular_velocity, ..self }
    }

    /// The same body under the constant `force`, world axes, N.
    #[must_use]
    pub fn with_force(self, force: DVec3) -> Self {
        Self { force, ..self }
    }

    /// The same body under the constant `torque`, world axes, N m.
    #[must_use]
    pub fn with_torque(self, torque: DVec3) -> Self {
        Self { torque, ..self }
    }

    /// The same body with the electric `charge`, C.
    #[must_use]
    pub fn with_charge(self, charge: f64) -> Self {
        Self { charge, ..self }
    }

    /// The same body with other principal moments of inertia, kg m², about the same axes.
    #[must_use]
    pub fn with_inertia(self, inertia: DVec3) -> Self {
        Self { inertia, ..self }
    }

    /// The same body, fixed or free.
    #[must_use]
    pub fn with_fixed(self, fixed: bool) -> Self {
        Self { fixed, ..self }
    }
}

/// The id of a body within its world: its index, in the order in which bodies were added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId(usize);

impl BodyId {
    /// The id of the body with this index.
    #[must_use]
    pub const fn new(index: usize) -> Self {
        Self(index)
    }

    /// The index of the body in every list of bodies: in [`State`](super::State), [`Loads`](super::Loads), …
    #[must_use]
    pub const fn index(self) -> usize {
        self.0
    }
}
