//! A rod: two points keep their distance.

use super::super::Anchor;
use super::member::End;
use super::{Constraint, Equations, Members, parts};

/// A rod without mass, with a ball joint at each end.
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

    /// c = |d| − ℓ, where d leads from one end to the other.
    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        let ends = End::all(&self.between, members);
        let way = parts::Way::new(&ends, self.length);
        way.write_only(1.0, self.length, equations);
    }
}
