//! Forces between bodies along the line of their centers, summed over pairs.

use std::fmt::Debug;
use std::sync::Arc;

use super::super::{BodyId, RigidBody};
use super::Force;

/// A force between all pairs of some bodies, or between each of them and each of a second group. It acts along the line of the two centers
/// of mass, so it changes neither the total momentum nor the total angular momentum.
pub trait ForceBetween: Force + Debug {
    /// Returns the bodies of the first group.
    fn bodies(&self) -> &[BodyId];

    /// Returns the bodies of the second group. `None` if the force acts between all pairs of the first.
    fn against(&self) -> Option<&[BodyId]>;

    /// Returns the same force of `sources` on particles. The particles exert no force.
    fn on_particles(&self, particles: Vec<BodyId>, sources: Vec<BodyId>) -> Arc<dyn Force>;

    /// Whether the force depends on the charges of both bodies.
    fn depends_on_charge(&self) -> bool {
        false
    }

    /// Whether the force depends on the masses of both bodies.
    fn depends_on_mass(&self) -> bool {
        false
    }

    /// Returns the strength of a body as a source of the force's field: positive where field lines begin, negative where they end. 0 for a
    /// force that does not fall with the square of the distance.
    fn source_strength(&self, _source: &RigidBody) -> f64 {
        0.0
    }
}
