//! Numbers and points of the picture that may change during the run: with the time, or with measures such as `ball.x`.

use std::sync::Arc;

use glam::DVec3;

use super::MeasureFormula;
use super::timed::{Timed, TimedVector};

/// A number of the picture that may change during the run.
#[derive(Clone, Debug)]
pub enum Varying {
    /// A number that is constant or depends on the time only.
    Timed(Timed),
    /// A formula of measures.
    Measured(Arc<MeasureFormula>),
}

/// A point of the picture that may move during the run, m.
#[derive(Clone, Debug)]
pub enum VaryingPoint {
    /// A point that is constant or depends on the time only.
    Timed(TimedVector),
    /// A point with formulas of measures among its coordinates.
    Measured([Varying; 3]),
}

impl Varying {
    /// Returns the number at a time (s). `value` returns the value of a formula at that time.
    pub fn at(&self, time: f64, value: impl Fn(&MeasureFormula) -> f64) -> f64 {
        match self {
            Varying::Timed(timed) => timed.at(time),
            Varying::Measured(formula) => value(formula),
        }
    }

    /// Returns whether the number may change.
    pub fn changes(&self) -> bool {
        match self {
            Varying::Timed(timed) => timed.changes(),
            Varying::Measured(_) => true,
        }
    }

    /// Returns the formula of measures. `None` if the number depends on the time only.
    pub fn formula(&self) -> Option<&MeasureFormula> {
        match self {
            Varying::Timed(_) => None,
            Varying::Measured(formula) => Some(formula),
        }
    }
}

impl VaryingPoint {
    /// Makes a point of three coordinates.
    pub(super) fn of(coordinates: [Varying; 3]) -> VaryingPoint {
        match coordinates {
            [Varying::Timed(x), Varying::Timed(y), Varying::Timed(z)] => {
                VaryingPoint::Timed(TimedVector::Each([x, y, z]))
            }
            coordinates => VaryingPoint::Measured(coordinates),
        }
    }

    /// Returns the point at a time (s). `value` returns the value of a formula at that time.
    pub fn at(&self, time: f64, value: impl Fn(&MeasureFormula) -> f64) -> DVec3 {
        match self {
            VaryingPoint::Timed(timed) => timed.at(time),
            VaryingPoint::Measured(coordinates) => {
                DVec3::from_array([0, 1, 2].map(|i: usize| coordinates[i].at(time, &value)))
            }
        }
    }

    /// Returns the point at the start of the run. `None` if it depends on measures.
    pub fn at_start(&self) -> Option<DVec3> {
        match self {
            VaryingPoint::Timed(timed) => Some(timed.at(0.0)),
            VaryingPoint::Measured(_) => None,
        }
    }

    /// Returns whether the point may move.
    pub fn changes(&self) -> bool {
        match self {
            VaryingPoint::Timed(timed) => timed.changes(),
            VaryingPoint::Measured(_) => true,
        }
    }

    /// Returns the formulas of measures among the coordinates.
    pub fn formulas(&self) -> impl Iterator<Item = &MeasureFormula> {
        let coordinates = match self {
            VaryingPoint::Timed(_) => &[][..],
            VaryingPoint::Measured(coordinates) => coordinates,
        };
        coordinates.iter().filter_map(Varying::formula)
    }
}
