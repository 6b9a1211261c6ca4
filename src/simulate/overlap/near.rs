//! Finds the pairs of near bodies: those with overlapping bounding spheres.

use std::collections::BTreeMap;

use super::super::Frame;
use super::grid::{Cell, Grid};
use super::{OVERLAP_TOLERANCE, parts};
use crate::scene::Scene;

/// A body that is watched for overlaps.
pub(super) struct Watched {
    /// The index of the body in the scene.
    pub(super) id: usize,
    /// The radius of the bounding sphere of the body, m.
    pub(super) radius: f64,
    /// The index of the size class of the body.
    size: usize,
    /// True if forces move the body.
    pub(super) moves: bool,
}

/// A size class: bodies of about the same size, which share a grid.
#[derive(Clone, Copy)]
struct Size {
    /// The binary logarithm of the upper bound of the radii (m) in the class. All radii are larger than half of this bound.
    level: i32,
    /// The edge length of the grid's cells, m: the largest center distance at which two bodies of the class may overlap.
    edge: f64,
    /// True if forces move some of the bodies in the class.
    has_moving: bool,
    /// True if some bodies in the class are not moved by forces.
    has_resting: bool,
}

/// The watched bodies by size class and grid cell.
pub(super) struct Near {
    pub(super) bodies: Vec<Watched>,
    /// The size classes of the scene, the smallest first.
    sizes: Vec<Size>,
    grid: Grid,
}

impl Near {
    /// Collects the bodies of a scene that have convex parts, and their size classes.
    pub(super) fn new(scene: &Scene) -> Near {
        let mut levels = BTreeMap::new();
        let mut bodies: Vec<(Watched, i32)> = Vec::new();
        for (id, body) in scene.bodies.iter().enumerate() {
            let radius = body.shape.bounding_radius().filter(|radius| *radius > 0.0);
            let Some(radius) = radius.filter(|_| parts(&body.shape).next().is_some()) else { continue };
            #[allow(
                clippy::cast_possible_truncation,
                reason = "the sizes of a scene have logarithms of three digits"
            )]
            let level = libm::ceil(libm::log2(radius)) as i32;
            let moves = !body.start.fixed && body.motion.is_none();
            let none = Size { level, edge: 0.0, has_moving: false, has_resting: false };
            let size = levels.entry(level).or_insert(none);
            size.edge = size.edge.max(2.0 * (1.0 + OVERLAP_TOLERANCE) * radius);
            size.has_moving |= moves;
            size.has_resting |= !moves;
            bodies.push((Watched { id, radius, size: 0, moves }, level));
        }
        let sizes: Vec<Size> = levels.into_values().collect();
        let numbered = |(body, level): (Watched, i32)| {
            let size = sizes.partition_point(|size| size.level < level);
            Watched { size, ..body }
        };
        let bodies = bodies.into_iter().map(numbered).collect();
        Near { bodies, sizes, grid: Grid::default() }
    }

    /// True if forces move any of the bodies.
    pub(super) fn has_moving(&self) -> bool {
        self.sizes.iter().any(|size| size.has_moving)
    }

    /// Sorts the bodies of a frame into grid cells.
    pub(super) fn fill(&mut self, frame: &Frame) {
        let mut grid = std::mem::take(&mut self.grid);
        grid.fill(self.bodies.iter().map(|body| self.key(frame, body)));
        self.grid = grid;
    }

    /// Calls `show` for every pair of bodies with overlapping bounding spheres, the smaller index first. Skips pairs that no force moves;
    /// a few pairs are shown twice. `show` returns its cost. The result is the total cost; the search ends when the total exceeds `most`.
    pub(super) fn each_pair(
        &self,
        frame: &Frame,
        most: u64,
        mut show: impl FnMut(usize, usize) -> u64,
    ) -> u64 {
        let mut cost: u64 = 0;
        for (i, body) in self.bodies.iter().enumerate() {
            if cost > most {
                break;
            }
            let Some(here) = frame.body(body.id).map(|body| body.location) else { continue };
            let mut look = |j: usize| {
                let other = &self.bodies[j];
                let reach = (body.radius + other.radius) * (1.0 + OVERLAP_TOLERANCE);
                let Some(there) = frame.body(other.id) else { return };
                let square = (there.location - here).length_squared();
                // A slot may contain bodies of unrelated cells, and the searching body itself.
                let is_pair = j != i && (body.moves || other.moves);
                let is_near = is_pair && square < reach * reach;
                cost = cost.saturating_add(if is_near { show(i.min(j), i.max(j)) } else { 1 });
            };
            // Smaller bodies search for larger ones, so that no large body searches many small cells. Bodies that no force moves search
            // only for moving bodies.
            for (number, size) in self.sizes.iter().enumerate().skip(body.size) {
                let is_own = number == body.size;
                let here = Cell::of(size.edge, here);
                let moving = |cell: Cell| cell.key(number, true);
                if size.has_moving && is_own && body.moves {
                    // To visit each pair once, search for later bodies in the same cell, and for all bodies in half of the neighboring
                    // cells.
                    self.grid.each(moving(here), |j| {
                        if j > i {
                            look(j);
                        }
                    });
                    here.half_around().for_each(|cell| self.grid.each(moving(cell), &mut look));
                } else if size.has_moving && !is_own {
                    here.around().for_each(|cell| self.grid.each(moving(cell), &mut look));
                }
                if size.has_resting && body.moves {
                    here.around().for_each(|cell| self.grid.each(cell.key(number, false), &mut look));
                }
            }
        }
        cost
    }

    /// The hash key of the cell that contains a body. `None` if the body is absent.
    fn key(&self, frame: &Frame, body: &Watched) -> Option<u64> {
        let cell = Cell::of(self.sizes[body.size].edge, frame.body(body.id)?.location);
        Some(cell.key(body.size, body.moves))
    }
}
