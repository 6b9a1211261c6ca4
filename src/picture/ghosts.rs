//! The bodies as they were, every so many seconds.

use crate::scene::Scene;
use crate::simulate::{Frame, Ghost};

/// The ghosts of a scene.
#[derive(Clone, Debug)]
pub(super) struct Ghosts {
    /// The bodies that have any, in the order of their numbers, and how near a ghost may be to its body, m.
    bodies: Vec<(usize, f64)>,
}

impl Ghosts {
    pub(super) fn new(scene: &Scene) -> Ghosts {
        let bodies = scene.bodies.iter().enumerate().filter(|(_, body)| body.showing.ghosts.is_some());
        // Surfaces at the same place would be drawn in a mixture of both.
        let near = bodies.map(|(number, body)| (number, 0.02 * body.drawn().half_thickness().unwrap_or(0.0)));
        Ghosts { bodies: near.collect() }
    }

    /// The ghosts of a frame that are elsewhere than their bodies. Those of bodies that are gone stay.
    pub(super) fn drawn<'a>(&self, frame: &'a Frame) -> impl Iterator<Item = &'a Ghost> {
        frame.past.ghosts.iter().map(AsRef::as_ref).filter(|ghost| self.is_drawn(ghost, frame))
    }

    fn is_drawn(&self, ghost: &Ghost, frame: &Frame) -> bool {
        let now = frame.body(ghost.body.id);
        let of = self.bodies.binary_search_by_key(&ghost.body.id, |(number, _)| *number);
        of.is_ok_and(|of| {
            let near = self.bodies[of].1;
            let is_elsewhere = now.is_none_or(|now| {
                let turned = now.orientation.dot(ghost.body.orientation).abs() < 1.0 - 1e-4;
                ghost.body.location.distance(now.location) > near || turned
            });
            ghost.body.is_finite() && is_elsewhere
        })
    }
}
