//! The magnitudes to which the tolerances of constraint equations are relative.
//!
//! A tolerance follows from the sizes of the bodies, never from where they are: the origin of the world is arbitrary. Coordinates only
//! widen a tolerance to the rounding errors that they cause. Whatever cannot move, such as a wall or a point of the world, has no size: its
//! center is as arbitrary as the origin.

use super::Row;
use super::solver::Solver;

/// An equation holds exactly if its error is at most this fraction of its size or of its terms: a few rounding errors.
const EXACT_ERROR: f64 = 1e-15;

/// No tolerance is below this fraction of the terms of an equation. It covers the rounding errors of some steps.
const LEAST_OF_TERMS: f64 = 1e-14;

/// The magnitudes to which the tolerances of a constraint equation c = 0 are relative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scale {
    /// The size of what the equation connects, m: the largest of the levers, the radii of gyration of the bodies that can move, and given
    /// lengths. 1 for an equation between angles.
    pub size: f64,
    /// The magnitude of the terms whose difference is c, such as coordinates. The rounding error of c is about 1e-16 of this.
    pub terms: f64,
    /// True if c is a length. False if it is an angle or the cosine of an angle.
    pub is_length: bool,
}

impl Scale {
    /// The scale of an equation between angles or directions.
    pub const ANGLE: Scale = Scale { size: 1.0, terms: 1.0, is_length: false };

    /// Returns the scale of an equation between lengths, from the size of what it connects and the magnitude of its terms, m.
    #[must_use]
    pub const fn length(size: f64, terms: f64) -> Scale {
        Scale { size, terms, is_length: true }
    }

    /// Returns the scale with a size and terms of at least `length`, m.
    #[must_use]
    pub fn at_least(self, length: f64) -> Scale {
        Scale { size: self.size.max(length), terms: self.terms.max(length), ..self }
    }

    /// Returns the larger of two scales of the same kind.
    #[must_use]
    pub fn max(self, other: Scale) -> Scale {
        Scale { size: self.size.max(other.size), terms: self.terms.max(other.terms), ..self }
    }
}

impl Row {
    /// Returns the tolerance for c that is this fraction of the equation's size, but at least its rounding error.
    #[inline]
    pub(super) fn tolerance(&self, part: f64) -> f64 {
        (part * self.scale.size).max(LEAST_OF_TERMS * self.scale.terms)
    }

    /// Returns the error of the equation, in units of its rounding error.
    #[inline]
    pub(super) fn error(&self) -> f64 {
        let rounding = EXACT_ERROR * self.scale.size.max(self.scale.terms);
        self.violation.abs() / rounding.max(f64::MIN_POSITIVE)
    }
}

impl Solver {
    /// Returns the rate of a constraint row that counts as much as 1 m/s: 1 for a length, and 1 m/s divided by the size of the mechanism
    /// for an angle. It applies to accelerations, too.
    #[inline]
    pub(super) fn unit(&self, row: usize) -> f64 {
        if self.rows[row].scale.is_length {
            1.0
        } else {
            self.structure.as_ref().map_or(1.0, |structure| structure.length.recip())
        }
    }
}
