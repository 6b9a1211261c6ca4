//! The collision shapes of meshes.

use std::sync::Arc;

use glam::DVec3;
use rapier3d_f64::parry::shape::TriMeshFlags;
use rapier3d_f64::prelude::{Pose, SharedShape};

use super::super::shape::{Mesh, Shape};
use super::convex_parts::convex_parts;

/// A mesh counts as convex if the volume of its convex hull exceeds its own volume by at most this fraction.
const CONVEXITY_TOLERANCE: f64 = 1e-3;
/// Convex parts are smaller than the solid by this fraction. The physics engine finds wrong overlaps of solids that touch exactly, such as
/// the stones of an arch.
const PART_SHRINKAGE: f64 = 1e-6;

/// The collision shapes that stand for a mesh, each with its pose.
type Parts = Vec<(Pose, SharedShape)>;

/// The solids of the meshes of a run. Bodies with the same mesh share them.
#[derive(Default)]
pub(super) struct MeshSolids {
    known: Vec<(Arc<Mesh>, f64, bool, Parts)>,
}

impl MeshSolids {
    /// Returns the solids of a mesh, enlarged by `scale`. A moving mesh becomes its convex hull if it is convex, and several convex parts
    /// if not. A mesh at rest becomes its triangles.
    pub(super) fn of(&mut self, mesh: &Arc<Mesh>, scale: f64, moves: bool) -> Parts {
        let is_same = |(other, its_scale, its_moves, _): &&(Arc<Mesh>, f64, bool, Parts)| {
            Arc::ptr_eq(other, mesh) && *its_scale == scale && *its_moves == moves
        };
        if let Some((.., parts)) = self.known.iter().find(is_same) {
            return parts.clone();
        }
        let vertices: Vec<DVec3> = mesh.vertices().iter().map(|vertex| scale * *vertex).collect();
        let parts = if moves { convex(mesh, scale, &vertices) } else { triangles(mesh, vertices) };
        self.known.push((Arc::clone(mesh), scale, moves, parts.clone()));
        parts
    }
}

/// Returns the triangles of a mesh at rest.
fn triangles(mesh: &Mesh, vertices: Vec<DVec3>) -> Parts {
    // A closed surface has an inside. An open surface can be touched from both sides.
    let flags = match mesh.flaw() {
        None => TriMeshFlags::FIX_INTERNAL_EDGES,
        Some(_) => TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED,
    };
    let triangles = SharedShape::trimesh_with_flags(vertices, mesh.triangles().to_vec(), flags);
    triangles.map(|triangles| vec![(Pose::IDENTITY, triangles)]).unwrap_or_default()
}

/// Returns convex solids that together are a moving mesh.
fn convex(mesh: &Arc<Mesh>, scale: f64, vertices: &[DVec3]) -> Parts {
    let whole = hull(vertices);
    let volume = Shape::volume(&Shape::Mesh { mesh: Arc::clone(mesh), scale }).unwrap_or(0.0);
    match whole {
        Some(hull) if hull.mass_properties(1.0).mass() <= volume * (1.0 + CONVEXITY_TOLERANCE) => {
            vec![(Pose::IDENTITY, hull)]
        }
        whole => {
            if let Some(parts) = convex_parts(vertices, mesh.triangles(), volume) {
                let hulls = parts.iter().filter_map(|part| hull(part));
                return hulls.map(|hull| (Pose::IDENTITY, hull)).collect();
            }
            let parts = SharedShape::convex_decomposition(vertices, mesh.triangles());
            match parts.as_compound() {
                Some(compound) => compound.shapes().to_vec(),
                None => whole.into_iter().map(|hull| (Pose::IDENTITY, hull)).collect(),
            }
        }
    }
}

/// Returns the convex hull of some points, slightly smaller; `None` if they lie in a plane.
fn hull(points: &[DVec3]) -> Option<SharedShape> {
    let centre = points.iter().sum::<DVec3>() / points.len() as f64;
    let corners: Vec<DVec3> = points.iter().map(|point| point.lerp(centre, PART_SHRINKAGE)).collect();
    SharedShape::convex_hull(&corners)
}
