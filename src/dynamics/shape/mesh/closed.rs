//! Check that a surface encloses a solid.

use glam::DVec3;

/// Why a surface encloses no solid.
#[derive(Debug, Clone, PartialEq)]
pub enum Flaw {
    /// It has edges at which it ends.
    Open {
        /// The number of such edges.
        edges: usize,
        /// The ends of one of them, in the coordinates of its file.
        first: [DVec3; 2],
    },
    /// Triangles that meet there do not agree on which side is outside.
    Inconsistent {
        /// The number of such edges.
        edges: usize,
        /// The ends of one of them, in the coordinates of its file.
        first: [DVec3; 2],
    },
    /// It is closed, and has no volume.
    Flat,
}

/// A triangle's edge from one vertex to another: the smaller number, the larger one, and the sense, in one number, so
/// that all triangles at an edge stand together when sorted.
fn edge(from: u32, to: u32) -> u64 {
    let (low, high) = (from.min(to), from.max(to));
    u64::from(low) << 33 | u64::from(high) << 1 | u64::from(from > to)
}

/// Checks that every edge is passed as often in one sense as in the other: then the surface has no boundary, and the
/// theorem of divergence holds, whether or not more than two triangles meet somewhere. There are fewer than 2³¹ vertices.
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
    // An open surface may be inconsistent as well; that it is open comes first.
    match (open, inconsistent) {
        ((edges, Some(first)), _) => Err(Flaw::Open { edges, first: ends(first) }),
        (_, (edges, Some(first))) => Err(Flaw::Inconsistent { edges, first: ends(first) }),
        _ => Ok(()),
    }
}
