//! A hinge: two points coincide, and both bodies rotate about a common axis.

use glam::{DQuat, DVec3};

use super::super::Anchor;
use super::member::End;
use super::{Constraint, Coordinate, Equations, Freedom, Law, Members, parts};

/// A hinge, also called revolute joint. Its angle is the rotation of the second end relative to the first.
#[derive(Clone, Debug)]
pub struct Hinge {
    /// The two ends of the hinge: points that coincide.
    pub between: [Anchor; 2],
    /// The hinge axis, a unit vector, in the body axes of each end. An end at a point of the world uses the world axes.
    axis: [DVec3; 2],
    /// The rotation from the body axes of the first end to those of the second end at hinge angle 0.
    turned: DQuat,
    /// The limits and the motor of the hinge angle.
    pub freedom: Freedom,
}

impl Hinge {
    /// Creates a hinge without limits or motor. `axis` is a unit vector in the body axes of the first end. `turned` is the rotation from
    /// these axes to those of the second end at hinge angle 0.
    #[must_use]
    pub fn new(between: [Anchor; 2], axis: DVec3, turned: DQuat) -> Hinge {
        Hinge { between, axis: [axis, turned * axis], turned, freedom: Freedom::default() }
    }

    /// Returns this hinge with the given limits and motor.
    #[must_use]
    pub fn with(self, freedom: Freedom) -> Hinge {
        Hinge { freedom, ..self }
    }

    /// Returns the hinge axis, a unit vector, in the body axes of the first end.
    #[must_use]
    pub fn axis(&self) -> DVec3 {
        self.axis[0]
    }

    /// Returns the rotation from the body axes of the first end to those of the second end at hinge angle 0.
    #[must_use]
    pub fn turned(&self) -> DQuat {
        self.turned
    }

    /// Returns the definition of the hinge angle as a free coordinate.
    #[must_use]
    pub fn coordinate(&self) -> Coordinate {
        let [zero, _] = parts::across(self.axis[0]);
        Coordinate { between: self.between, axis: self.axis[0], zero: Some([zero, self.turned * zero]) }
    }
}

impl Constraint for Hinge {
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
        parts::same_point(&ends, 0, equations);
        let axis = ends[1].orientation() * self.axis[1];
        for (i, across) in parts::across(self.axis[0]).into_iter().enumerate() {
            parts::perpendicular(&ends, ends[0].orientation() * across, axis, 3 + i, equations);
        }
        self.freedom.measure(|| self.coordinate(), 5, members, equations);
    }
}
