//! The extent of vertices along a direction.

use glam::DVec3;

/// The number of vertices in a block. Vertices that follow each other in a file are mostly near each other.
const VERTICES_OF_A_BLOCK: usize = 64;

/// The boxes around groups of vertices, so that the farthest of a million is found by looking at few of them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Blocks(Vec<Around>);

/// The middle and half the edges of a box.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Around {
    middle: DVec3,
    half: DVec3,
}

impl Blocks {
    pub(super) fn new(vertices: &[DVec3]) -> Blocks {
        let around = |vertices: &[DVec3]| Around { middle: middle(vertices), half: extent(vertices) / 2.0 };
        Blocks(vertices.chunks(VERTICES_OF_A_BLOCK).map(around).collect())
    }

    /// The largest product of a vertex and a direction.
    pub(super) fn support(&self, vertices: &[DVec3], direction: DVec3) -> f64 {
        let mut farthest = f64::NEG_INFINITY;
        for (block, vertices) in self.0.iter().zip(vertices.chunks(VERTICES_OF_A_BLOCK)) {
            // Rounding errors of the bound must not hide a vertex.
            let rounding = 1e-12 * (block.middle.abs() + block.half).element_sum();
            let most = block.middle.dot(direction) + block.half.dot(direction.abs()) + rounding;
            if most >= farthest {
                farthest = vertices.iter().map(|vertex| vertex.dot(direction)).fold(farthest, f64::max);
            }
        }
        farthest
    }
}

fn corners(vertices: &[DVec3]) -> (DVec3, DVec3) {
    let first = vertices.first().copied().unwrap_or_default();
    vertices.iter().fold((first, first), |(low, high), vertex| (low.min(*vertex), high.max(*vertex)))
}

/// The middle of the box around some vertices.
pub(super) fn middle(vertices: &[DVec3]) -> DVec3 {
    let (low, high) = corners(vertices);
    (low + high) / 2.0
}

/// The edges of the box around some vertices.
pub(super) fn extent(vertices: &[DVec3]) -> DVec3 {
    let (low, high) = corners(vertices);
    high - low
}
