//! Prescribed motion: the scene gives the path of a body, and forces do not change it.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::timed::{Timed, TimedVector};
use crate::dynamics::{Kinematics, Motion, Track};

/// A prescribed motion.
#[derive(Clone, Debug)]
pub enum BodyMotion {
    /// Formulas of the time.
    Formula {
        /// The location of the centre of mass, m.
        location: TimedVector,
        /// The orientation of the body.
        orientation: TimedOrientation,
    },
    /// Interpolation between known positions.
    Track(Arc<Track>),
}

impl BodyMotion {
    /// The location of the centre of mass, m, and the orientation at a time (s).
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
    /// Rotations about the world's x axis, then y, then z, degrees.
    Euler(TimedVector),
    /// A rotation about one axis.
    Axis {
        /// The axis of the rotation, a unit vector.
        axis: DVec3,
        /// The angle of the rotation, degrees.
        angle: Timed,
    },
    /// A constant orientation.
    Constant(DQuat),
}

impl TimedOrientation {
    /// The orientation at a time (s), and the angular velocity, rad/s, in world axes.
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
                // The later rotations also turn the axes of the earlier rotations.
                let spin = DVec3::Z * rates.z + z * (DVec3::Y * rates.y) + zy * (DVec3::X * rates.x);
                (zy * DQuat::from_rotation_x(angles.x), spin)
            }
        }
    }

    /// The angular acceleration at a time (s), rad/s², in world axes.
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
                // The later rotations also turn the axes of the earlier rotations, and this adds to the angular
                // acceleration.
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
