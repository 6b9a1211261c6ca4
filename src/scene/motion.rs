//! Motion that is given: a body goes where the scene says, whatever acts on it.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::timed::{Timed, TimedVector};
use crate::dynamics::{Kinematics, Motion, Track};

/// A motion that is given.
#[derive(Clone, Debug)]
pub enum BodyMotion {
    /// By formulas in the time.
    Formula {
        /// The centre of mass, m.
        location: TimedVector,
        /// How the body is turned.
        orientation: TimedOrientation,
    },
    /// Through known places.
    Track(Arc<Track>),
}

impl BodyMotion {
    /// The place of the body at a time (s): its centre of mass (m), and its orientation.
    pub fn place(&self, t: f64) -> (DVec3, DQuat) {
        match self {
            BodyMotion::Formula { location, orientation } => (location.at(t), orientation.at(t).0),
            BodyMotion::Track(track) => {
                let pose = track.at(t);
                (pose.location, pose.orientation)
            }
        }
    }
}

impl Motion for BodyMotion {
    fn at(&self, t: f64) -> Kinematics {
        match self {
            BodyMotion::Track(track) => track.at(t),
            BodyMotion::Formula { location, orientation } => {
                let (orientation, angular_velocity) = orientation.at(t);
                Kinematics {
                    location: location.at(t),
                    velocity: location.rate(t),
                    acceleration: location.curvature(t),
                    orientation,
                    angular_velocity,
                }
            }
        }
    }

    fn angular_acceleration(&self, t: f64) -> DVec3 {
        match self {
            BodyMotion::Track(track) => track.angular_acceleration(t),
            BodyMotion::Formula { orientation, .. } => orientation.angular_acceleration(t),
        }
    }
}

/// An orientation that may change with time.
#[derive(Clone, Debug)]
pub enum TimedOrientation {
    /// Turned about the world's x, then y, then z, degrees.
    Euler(TimedVector),
    /// Turned about an axis.
    Axis {
        /// The axis, a unit vector.
        axis: DVec3,
        /// The angle of the rotation, degrees.
        angle: Timed,
    },
    /// It does not change.
    Constant(DQuat),
}

impl TimedOrientation {
    /// The orientation at a time (s), and the angular velocity (world axes, rad/s).
    pub fn at(&self, t: f64) -> (DQuat, DVec3) {
        match self {
            TimedOrientation::Constant(orientation) => (*orientation, DVec3::ZERO),
            TimedOrientation::Axis { axis, angle } => {
                let turn = DQuat::from_axis_angle(*axis, angle.at(t).to_radians());
                (turn, *axis * angle.rate(t).to_radians())
            }
            TimedOrientation::Euler(angles) => {
                let radians = |v: DVec3| v * (std::f64::consts::PI / 180.0);
                let (angles, rates) = (radians(angles.at(t)), radians(angles.rate(t)));
                let z = DQuat::from_rotation_z(angles.z);
                let zy = z * DQuat::from_rotation_y(angles.y);
                // Each turn is about an axis that the later ones turn too.
                let spin = DVec3::Z * rates.z + z * (DVec3::Y * rates.y) + zy * (DVec3::X * rates.x);
                (zy * DQuat::from_rotation_x(angles.x), spin)
            }
        }
    }

    /// The angular acceleration at a time (s), world axes, rad/s².
    pub fn angular_acceleration(&self, t: f64) -> DVec3 {
        match self {
            TimedOrientation::Constant(_) => DVec3::ZERO,
            TimedOrientation::Axis { axis, angle } => *axis * angle.curvature(t).to_radians(),
            TimedOrientation::Euler(angles) => {
                let radians = |v: DVec3| v * (std::f64::consts::PI / 180.0);
                let (turned, rates) = (radians(angles.at(t)), radians(angles.rate(t)));
                let curvatures = radians(angles.curvature(t));
                let z = DQuat::from_rotation_z(turned.z);
                let y_axis = z * DVec3::Y;
                let x_axis = z * (DQuat::from_rotation_y(turned.y) * DVec3::X);
                // The axes of the earlier turns are turned by the later ones.
                let z_spin = DVec3::Z * rates.z;
                let zy_spin = z_spin + y_axis * rates.y;
                DVec3::Z * curvatures.z
                    + y_axis * curvatures.y
                    + x_axis * curvatures.x
                    + z_spin.cross(y_axis) * rates.y
                    + zy_spin.cross(x_axis) * rates.x
            }
        }
    }
}
