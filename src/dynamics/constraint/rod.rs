//! A rod: the distance of two points is constant.

use super::super::Anchor;
use super::member::End;
use super::{Constraint, Equations, Members, parts};

/// A massless rod with a ball joint at each end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod {
    /// The two points.
    pub between: [Anchor; 2],
    /// Their distance ℓ, m; it is positive.
    pub length: f64,
}

impl Constraint for Rod {
    fn ends(&self) -> Vec<Anchor> {
        self.between.to_vec()
    }

    fn rows(&self) -> usize {
        1
    }

    /// c = |d| − ℓ, where d is the vector from one end to the other.
    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        let ends = End::all(&self.between, members);
        let way = parts::Way::new(&ends, self.length);
        way.write_only(1.0, self.length, equations);
    }
}
