//! A rod: it keeps the distance between two points constant.

use super::super::Anchor;
use super::member::End;
use super::{Constraint, Equations, Members, parts};

/// A massless rod with a ball joint at each end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod {
    /// The two ends of the rod.
    pub between: [Anchor; 2],
    /// The length ℓ of the rod, m. It is positive.
    pub length: f64,
}

impl Constraint for Rod {
    fn ends(&self) -> Vec<Anchor> {
        self.between.to_vec()
    }

    fn rows(&self) -> usize {
        1
    }

    /// Writes c = |d| − ℓ, where d is the vector from one end of the rod to the other, and ℓ its length.
    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        let ends = End::all(&self.between, members);
        let way = parts::EndToEndVector::new(&ends, self.length);
        way.write_only(1.0, self.length, equations);
    }
}
