//! A rod: two points keep their distance.

use super::super::{Anchor, BodyId};
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
    fn bodies(&self) -> Vec<BodyId> {
        parts::bodies(self.between)
    }

    fn rows(&self) -> usize {
        1
    }

    /// c = |d| − ℓ, with d the way from one end to the other; c'' = u·d'' + (|d'|² − (u·d')²) / |d|, u = d / |d|.
    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        let [a, b] = End::pair(self.between, members);
        let apart = b.location - a.location;
        let length = apart.length();
        // Two ends at the same point have no direction; any one leads them apart.
        let u = apart.try_normalize().unwrap_or(glam::DVec3::Y);
        let rate = b.velocity - a.velocity;
        let across = rate - rate.dot(u) * u;
        let bias =
            u.dot(b.centripetal - a.centripetal) + across.length_squared() / length.max(1e-3 * self.length);
        let scale = a.location.abs().max(b.location.abs()).max_element().max(self.length);
        equations.row(0, length - self.length, bias, scale);
        equations.direction(0, a.body, -u, -a.arm.cross(u));
        equations.direction(0, b.body, u, b.arm.cross(u));
    }
}
