//! A slider: one body moves along an axis of the other, and does not rotate relative to it.

use glam::{DQuat, DVec3};

use super::super::Anchor;
use super::member::End;
use super::{Constraint, Coordinate, Equations, Freedom, Law, Members, parts};

/// A slider, also called prismatic joint. Its coordinate is the displacement of the second end from the first along the axis.
#[derive(Clone, Debug)]
pub struct Slider {
    /// The two ends of the slider. The second end stays on the axis through the first.
    pub between: [Anchor; 2],
    /// The axis of the slider, a unit vector, in the body axes of the first end. An end at a point of the world uses the world axes.
    pub axis: DVec3,
    /// The fixed rotation from the body axes of the first end to those of the second end.
    pub turned: DQuat,
    /// The limits and the motor of the slider's displacement.
    pub freedom: Freedom,
}

impl Slider {
    /// Returns the definition of the slider's displacement as a free coordinate.
    #[must_use]
    pub fn coordinate(&self) -> Coordinate {
        Coordinate { between: self.between, axis: self.axis, zero: None }
    }
}

impl Constraint for Slider {
    fn ends(&self) -> Vec<Anchor> {
        self.between.to_vec()
    }

    fn rows(&self) -> usize {
        5 + self.freedom.rows()
    }

    fn law(&self, row: usize) -> Law {
        row.checked_sub(5).map_or(Law::Equality, |row| self.freedom.law(row))
    }

    fn motor_row(&self) -> Option<usize> {
        self.freedom.motor_row().map(|row| 5 + row)
    }

    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        let ends = End::all(&self.between, members);
        parts::same_turn(&ends, self.turned, 0, equations);
        for (i, across) in parts::across(self.axis).into_iter().enumerate() {
            parts::beside(&ends, ends[0].orientation() * across, 3 + i, equations);
        }
        self.freedom.measure(|| self.coordinate(), 5, members, equations);
    }
}
