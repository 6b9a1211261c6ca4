//! What is done with the angle of a hinge, or with the way of a slider: limits and a motor.

use std::fmt::Debug;
use std::sync::Arc;

use super::coordinate::{Coordinate, CoordinateRow};
use super::{Equations, Law, Members};

/// The limits and the motor of a joint that leaves one coordinate free.
#[derive(Clone, Debug, Default)]
pub struct Freedom {
    /// The smallest and the largest value, rad or m. Those of an angle span less than a turn.
    pub limits: Option<[f64; 2]>,
    /// What drives it.
    pub motor: Option<Motor>,
}

/// What drives a joint.
#[derive(Clone, Debug)]
pub enum Motor {
    /// A speed, as far as the motor is strong enough.
    Speed {
        /// The speed, rad/s or m/s.
        speed: f64,
        /// The largest torque, N m, or force, N; it is positive.
        limit: f64,
    },
    /// A value that is given at every time, whatever it takes.
    Value(Arc<dyn Target>),
}

/// A value that is given at every time.
pub trait Target: Debug + Send + Sync {
    /// The value at time `t` (s), its rate, and the rate of that: rad or m, by the second.
    fn at(&self, t: f64) -> [f64; 3];
}

impl Freedom {
    /// The number of its equations.
    pub(super) fn rows(&self) -> usize {
        2 * usize::from(self.limits.is_some()) + usize::from(self.motor.is_some())
    }

    /// What one of its equations may do.
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
            // An angle is that of its turns that is nearest to the middle.
            let middle = 0.5 * (low + high);
            let value = middle + coordinate.difference(now.value, middle);
            write(1.0, value - low, 0.0, 0.0);
            write(-1.0, high - value, 0.0, 0.0);
        }
        match &self.motor {
            None => {}
            // Against the beginning of the step: so the turns need not be counted.
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
