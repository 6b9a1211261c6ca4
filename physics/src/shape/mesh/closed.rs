//! Checks whether a surface of triangles encloses a solid.

use glam::DVec3;

/// The reason why a surface of triangles encloses no solid.
#[derive(Debug, Clone, PartialEq)]
pub enum Flaw {
    /// The surface is open: at some edges, the number of adjacent triangles is odd.
    Open {
        /// The number of open edges.
        edges: usize,
        /// The two ends of one open edge, in the coordinates of the mesh file.
        first: [DVec3; 2],
    },
    /// The surface is inconsistent: at some edges, adjacent triangles disagree about which side is outside.
    Inconsistent {
        /// The number of inconsistent edges.
        edges: usize,
        /// The two ends of one inconsistent edge, in the coordinates of the mesh file.
        first: [DVec3; 2],
    },
    /// The surface is closed, but encloses no volume.
    Flat,
}

/// Encodes a triangle's edge, from one vertex to another, as one number: the smaller vertex index, the larger index, and the direction in
/// the lowest bit. After sorting, all triangles at the same edge are adjacent.
fn edge(from: u32, to: u32) -> u64 {
    let (low, high) = (from.min(to), from.max(to));
    u64::from(low) << 33 | u64::from(high) << 1 | u64::from(from > to)
}

/// Checks that triangles pass every edge equally often in both directions. The surface then has no boundary, and the divergence theorem
/// holds, even where more than two triangles meet at an edge. The number of vertices must be below 2³¹.
pub(super) fn check(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<(), Flaw> {
    let mut edges: Vec<u64> = Vec::with_capacity(3 * triangles.len());
    edges.extend(triangles.iter().flat_map(|&[a, b, c]| [edge(a, b), edge(b, c), edge(c, a)]));
    edges.sort_unstable();
    let (mut open, mut inconsistent) = ((0, None), (0, None));
    for triangles in edges.chunk_by(|a, b| a >> 1 == b >> 1) {
        let backward = triangles.iter().filter(|&edge| edge & 1 == 1).count();
        if 2 * backward == triangles.len() {
            continue;
        }
        let (count, first) = if triangles.len() % 2 == 1 { &mut open } else { &mut inconsistent };
        *count += 1;
        first.get_or_insert(triangles[0]);
    }
    let ends = |edge: u64| [edge >> 33, edge >> 1 & 0xffff_ffff].map(|end| vertices[end as usize]);
    // A surface may be both open and inconsistent. The open edges are then reported.
    match (open, inconsistent) {
        ((edges, Some(first)), _) => Err(Flaw::Open { edges, first: ends(first) }),
        (_, (edges, Some(first))) => Err(Flaw::Inconsistent { edges, first: ends(first) }),
        _ => Ok(()),
    }
}
