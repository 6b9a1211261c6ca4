//! Writes ghosts, which show the earlier poses of bodies at regular intervals, in SDL.

use super::super::bodies::Block;
use super::super::materials::{MaterialText, SHADE_IDENTIFIER};
use super::super::meshes::Meshes;
use super::super::sdl::Style;
use super::color;
use crate::picture::Plan;
use crate::scene::{Body, Scene};
use crate::simulate::Frame;

/// The planned text of the bodies that have ghosts.
pub(super) struct Ghosts {
    /// The indices of the bodies that have ghosts, in ascending order, each with its planned text.
    bodies: Vec<(usize, Block)>,
    style: Style,
}

impl Ghosts {
    pub(super) fn new(scene: &Scene, materials: &[MaterialText], meshes: &Meshes, style: Style) -> Ghosts {
        let bodies = scene.bodies.iter().enumerate().filter(|(_, body)| body.showing.ghosts.is_some());
        let block = |(number, body): (usize, &Body)| {
            let pale = body.material.and_then(|material| materials[material].pale);
            let pale = Body { material: pale.or(body.material), ..body.clone() };
            (number, Block::of(&pale, materials, meshes, style))
        };
        Ghosts { bodies: bodies.map(block).collect(), style }
    }

    /// Appends the ghosts that a frame shows. They cast no shadow: at the time of the picture, nothing is there.
    pub(super) fn write(&self, out: &mut String, plan: &Plan, frame: &Frame) {
        let ghosts: Vec<_> =
            plan.ghosts(frame).filter(|ghost| self.style.can_write(ghost.body.location)).collect();
        match ghosts.len() {
            0 => return,
            // POV-Ray warns about a union of one object.
            1 => out.push_str("object { // a ghost\n"),
            _ => out.push_str("union { // ghosts\n"),
        }
        for ghost in ghosts {
            if let Ok(of) = self.bodies.binary_search_by_key(&ghost.body.id, |(number, _)| *number) {
                if let Some(shade) = plan.ghost_color(ghost) {
                    let shade = color(shade, self.style);
                    out.push_str(&format!("#local {SHADE_IDENTIFIER} = {shade};\n"));
                }
                self.bodies[of].1.write_single(out, &ghost.body, plan.ghost_scale(ghost));
            }
        }
        out.push_str("no_shadow\n}\n");
    }
}
