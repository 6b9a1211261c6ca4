//! Rigid bodies: mass, inertia, position and motion.

use glam::{DQuat, DVec3};

use super::Shape;

/// A rigid body at one moment, as it is added to a [`World`](super::World) and can be read back from it.
///
/// Bodies of all shapes have the same quantities: a sphere and a set of coordinate axes differ only in their inertia. A body on which no
/// force acts has zero force, and a body at rest has zero velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidBody {
    /// The mass, kg. A body whose mass is not positive does not move.
    pub mass: f64,
    /// The electric charge, C.
    pub charge: f64,
    /// The principal moments of inertia about the center of mass, kg m². No torque can rotate a body about an axis whose moment is zero.
    pub inertia: DVec3,
    /// The rotation from the principal axes of inertia to the body axes. It is the identity, except for compounds and meshes. A world
    /// stores the orientation of the principal axes.
    pub principal_axes: DQuat,
    /// The position of the center of mass, world axes, m.
    pub location: DVec3,
    /// The rotation from body axes to world axes.
    pub orientation: DQuat,
    /// The velocity of the center of mass, world axes, m/s.
    pub velocity: DVec3,
    /// The angular velocity, world axes, rad/s.
    pub angular_velocity: DVec3,
    /// A constant force that acts at the center of mass, world axes, N.
    pub force: DVec3,
    /// A constant torque that acts on the body, world axes, N m.
    pub torque: DVec3,
    /// True for a fixed body: it neither moves nor rotates, whatever its velocity or the forces on it.
    pub fixed: bool,
}

impl RigidBody {
    /// Creates a homogeneous solid of this shape and mass (kg), at rest at the origin, without charge or forces. A body of unbounded
    /// shape, such as a plane, is fixed.
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

    /// Returns the same body with its center of mass at `location`, m.
    #[must_use]
    pub fn with_location(self, location: DVec3) -> Self {
        Self { location, ..self }
    }

    /// Returns the same body with another orientation (the rotation from body axes to world axes).
    #[must_use]
    pub fn with_orientation(self, orientation: DQuat) -> Self {
        Self { orientation, ..self }
    }

    /// Returns the same body with another velocity of its center of mass, world axes, m/s.
    #[must_use]
    pub fn with_velocity(self, velocity: DVec3) -> Self {
        Self { velocity, ..self }
    }

    /// Returns the same body with another angular velocity, world axes, rad/s.
    #[must_use]
    pub fn with_angular_velocity(self, angular_velocity: DVec3) -> Self {
        Self { angular_velocity, ..self }
    }

    /// Returns the same body with another constant force, world axes, N.
    #[must_use]
    pub fn with_force(self, force: DVec3) -> Self {
        Self { force, ..self }
    }

    /// Returns the same body with another constant torque, world axes, N m.
    #[must_use]
    pub fn with_torque(self, torque: DVec3) -> Self {
        Self { torque, ..self }
    }

    /// Returns the same body with another electric charge, C.
    #[must_use]
    pub fn with_charge(self, charge: f64) -> Self {
        Self { charge, ..self }
    }

    /// Returns the same body with other principal moments of inertia, kg m², about the same axes.
    #[must_use]
    pub fn with_inertia(self, inertia: DVec3) -> Self {
        Self { inertia, ..self }
    }

    /// Returns the same body, either fixed or free to move.
    #[must_use]
    pub fn with_fixed(self, fixed: bool) -> Self {
        Self { fixed, ..self }
    }
}

/// The id of a body in its world: its index in the order in which the bodies were added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId(usize);

impl BodyId {
    /// Creates the id of the body with this index.
    #[must_use]
    pub const fn new(index: usize) -> Self {
        Self(index)
    }

    /// Returns the index of the body in every list of bodies: in [`State`](super::State), [`Loads`](super::Loads) and others.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0
    }
}
