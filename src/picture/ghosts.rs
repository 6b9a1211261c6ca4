//! Ghosts: copies of bodies at earlier times.

use crate::scene::{Body, Scene};
use crate::simulate::{Frame, Ghost};

/// The smallest distance between a body and a visible ghost of it, m. Nearer ghosts are omitted, since POV-Ray mixes coinciding surfaces.
pub(super) fn near(body: &Body) -> f64 {
    0.02 * body.drawn().half_thickness().unwrap_or(0.0)
}

/// True if two orientations look different, given the dot product of their quaternions.
pub(super) fn is_turned(product: f64) -> bool {
    product.abs() < 1.0 - 1e-4
}

/// The bodies of a scene that have ghosts.
#[derive(Clone, Debug)]
pub(super) struct Ghosts {
    /// The index of each body with ghosts, in increasing order, and the smallest distance of a visible ghost from the body, m.
    bodies: Vec<(usize, f64)>,
}

impl Ghosts {
    pub(super) fn new(scene: &Scene) -> Ghosts {
        let bodies = scene.bodies.iter().enumerate().filter(|(_, body)| body.showing.ghosts.is_some());
        Ghosts { bodies: bodies.map(|(number, body)| (number, near(body))).collect() }
    }

    /// The visible ghosts of a frame: those with another pose than their body. Ghosts of absent bodies stay visible.
    pub(super) fn drawn<'a>(&self, frame: &'a Frame) -> impl Iterator<Item = &'a Ghost> {
        frame.past.ghosts.iter().map(AsRef::as_ref).filter(|ghost| self.is_drawn(ghost, frame))
    }

    fn is_drawn(&self, ghost: &Ghost, frame: &Frame) -> bool {
        let now = frame.body(ghost.body.id);
        let of = self.bodies.binary_search_by_key(&ghost.body.id, |(number, _)| *number);
        of.is_ok_and(|of| {
            let near = self.bodies[of].1;
            let is_elsewhere = now.is_none_or(|now| {
                let turned = is_turned(now.orientation.dot(ghost.body.orientation));
                ghost.body.location.distance(now.location) > near || turned
            });
            ghost.look.is_drawn && ghost.body.is_finite() && is_elsewhere
        })
    }
}
