//! A hinge: two points stay together, and one axis is common.

use glam::DVec3;

use super::super::{Anchor, BodyId};
use super::member::End;
use super::{Constraint, Equations, Members, parts};

/// A hinge, also called a revolute joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hinge {
    /// The two points.
    pub between: [Anchor; 2],
    /// The axis, a unit vector, in the axes of each end; those of a point of the world are the world's.
    pub axis: [DVec3; 2],
}

impl Constraint for Hinge {
    fn bodies(&self) -> Vec<BodyId> {
        parts::bodies(self.between)
    }

    fn rows(&self) -> usize {
        5
    }

    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        let ends = End::pair(self.between, members);
        parts::same_point(&ends, 0, equations);
        let axis = ends[1].orientation * self.axis[1];
        for (i, across) in parts::across(self.axis[0]).into_iter().enumerate() {
            parts::perpendicular(&ends, ends[0].orientation * across, axis, 3 + i, equations);
        }
    }
}
