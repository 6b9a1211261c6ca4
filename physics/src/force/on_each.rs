//! Forces that act on each body alone, by its own state.

use std::fmt::Debug;
use std::sync::Arc;

use glam::DVec3;

use super::super::BodyId;
use super::Force;

/// A force that acts on each of some bodies alone, by a field or by the body's own motion: not between bodies.
pub trait ForceOnEach: Force + Debug {
    /// Returns the bodies that the force acts on.
    fn bodies(&self) -> &[BodyId];

    /// Returns the same force on particles, which do not rotate.
    fn on_particles(&self, particles: Vec<BodyId>) -> Arc<dyn Force>;

    /// Whether the force on a body depends on its charge.
    fn depends_on_charge(&self) -> bool {
        false
    }

    /// Returns the uniform magnetic field that the force is due to, world axes, T. `None` if there is none.
    fn magnetic_field(&self) -> Option<DVec3> {
        None
    }

    /// Whether the force has surfaces of constant potential that are worth drawing.
    fn has_levels(&self) -> bool {
        false
    }

    /// Returns whether the force can change the linear momentum of the bodies, and whether it can change their angular momentum.
    fn changes_momenta(&self) -> [bool; 2] {
        [true, true]
    }
}
