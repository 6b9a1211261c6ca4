//! The triangles of meshes.

use std::collections::HashMap;

use glam::DVec3;

use super::{Triangles, normals};
use crate::physics::Mesh;

/// Computes the triangles of a mesh about its center, in the units of the mesh. Their normals equal those in the POV-Ray scripts: smooth
/// if the mesh has a smoothing angle, otherwise one normal per triangle.
pub(super) fn triangles(mesh: &Mesh) -> Triangles {
    match mesh.smooth() {
        Some(smooth) => round(mesh, smooth),
        None => flat(mesh),
    }
}

fn round(mesh: &Mesh, smooth: f64) -> Triangles {
    let mut out = Triangles::default();
    let normals = normals::of_corners(mesh, smooth);
    // The vertex for each pair of position and normal. The map is never iterated, so its order does not matter.
    let mut numbers: HashMap<(u32, u32), u32> = HashMap::new();
    for (places, directions) in mesh.triangles().iter().zip(&normals.corners) {
        let corners = [0, 1, 2].map(|i| {
            let (place, direction) = (places[i], directions[i]);
            *numbers.entry((place, direction)).or_insert_with(|| {
                out.vertex(mesh.vertices()[place as usize], normals.vectors[direction as usize])
            })
        });
        out.triangle(corners);
    }
    out
}

fn flat(mesh: &Mesh) -> Triangles {
    let mut out = Triangles::default();
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|vertex| mesh.vertices()[vertex as usize]);
        let normal = (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Y);
        let corners = [a, b, c].map(|place| out.vertex(place, normal));
        out.triangle(corners);
    }
    out
}
