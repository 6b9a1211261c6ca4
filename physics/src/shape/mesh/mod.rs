//! Meshes: surfaces of triangles, and the solids that they enclose.

mod closed;
mod integrals;
mod reach;
#[cfg(test)]
mod tests;

use glam::{DQuat, DVec3};

pub use closed::Flaw;

use self::reach::Blocks;
use super::principal::principal;

/// A surface of triangles, in the units of its file. A closed surface encloses a homogeneous solid.
///
/// The axes are those of the file. The origin is the centre of mass of the solid, or that of the surface if there is no solid. Seen from
/// outside of a closed surface, the corners of each triangle are in counter-clockwise order.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    name: String,
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    smooth: Option<f64>,
    blocks: Blocks,
    solid: Result<Solid, Flaw>,
}

/// The mass properties of the solid inside a closed surface.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Solid {
    volume: f64,
    /// The principal moments of inertia, divided by the mass, in squared units of the mesh.
    inertia: DVec3,
    principal_axes: DQuat,
}

impl Mesh {
    /// Creates a mesh with a name from vertices and from triangles that refer to vertices by index.
    ///
    /// Triangles with two equal corners are dropped. If a closed surface is oriented inwards, all its triangles are flipped.
    ///
    /// # Panics
    /// If a triangle refers to a vertex that does not exist.
    #[must_use]
    pub fn new(name: &str, mut vertices: Vec<DVec3>, mut triangles: Vec<[u32; 3]>) -> Mesh {
        triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        let closed = closed::check(&vertices, &triangles);
        // The integrals lose digits far from the origin, as differences of large numbers. So the vertices are moved to the origin first.
        let middle = reach::middle(&vertices);
        vertices.iter_mut().for_each(|vertex| *vertex -= middle);
        let solid = closed.and_then(|()| {
            let mut whole = integrals::over_solid(&vertices, &triangles);
            // A mesh whose volume is within rounding errors of zero counts as flat.
            let size = reach::extent(&vertices).max_element();
            if whole.volume.abs() <= 1e-12 * size * size * size {
                return Err(Flaw::Flat);
            }
            if whole.volume < 0.0 {
                triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
                whole = whole.inside_out();
            }
            Ok(whole)
        });
        let centre = match &solid {
            Ok(whole) => whole.centre,
            Err(_) => integrals::centre_of_surface(&vertices, &triangles),
        };
        vertices.iter_mut().for_each(|vertex| *vertex -= centre);
        let solid = solid.map(|whole| {
            let (inertia, principal_axes) = principal(whole.inertia_per_mass());
            Solid { volume: whole.volume, inertia, principal_axes }
        });
        let blocks = Blocks::new(&vertices);
        Mesh { name: name.to_owned(), vertices, triangles, smooth: None, blocks, solid }
    }

    /// Returns the mesh with smooth shading: edges are drawn round where two faces meet at no more than `smooth`, rad. The dynamics uses
    /// the flat triangles.
    #[must_use]
    pub fn with_smooth(self, smooth: Option<f64>) -> Mesh {
        Mesh { smooth, ..self }
    }

    /// Creates a surface without mass properties, for drawing. Its vertices are kept as given, without a shift of the origin.
    #[must_use]
    pub fn surface(name: &str, vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Mesh {
        let blocks = Blocks::new(&vertices);
        Mesh { name: name.to_owned(), vertices, triangles, smooth: None, blocks, solid: Err(Flaw::Flat) }
    }

    /// The name of the mesh.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The vertices of the mesh, relative to its centre, in units of the mesh.
    #[must_use]
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// The triangles of the mesh: three vertex indices each.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The largest angle between two faces at which their common edge is drawn round, rad; `None` if all edges are drawn sharp.
    #[must_use]
    pub fn smooth(&self) -> Option<f64> {
        self.smooth
    }

    /// The reason why the mesh encloses no solid; `None` if it encloses one.
    #[must_use]
    pub fn flaw(&self) -> Option<&Flaw> {
        self.solid.as_ref().err()
    }

    pub(super) fn volume(&self) -> Option<f64> {
        self.solid.as_ref().ok().map(|solid| solid.volume)
    }

    pub(super) fn inertia(&self) -> DVec3 {
        self.solid.as_ref().map_or(DVec3::ZERO, |solid| solid.inertia)
    }

    pub(super) fn principal_axes(&self) -> DQuat {
        self.solid.as_ref().map_or(DQuat::IDENTITY, |solid| solid.principal_axes)
    }

    /// Returns the largest extent of the mesh from its origin in a direction in its own frame, in units of the mesh.
    pub(super) fn support(&self, direction: DVec3) -> f64 {
        self.blocks.support(&self.vertices, direction)
    }

    /// Returns the distance of the farthest vertex from the mesh's origin, in units of the mesh.
    pub(super) fn bounding_radius(&self) -> f64 {
        self.vertices().iter().map(|vertex| vertex.length()).fold(0.0, f64::max)
    }

    /// Returns half of the shortest edge of the bounding box, in units of the mesh; `None` if the mesh is flat.
    pub(super) fn half_thickness(&self) -> Option<f64> {
        Some(reach::extent(&self.vertices).min_element() / 2.0).filter(|half| *half > 0.0)
    }
}
