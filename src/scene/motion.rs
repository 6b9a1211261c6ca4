//! The prescribed motion of bodies, which forces do not change.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::timed::{Timed, TimedVector};
use crate::physics::{Kinematics, Motion, Track};

/// The prescribed motion of a body.
#[derive(Clone, Debug)]
pub enum BodyMotion {
    /// A motion given by formulas of the time.
    Formula {
        /// The location of the center of mass as a function of time, m.
        location: TimedVector,
        /// The orientation of the body as a function of time.
        orientation: TimedOrientation,
    },
    /// A motion interpolated between the keyframes of a track.
    Track(Arc<Track>),
}

impl BodyMotion {
    /// Returns the location of the center of mass (m) and the orientation at time `t` (s).
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
    /// Rotations about the world's x axis, then y, then z. The angles are in degrees.
    Euler(TimedVector),
    /// A rotation about a fixed axis.
    Axis {
        /// The axis of the rotation, a unit vector in world axes.
        axis: DVec3,
        /// The angle of the rotation as a function of time, degrees.
        angle: Timed,
    },
    /// An orientation that does not change.
    Constant(DQuat),
}

impl TimedOrientation {
    /// Returns the orientation and the angular velocity (rad/s, in world axes) at time `t` (s).
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
                // The rotations about y and z also rotate the axes of the rotations before them.
                let spin = DVec3::Z * rates.z + z * (DVec3::Y * rates.y) + zy * (DVec3::X * rates.x);
                (zy * DQuat::from_rotation_x(angles.x), spin)
            }
        }
    }

    /// Returns the angular acceleration at time `t` (s), rad/s², in world axes.
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
                // The rotations about y and z also rotate the axes of the rotations before them. The derivatives of these axes add to the
                // angular acceleration.
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
