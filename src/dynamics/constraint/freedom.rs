//! Limits and a motor for the angle of a hinge or the displacement of a slider.

use std::fmt::Debug;
use std::sync::Arc;

use super::coordinate::{Coordinate, CoordinateRow};
use super::{Equations, Law, Members};

/// The limits and the motor of a joint that leaves one coordinate free.
#[derive(Clone, Debug, Default)]
pub struct Freedom {
    /// The smallest and the largest value, rad or m. For an angle, their difference is less than a full rotation.
    pub limits: Option<[f64; 2]>,
    /// Its motor.
    pub motor: Option<Motor>,
}

/// A motor of a joint.
#[derive(Clone, Debug)]
pub enum Motor {
    /// Keeps a speed within the limit of its torque or force.
    Speed {
        /// The speed, rad/s or m/s.
        speed: f64,
        /// The largest torque, N m, or force, N; it is positive.
        limit: f64,
    },
    /// Keeps a value that is a given function of time, with any force that this needs.
    Value(Arc<dyn Target>),
}

/// A value as a function of time.
pub trait Target: Debug + Send + Sync {
    /// The value at time `t` (s), and its first and second derivatives: rad, rad/s and rad/s², or m, m/s and m/s².
    fn at(&self, t: f64) -> [f64; 3];
}

impl Freedom {
    /// The number of its equations.
    pub(super) fn rows(&self) -> usize {
        2 * usize::from(self.limits.is_some()) + usize::from(self.motor.is_some())
    }

    /// The law of one of its equations.
    pub(super) fn law(&self, row: usize) -> Law {
        if self.limits.is_some() && row < 2 {
            return Law::Stop;
        }
        match self.motor {
            Some(Motor::Speed { limit, .. }) => Law::Drive { limit },
            _ => Law::Tie,
        }
    }

    /// Writes its equations, from row `first` on.
    pub(super) fn measure(
        &self,
        coordinate: impl FnOnce() -> Coordinate,
        first: usize,
        members: &Members<'_>,
        equations: &mut Equations<'_>,
    ) {
        if self.rows() == 0 {
            return;
        }
        let coordinate = coordinate();
        let [now, before] = coordinate.measure_both(members);
        let mut row = first;
        let mut write = |factor: f64, violation: f64, rate: f64, curvature: f64| {
            let terms = &[(factor, now)];
            CoordinateRow { row, terms, violation, rate, curvature }.write(equations);
            row += 1;
        };
        if let Some([low, high]) = self.limits {
            // Angles are periodic: take the value nearest to the middle of the limits.
            let middle = 0.5 * (low + high);
            let value = middle + coordinate.difference(now.value, middle);
            write(1.0, value - low, 0.0, 0.0);
            write(-1.0, high - value, 0.0, 0.0);
        }
        match &self.motor {
            None => {}
            // Relative to the start of the step, so that full rotations need not be counted.
            Some(Motor::Speed { speed, .. }) => {
                let moved = coordinate.difference(now.value, before.value);
                let due = coordinate.difference(speed * members.elapsed(), 0.0);
                write(1.0, coordinate.difference(moved, due), -speed, 0.0);
            }
            Some(Motor::Value(target)) => {
                let [value, rate, curvature] = target.at(members.time());
                write(1.0, coordinate.difference(now.value, value), -rate, -curvature);
            }
        }
    }
}
