//! Computes the extent of a set of vertices.

use glam::DVec3;

/// The number of vertices in a block. Consecutive vertices of a file are mostly close to each other.
const VERTICES_OF_A_BLOCK: usize = 64;

/// The bounding boxes of blocks of consecutive vertices. With these boxes, the search for the farthest vertex in a direction visits the
/// vertices of only a few blocks.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Blocks(Vec<Around>);

/// A bounding box: its centre, and half of its edges.
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

    /// Returns the largest dot product of a vertex with a direction.
    pub(super) fn support(&self, vertices: &[DVec3], direction: DVec3) -> f64 {
        let mut farthest = f64::NEG_INFINITY;
        for (block, vertices) in self.0.iter().zip(vertices.chunks(VERTICES_OF_A_BLOCK)) {
            // This margin keeps rounding errors of the bound from excluding the farthest vertex.
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

/// Returns the centre of the bounding box of some vertices.
pub(super) fn middle(vertices: &[DVec3]) -> DVec3 {
    let (low, high) = corners(vertices);
    (low + high) / 2.0
}

/// Returns the edge lengths of the bounding box of some vertices.
pub(super) fn extent(vertices: &[DVec3]) -> DVec3 {
    let (low, high) = corners(vertices);
    high - low
}
