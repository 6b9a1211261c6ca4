//! Merges vertices of a mesh that are at the same position.

use glam::DVec3;

use super::Triangles;

/// Merges vertices at exactly the same position and removes vertices that no triangle uses. Keeps the order of the vertices. Merging is
/// needed because STL files have no shared vertices, and programs that write OBJ files split surfaces at the seams of textures.
pub(super) fn weld(mut positions: Vec<DVec3>, mut triangles: Vec<[u32; 3]>) -> Triangles {
    // Adding 0 turns −0 into 0, so that both compare as the same position.
    positions.iter_mut().for_each(|p| *p += DVec3::ZERO);
    // Sorting needs less memory than a hash map of positions, and gives the same result on every machine.
    let place = |vertex: u32| positions[vertex as usize].to_array();
    let compare = |a: &u32, b: &u32| {
        let ([ax, ay, az], [bx, by, bz]) = (place(*a), place(*b));
        ax.total_cmp(&bx).then(ay.total_cmp(&by)).then(az.total_cmp(&bz)).then(a.cmp(b))
    };
    #[allow(
        clippy::cast_possible_truncation,
        reason = "readers give no more vertices than 32 bits can count"
    )]
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_unstable_by(compare);
    let mut first = vec![0; positions.len()];
    for same in order.chunk_by(|a, b| positions[*a as usize] == positions[*b as usize]) {
        same.iter().for_each(|&vertex| first[vertex as usize] = same[0]);
    }
    drop(order);

    /// The number of a vertex that no triangle uses.
    const UNUSED_VERTEX: u32 = u32::MAX;
    let mut number = vec![UNUSED_VERTEX; positions.len()];
    let corners = || triangles.iter().flatten().map(|&corner| first[corner as usize]);
    corners().for_each(|corner| number[corner as usize] = 0);
    let used = number.iter_mut().filter(|number| **number != UNUSED_VERTEX);
    used.zip(0..).for_each(|(number, next)| *number = next);
    for corner in triangles.iter_mut().flatten() {
        *corner = number[first[*corner as usize] as usize];
    }
    let mut at = 0;
    positions.retain(|_| {
        at += 1;
        number[at - 1] != UNUSED_VERTEX
    });
    positions.shrink_to_fit();
    (positions, triangles)
}
