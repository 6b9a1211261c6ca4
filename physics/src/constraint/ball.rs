//! A ball joint: it keeps a point of one body at a point of another, and leaves all rotations free.

use super::super::Anchor;
use super::member::End;
use super::{Constraint, Equations, Members, parts};

/// A ball joint, also called spherical joint: two points coincide, and all rotations are free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The two points that coincide.
    pub between: [Anchor; 2],
}

impl Constraint for Ball {
    fn ends(&self) -> Vec<Anchor> {
        self.between.to_vec()
    }

    fn rows(&self) -> usize {
        3
    }

    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        parts::same_point(&End::all(&self.between, members), 0, equations);
    }
}
