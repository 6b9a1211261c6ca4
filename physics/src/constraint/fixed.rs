//! A fixed joint: it keeps two bodies from moving relative to each other.

use glam::DQuat;

use super::super::Anchor;
use super::member::End;
use super::{Constraint, Equations, Members, parts};

/// A fixed joint, also called a weld: two bodies move as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fixed {
    /// The two ends of the joint: points that coincide.
    pub between: [Anchor; 2],
    /// The fixed rotation from the body axes of the first end to those of the second end.
    pub turned: DQuat,
}

impl Constraint for Fixed {
    fn ends(&self) -> Vec<Anchor> {
        self.between.to_vec()
    }

    fn rows(&self) -> usize {
        6
    }

    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        let ends = End::all(&self.between, members);
        parts::same_point(&ends, 0, equations);
        parts::same_turn(&ends, self.turned, 3, equations);
    }
}
