//! The bodies as they were, every so many seconds.

use super::super::bodies::Block;
use super::super::materials::MaterialText;
use super::super::meshes::Meshes;
use super::super::sdl::Style;
use crate::scene::{Body, Scene};
use crate::simulate::{Frame, Ghost};

/// The ghosts of a scene.
pub(super) struct Ghosts {
    /// The bodies that have any, by their numbers: how each is drawn, and how near a ghost may be to its body, m.
    bodies: Vec<(usize, Block, f64)>,
}

impl Ghosts {
    pub(super) fn new(scene: &Scene, materials: &[MaterialText], meshes: &Meshes, style: Style) -> Ghosts {
        let bodies = scene.bodies.iter().enumerate().filter(|(_, body)| body.showing.ghosts.is_some());
        let plan = |(number, body): (usize, &Body)| {
            let pale = body.material.and_then(|material| materials[material].pale);
            let pale = Body { material: pale.or(body.material), ..body.clone() };
            // Surfaces at the same place would be drawn in a mixture of both.
            let near = 0.02 * body.drawn().half_thickness().unwrap_or(0.0);
            (number, Block::of(&pale, materials, meshes, style), near)
        };
        Ghosts { bodies: bodies.map(plan).collect() }
    }

    fn of(&self, ghost: &Ghost) -> Option<&(usize, Block, f64)> {
        self.bodies.iter().find(|(number, ..)| *number == ghost.body.id)
    }

    /// Whether a ghost is elsewhere than its body.
    pub(super) fn is_drawn(&self, ghost: &Ghost, frame: &Frame) -> bool {
        let now = &frame.bodies[ghost.body.id];
        self.of(ghost).is_some_and(|(.., near)| {
            let turned = now.orientation.dot(ghost.body.orientation).abs() < 1.0 - 1e-4;
            ghost.body.is_finite() && (ghost.body.location.distance(now.location) > *near || turned)
        })
    }

    /// Appends the ghosts of a frame.
    pub(super) fn write(&self, out: &mut String, frame: &Frame) {
        for ghost in frame.past.ghosts.iter().filter(|ghost| self.is_drawn(ghost, frame)) {
            if let Some((_, block, _)) = self.of(ghost) {
                block.write_single(out, &ghost.body);
            }
        }
    }
}
