//! Motions of bodies that are given as functions of time and do not follow from forces.

use glam::{DQuat, DVec3};

/// A twist: the velocity of a body, m/s, and its angular velocity, rad/s, both in world axes.
pub(super) type Twist = (DVec3, DVec3);

/// The pose, the velocities and the acceleration of a body at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinematics {
    /// The position of the center of mass, world axes, m.
    pub location: DVec3,
    /// The velocity of the center of mass, world axes, m/s.
    pub velocity: DVec3,
    /// The acceleration of the center of mass, world axes, m/s².
    pub acceleration: DVec3,
    /// The rotation from body axes to world axes.
    pub orientation: DQuat,
    /// The angular velocity of the body, world axes, rad/s.
    pub angular_velocity: DVec3,
}

/// A given motion of a body: its pose at any time, regardless of forces.
pub trait Motion: Send + Sync {
    /// Returns the pose and the motion of the body at time `t`, s. Velocities and acceleration must be the derivatives of the pose.
    fn at(&self, t: f64) -> Kinematics;

    /// Returns the angular acceleration of the body at time `t` (s), world axes, rad/s²: the derivative of the angular velocity.
    fn angular_acceleration(&self, t: f64) -> DVec3;
}
