//! A rope: it keeps the distance between two points from exceeding the rope's length.

use super::super::Anchor;
use super::member::End;
use super::{Constraint, Equations, Law, Members, parts};

/// A massless rope. When it becomes taut, it stops the ends from moving apart, without rebound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rope {
    /// The two ends of the rope.
    pub between: [Anchor; 2],
    /// The length ℓ of the rope, m. It is positive.
    pub length: f64,
}

impl Constraint for Rope {
    fn ends(&self) -> Vec<Anchor> {
        self.between.to_vec()
    }

    fn rows(&self) -> usize {
        1
    }

    fn law(&self, _: usize) -> Law {
        Law::Inequality
    }

    /// Writes c = ℓ − |d| ≥ 0, where d is the vector from one end of the rope to the other, and ℓ its length.
    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        let ends = End::all(&self.between, members);
        let way = parts::EndToEndVector::new(&ends, self.length);
        way.write_only(-1.0, self.length, equations);
    }
}
