//! Limits and a motor for the angle of a hinge or the displacement of a slider.

use std::fmt::Debug;
use std::sync::Arc;

use super::coordinate::{Coordinate, CoordinateRow};
use super::{Equations, Law, Members};

/// The limits and the motor of a hinge or slider, which act on its free coordinate.
#[derive(Clone, Debug, Default)]
pub struct Freedom {
    /// The smallest and the largest value of the coordinate, rad or m. For an angle, the limits differ by less than a full turn. `None`
    /// without limits.
    pub limits: Option<[f64; 2]>,
    /// The motor that drives the coordinate; `None` without a motor.
    pub motor: Option<Motor>,
}

/// A motor that drives the free coordinate of a joint.
#[derive(Clone, Debug)]
pub enum Motor {
    /// A motor that keeps a constant speed, as far as the limit of its torque or force allows.
    Speed {
        /// The speed that the motor keeps, rad/s or m/s.
        speed: f64,
        /// The largest torque, N m, or force, N, of the motor. It is positive.
        limit: f64,
    },
    /// A motor that makes the coordinate a given function of time, with unlimited force.
    Value(Arc<dyn Target>),
}

/// The target value of a driven joint coordinate, as a function of time.
pub trait Target: Debug + Send + Sync {
    /// Returns the target value at time `t` (s) and its first and second time derivatives: rad, rad/s and rad/s², or m, m/s and m/s².
    fn at(&self, t: f64) -> [f64; 3];
}

impl Freedom {
    /// Returns the number of constraint equations of the limits and the motor.
    pub(super) fn rows(&self) -> usize {
        2 * usize::from(self.limits.is_some()) + usize::from(self.motor.is_some())
    }

    /// Returns the law of an equation of the limits or the motor. The limits come first.
    pub(super) fn law(&self, row: usize) -> Law {
        if self.limits.is_some() && row < 2 {
            return Law::Inequality;
        }
        match self.motor {
            Some(Motor::Speed { limit, .. }) => Law::SpeedMotor { limit },
            _ => Law::Equality,
        }
    }

    /// Returns the equation of the motor; `None` without a motor. The limits come first.
    pub(super) fn motor_row(&self) -> Option<usize> {
        self.motor.is_some().then_some(2 * usize::from(self.limits.is_some()))
    }

    /// Writes the equations of the limits and the motor, starting at row `first` of the constraint.
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
            // Angles are periodic: use the value nearest to the middle of the limits.
            let middle = 0.5 * (low + high);
            let value = middle + coordinate.difference(now.value, middle);
            write(1.0, value - low, 0.0, 0.0);
            write(-1.0, high - value, 0.0, 0.0);
        }
        match &self.motor {
            None => {}
            // The angle is measured from the start of the step, so full turns need not be counted.
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
