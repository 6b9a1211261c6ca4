//! Detects bodies that move into each other in scenes without contacts, and bodies that touch at the start.

mod grid;
mod near;
#[cfg(test)]
mod tests;

use std::collections::HashSet;

use glam::{DQuat, DVec3};

use self::near::Near;
use super::Frame;
use crate::physics::{Placed, Shape};
use crate::scene::{Body, Scene};

/// Two bodies count as overlapping if they still overlap after each has shrunk by this fraction of its size.
const OVERLAP_TOLERANCE: f64 = 0.01;

/// The first two bodies that moved into each other. They did not touch in their first common frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlap {
    /// The names of the two bodies.
    pub bodies: [String; 2],
    /// The time of the first frame in which the two bodies overlap, s.
    pub time: f64,
}

/// Watches a run for the first two bodies that move into each other.
///
/// Some overlaps are intended and ignored: between bodies that touch in their first common frame, between bodies joined together, and
/// between two bodies that no force moves. Shapes that are not convex (meshes, rings) and overlaps between frames are ignored, too.
///
/// The work is proportional to the number of bodies. After a frame with very many near pairs, some frames are skipped. If nearly all
/// bodies are near each other, the watch ends.
pub(super) struct Watch<'a> {
    scene: &'a Scene,
    near: Near,
    /// The pairs that are allowed to overlap: the two bodies are joined together, or touched in their first common frame.
    together: HashSet<(usize, usize)>,
    /// For each watched body, whether it was present in the last checked frame.
    were_there: Vec<bool>,
    found: Option<Overlap>,
    /// True after the search for overlaps has ended.
    is_over: bool,
    /// The number of frames to skip.
    pause: u64,
}

/// The cost of an overlap test between two convex shapes, relative to a comparison of distances. Shapes other than balls need an iterative
/// test.
const SHAPE_TEST_COST: u64 = 64;
/// The allowed mean cost of overlap tests per body and frame. It is less than the cost of the body's line in a script.
const COST_PER_BODY: u64 = 32;
/// The allowed cost of overlap tests per frame in addition to [`COST_PER_BODY`]. It does not depend on the number of bodies.
const COST_PER_FRAME: u64 = 16_384;
/// The largest cost of overlap tests in one frame, as a multiple of the allowed mean cost. The watch ends after a frame that costs more.
const MAX_COST_RATIO: u64 = 128;
/// The largest number of intended overlaps per body. Beyond it, the watch ends. In a packing of equal balls, there are six touching pairs
/// per ball.
const MAX_INTENDED_OVERLAPS: usize = 64;

impl<'a> Watch<'a> {
    pub(super) fn new(scene: &'a Scene) -> Watch<'a> {
        let near = Near::new(scene);
        let is_over = scene.simulation.contacts.is_some() || !near.has_moving();
        let number = |id: usize| near.bodies.binary_search_by_key(&id, |body| body.id).ok();
        let joined = scene.joints.iter().filter_map(|joint| {
            let [i, j] = joint.kind.between().map(|end| end.body().and_then(|id| number(id.index())));
            Some((i?.min(j?), i?.max(j?)))
        });
        // Bodies joined together may overlap.
        let together = joined.collect();
        let were_there = vec![false; near.bodies.len()];
        Watch { scene, near, together, were_there, found: None, is_over, pause: 0 }
    }

    /// Checks the next frame of the run for overlaps.
    pub(super) fn see(&mut self, frame: &Frame) {
        if self.is_over {
            return;
        }
        if self.pause > 0 {
            self.pause -= 1;
            return;
        }
        self.near.fill(frame);
        let mut first: Option<(usize, usize)> = None;
        let mut together = std::mem::take(&mut self.together);
        let most = MAX_INTENDED_OVERLAPS * self.near.bodies.len();
        let cost = self.near.each_pair(frame, MAX_COST_RATIO * self.usual(), |i, j| {
            if !(self.were_there[i] && self.were_there[j]) {
                if self.meet(frame, i, j, 1.0 + OVERLAP_TOLERANCE) {
                    together.insert((i, j));
                }
                return if together.len() > most { u64::MAX } else { self.cost(i, j) };
            }
            let is_earlier = first.is_none_or(|first| (i, j) < first);
            if !is_earlier || together.contains(&(i, j)) {
                return 1;
            }
            if self.meet(frame, i, j, 1.0 - OVERLAP_TOLERANCE) {
                first = Some((i, j));
            }
            self.cost(i, j)
        });
        self.together = together;
        let are_there = self.near.bodies.iter().map(|body| frame.body(body.id).is_some());
        are_there.zip(&mut self.were_there).for_each(|(is_there, was_there)| *was_there = is_there);
        let name = |i: usize| self.scene.bodies[self.near.bodies[i].id].name.to_string();
        self.found = first.map(|(i, j)| Overlap { bodies: [name(i), name(j)], time: frame.time });
        self.is_over = self.found.is_some() || cost > MAX_COST_RATIO * self.usual();
        self.pause = cost / self.usual();
    }

    /// Returns the first two bodies that moved into each other. `None` without an overlap.
    pub(super) fn finish(self) -> Option<Overlap> {
        self.found
    }

    /// The allowed mean cost of overlap tests in a frame.
    fn usual(&self) -> u64 {
        COST_PER_FRAME + COST_PER_BODY * self.near.bodies.len() as u64
    }

    /// True if two bodies overlap after both are scaled by a factor.
    fn meet(&self, frame: &Frame, i: usize, j: usize, scale: f64) -> bool {
        let placed = |i: usize| {
            let id = self.near.bodies[i].id;
            let shape = &self.scene.bodies[id].shape;
            frame.body(id).into_iter().flat_map(move |at| placed(shape, (at.location, at.orientation), scale))
        };
        placed(i).any(|one| placed(j).any(|other| one.intersects(&other)))
    }

    /// The cost of an overlap test between two bodies.
    fn cost(&self, i: usize, j: usize) -> u64 {
        let [one, other] = [i, j].map(|i| &self.scene.bodies[self.near.bodies[i].id].shape);
        match (one, other) {
            (Shape::Sphere { .. }, Shape::Sphere { .. }) => 1,
            _ => SHAPE_TEST_COST * (parts(one).count() * parts(other).count()) as u64,
        }
    }
}

/// Returns true if two bodies, in their drawn sizes, touch or overlap at the start. Always false for shapes that are not convex (meshes,
/// rings).
pub(crate) fn touch_at_start(one: &Body, other: &Body) -> bool {
    /// The factor by which shapes are enlarged, so that shapes that only touch count as overlapping.
    const ENLARGEMENT_FACTOR: f64 = 1.0 + OVERLAP_TOLERANCE;
    let shapes = [one, other].map(Body::drawn);
    let [one, other] = [one, other].map(|body| (body.start.location, body.start.orientation));
    let others: Vec<Placed<'_>> = placed(&shapes[1], other, ENLARGEMENT_FACTOR).collect();
    placed(&shapes[0], one, ENLARGEMENT_FACTOR).any(|part| others.iter().any(|other| part.intersects(other)))
}

/// Returns the convex parts of a shape in the world, each enlarged by a factor. `location` (m) and `orientation` are those of its body.
fn placed(
    shape: &Shape,
    (location, orientation): (DVec3, DQuat),
    scale: f64,
) -> impl Iterator<Item = Placed<'_>> {
    parts(shape).map(move |(shape, at, turn)| Placed {
        shape,
        location: location + orientation * at,
        orientation: orientation * turn,
        scale,
    })
}

/// Returns the convex parts of a shape, each with its pose in body axes.
fn parts(shape: &Shape) -> impl Iterator<Item = (&Shape, DVec3, DQuat)> {
    let (whole, parts) = match shape {
        Shape::Compound(compound) => (None, compound.parts()),
        shape => (Some((shape, DVec3::ZERO, DQuat::IDENTITY)), &[][..]),
    };
    let parts = parts.iter().map(|part| (&part.shape, part.location, part.orientation));
    whole.into_iter().chain(parts).filter(|(shape, ..)| shape.farthest(DVec3::X).is_some())
}
