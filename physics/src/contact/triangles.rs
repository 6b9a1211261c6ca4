//! The triangles of a mesh as convex parts, each with its face, edges and corners.

use std::collections::BTreeMap;

use glam::DVec3;

use super::feature::{Feature, Normals, Outline};
use super::patch::Patch;
use super::solid::Pose;
use crate::shape::Mesh;

/// Adjacent triangles count as coplanar if the sine of the angle between them is below this. Their common edge then makes no contact.
const COPLANAR_SINE: f64 = 1e-9;

/// Returns the triangles of a mesh, each with its corners and its features. `pose` is the pose of the mesh in body axes.
///
/// A mesh can be touched from both sides. An edge or a corner that is convex on neither side is a seam, which makes no contact.
pub(super) fn triangles(mesh: &Mesh, scale: f64, pose: &Pose) -> Vec<([DVec3; 3], Vec<Feature>)> {
    let vertices: Vec<DVec3> = mesh.vertices().iter().map(|vertex| pose.point(scale * *vertex)).collect();
    let corners = |triangle: &[u32; 3]| triangle.map(|i| vertices[i as usize]);
    // Triangles without an area are left out. Their neighbors have the same edges.
    let solid: Vec<[u32; 3]> =
        mesh.triangles().iter().copied().filter(|triangle| normal(corners(triangle)).is_some()).collect();
    // For each edge, the directions from the edge into its triangles; for each corner, the directions along its edges.
    let mut of_edges: BTreeMap<[u32; 2], Vec<DVec3>> = BTreeMap::new();
    let mut of_corners: BTreeMap<u32, Vec<DVec3>> = BTreeMap::new();
    for triangle in &solid {
        for k in 0..3 {
            let [a, b, c] = [triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
            let [at, to, third] = [a, b, c].map(|i| vertices[i as usize]);
            let along = (to - at).normalize_or_zero();
            let inward = (third - at).reject_from_normalized(along).normalize_or_zero();
            of_edges.entry([a.min(b), a.max(b)]).or_default().push(inward);
            of_corners.entry(a).or_default().push(along);
            of_corners.entry(b).or_default().push(-along);
        }
    }
    let features = |triangle: &[u32; 3]| {
        let places = corners(triangle);
        let normal = normal(places).unwrap_or(DVec3::Y);
        let mut features = Vec::new();
        let mut outline = Vec::new();
        let mut others = Vec::new();
        for k in 0..3 {
            let [i, j] = [triangle[k], triangle[(k + 1) % 3]];
            let [at, to, third] = [places[k], places[(k + 1) % 3], places[(k + 2) % 3]];
            let along = (to - at).normalize_or_zero();
            outline.push([at, (third - at).reject_from_normalized(along).normalize_or_zero()]);
            let (middle, half) = (0.5 * (at + to), 0.5 * at.distance(to));
            let into = of_edges.get(&[i.min(j), i.max(j)]).cloned().unwrap_or_default();
            let outward = outward(&into);
            let own = outline[k][1];
            let patch =
                Patch::Line { at: middle, along, half, radius: 0.0, outward: outward.unwrap_or(-own) };
            let normals = Normals::Away(if outward.is_some() { into } else { vec![own] });
            let edge = Feature::new(patch, Outline::Length { at: middle, along, half }, normals);
            others.push(Feature { is_seam: outward.is_none(), ..edge });
            let edges = of_corners.get(&i).cloned().unwrap_or_default();
            let is_seam = !outward_of_all(&edges);
            let back = (places[(k + 2) % 3] - at).normalize_or_zero();
            let normals = Normals::Away(if is_seam { vec![along, back] } else { edges });
            let corner = Feature::new(Patch::Point { at, radius: 0.0 }, Outline::All, normals);
            others.push(Feature { is_seam, ..corner });
        }
        for normal in [normal, -normal] {
            features.push(Feature::new(
                Patch::Plane { at: places[0], normal },
                Outline::Edges(outline.clone()),
                Normals::All,
            ));
        }
        features.append(&mut others);
        features
    };
    solid.iter().map(|triangle| (corners(triangle), features(triangle))).collect()
}

/// Returns the unit normal of a triangle. `None` for a triangle without an area.
fn normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    (b - a).normalize_or_zero().cross((c - a).normalize_or_zero()).try_normalize()
}

/// Returns the direction in which an edge of a mesh is convex. `into` holds the directions from the edge into its triangles. `None` if the
/// triangles are coplanar or lie on all sides of the edge.
fn outward(into: &[DVec3]) -> Option<DVec3> {
    let sum: DVec3 = into.iter().sum();
    let out = -sum.try_normalize()?;
    (sum.length() > COPLANAR_SINE && into.iter().all(|direction| direction.dot(out) <= 0.0)).then_some(out)
}

/// Returns true if a corner of a mesh is convex. `edges` holds the directions of its edges.
fn outward_of_all(edges: &[DVec3]) -> bool {
    let out = -edges.iter().sum::<DVec3>().normalize_or_zero();
    edges.iter().all(|edge| edge.dot(out) < -COPLANAR_SINE)
}
