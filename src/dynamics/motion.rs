//! Given motion, which does not follow from forces.

use glam::{DQuat, DVec3};

/// The pose and the motion of a body at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinematics {
    /// The location of the centre of mass, m.
    pub location: DVec3,
    /// Its velocity, m/s.
    pub velocity: DVec3,
    /// Its acceleration, m/s².
    pub acceleration: DVec3,
    /// The orientation (`world_from_body`).
    pub orientation: DQuat,
    /// The angular velocity, world axes, rad/s.
    pub angular_velocity: DVec3,
}

/// A given motion: the position of a body at any time, regardless of forces.
pub trait Motion: Send + Sync {
    /// The pose and the motion of the body at time `t`, s. Velocities and acceleration must be the derivatives of the pose.
    fn at(&self, t: f64) -> Kinematics;

    /// The angular acceleration at time `t`, world axes, rad/s²: the derivative of the angular velocity.
    fn angular_acceleration(&self, t: f64) -> DVec3;
}
