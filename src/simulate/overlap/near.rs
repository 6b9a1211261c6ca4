//! The pairs of near bodies: those whose bounding balls meet.

use std::collections::BTreeMap;

use super::super::Frame;
use super::grid::{Cell, Grid};
use super::{DEEP, parts};
use crate::scene::Scene;

/// A watched body.
pub(super) struct Watched {
    /// Its index in the scene.
    pub(super) id: usize,
    /// The radius of its bounding ball, m.
    pub(super) radius: f64,
    /// The index of its size.
    size: usize,
    /// Whether forces move it.
    pub(super) moves: bool,
}

/// Bodies of about the same size, which share a grid.
#[derive(Clone, Copy)]
struct Size {
    /// The radii of the bodies are at most 2 to the power of this, and at least half of that, m.
    level: i32,
    /// The edge of the cells, m: the largest distance at which two of the bodies may meet.
    edge: f64,
    /// Whether forces move any of the bodies.
    has_moving: bool,
    /// Whether any of the bodies is not moved by forces.
    has_resting: bool,
}

/// The watched bodies, by size and by cells of space.
pub(super) struct Near {
    pub(super) bodies: Vec<Watched>,
    /// The existing sizes, the smallest first.
    sizes: Vec<Size>,
    grid: Grid,
}

impl Near {
    /// The bodies of a scene that can be compared.
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
            size.edge = size.edge.max(2.0 * (1.0 + DEEP) * radius);
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

    /// Whether forces move any of the bodies.
    pub(super) fn has_moving(&self) -> bool {
        self.sizes.iter().any(|size| size.has_moving)
    }

    /// Sorts the bodies of a frame into cells.
    pub(super) fn fill(&mut self, frame: &Frame) {
        let mut grid = std::mem::take(&mut self.grid);
        grid.fill(self.bodies.iter().map(|body| self.key(frame, body)));
        self.grid = grid;
    }

    /// Calls `show` for every pair whose balls may meet and one of which moves, with the smaller index first; a few pairs come twice.
    /// `show` returns its cost. The sum of costs is returned; the search ends when it exceeds `most`.
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
                let reach = (body.radius + other.radius) * (1.0 + DEEP);
                let Some(there) = frame.body(other.id) else { return };
                let square = (there.location - here).length_squared();
                // A slot may hold unrelated bodies by chance, and also this one.
                let is_pair = j != i && (body.moves || other.moves);
                let is_near = is_pair && square < reach * reach;
                cost = cost.saturating_add(if is_near { show(i.min(j), i.max(j)) } else { 1 });
            };
            // Smaller bodies search for larger ones, so that a large one need not search many cells. Resting bodies search for moving
            // ones.
            for (number, size) in self.sizes.iter().enumerate().skip(body.size) {
                let is_own = number == body.size;
                let here = Cell::of(size.edge, here);
                let moving = |cell: Cell| cell.key(number, true);
                if size.has_moving && is_own && body.moves {
                    // Each pair once: later bodies of the same cell, and those of half of the cells around it.
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

    /// The key of the cell of a body, if the body is present.
    fn key(&self, frame: &Frame, body: &Watched) -> Option<u64> {
        let cell = Cell::of(self.sizes[body.size].edge, frame.body(body.id)?.location);
        Some(cell.key(body.size, body.moves))
    }
}
