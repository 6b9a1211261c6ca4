//! Moves arrows in front of the planes, springs and joints that would hide them.

use super::Plan;
use crate::picture::arrows::{Arrow, ArrowOwner};
use crate::picture::in_front::lift_from_link;
use crate::simulate::{Frame, Ghost};

impl Plan {
    /// The arrows of a frame. Arrows behind the ground or a spring are moved towards the camera, in such a way that they look the same in
    /// the picture.
    pub(crate) fn arrows_in_front(&self, frame: &Frame) -> Vec<Arrow> {
        let mut arrows = self.arrows(frame);
        if !arrows.is_empty() {
            let camera = self.eye.at(frame);
            for arrow in &mut arrows {
                self.planes.lift(arrow, &camera);
                let body = match arrow.owner {
                    ArrowOwner::Body(body) => Some(body),
                    ArrowOwner::Joint { body, .. } => body,
                };
                for link in body.into_iter().flat_map(|body| self.links.of_body(body, frame)) {
                    lift_from_link(arrow, &link, &camera);
                }
            }
        }
        arrows
    }

    /// The arrows of a ghost, moved in front of the ground.
    pub(crate) fn ghost_arrows_in_front(&self, frame: &Frame, ghost: &Ghost) -> Vec<Arrow> {
        let mut arrows = self.ghost_arrows(frame, ghost);
        let camera = self.eye.at(frame);
        arrows.iter_mut().for_each(|arrow| self.planes.lift(arrow, &camera));
        arrows
    }
}
