//! A small ball against the parts of a solid.

use glam::{DQuat, DVec3};

use super::nearest::{Nearest, between};
use super::solid::{Pose, Solid};
use crate::dynamics::shape::Shape;

/// A ball that does not turn.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Ball {
    solid: Solid,
    radius: f64,
}

impl Ball {
    /// A ball of a radius, m. `None` if it has no finite size.
    pub(in crate::dynamics) fn new(radius: f64) -> Option<Ball> {
        Some(Ball { solid: Solid::of(&Shape::Sphere { radius })?, radius })
    }

    pub(in crate::dynamics) fn radius(&self) -> f64 {
        self.radius
    }

    /// Where the ball and a convex part of a solid are nearest. The normal points out of the solid; the place is on the solid.
    pub(in crate::dynamics) fn nearest(
        &self,
        centre: DVec3,
        solid: &Solid,
        part: usize,
        pose: &Pose,
    ) -> (f64, DVec3, DVec3) {
        let own = Pose { location: centre, orientation: DQuat::IDENTITY };
        let Nearest { gap, normal, on } = between(&self.solid.parts()[0], &own, &solid.parts()[part], pose);
        (gap, -normal, on[1])
    }
}

impl Solid {
    /// The number of convex parts.
    pub(in crate::dynamics) fn count(&self) -> usize {
        self.parts().len()
    }

    /// Whether a part is a half-space.
    pub(in crate::dynamics) fn is_endless(&self, part: usize) -> bool {
        self.parts()[part].is_ground()
    }

    /// Whether it has a tree of boxes to search its parts, as a mesh has.
    pub(in crate::dynamics) fn has_tree(&self) -> bool {
        self.tree().is_some()
    }

    /// The bounding box of a part along the axes of the world: its lowest and its highest corner.
    pub(in crate::dynamics) fn box_of(&self, part: usize, pose: &Pose) -> [DVec3; 2] {
        self.parts()[part].box_in(pose, &Pose::IDENTITY)
    }

    /// The largest distance of a part from the origin of the body, m.
    pub(in crate::dynamics) fn reach_of(&self, part: usize) -> f64 {
        let part = &self.parts()[part];
        part.centre.length() + part.bound
    }

    /// The parts of a mesh that may be within a distance of a place in the axes of the body.
    pub(in crate::dynamics) fn parts_near(&self, place: DVec3, within: f64) -> Vec<usize> {
        match self.tree() {
            Some(tree) => tree.near([place; 2], within, self.parts().len()),
            None => (0..self.parts().len()).collect(),
        }
    }
}
