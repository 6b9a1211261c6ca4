//! A fixed joint: two bodies move as one.

use glam::DQuat;

use super::super::Anchor;
use super::member::End;
use super::{Constraint, Equations, Members, parts};

/// A fixed joint, also called a weld.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fixed {
    /// The two points.
    pub between: [Anchor; 2],
    /// The rotation that takes the axes of the first end to those of the second end.
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
