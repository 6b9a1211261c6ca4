//! Surfaces of triangles.

mod closed;
mod integrals;
mod reach;
#[cfg(test)]
mod tests;

use glam::{DQuat, DVec3};

pub use closed::Flaw;

use self::reach::Blocks;
use super::principal::principal;

/// A surface of triangles about its centre, in the units of its file. One that is closed encloses a homogeneous solid.
///
/// Its axes are those of its file; its origin is the solid's centre of mass, or that of the surface where there is no
/// solid. Seen from outside of a closed one, the corners of each triangle go around counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    name: String,
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    smooth: Option<f64>,
    blocks: Blocks,
    solid: Result<Solid, Flaw>,
}

/// The mechanics of what a closed surface encloses.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Solid {
    volume: f64,
    /// Principal moments of inertia per mass.
    inertia: DVec3,
    principal_axes: DQuat,
}

impl Mesh {
    /// The mesh of some triangles, which name their vertices by number, and a name for it.
    ///
    /// Triangles with two equal corners do not count. A closed surface that shows its inside is turned inside out.
    ///
    /// # Panics
    /// If a triangle names a vertex that is not there.
    #[must_use]
    pub fn new(name: &str, mut vertices: Vec<DVec3>, mut triangles: Vec<[u32; 3]>) -> Mesh {
        triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        let closed = closed::check(&vertices, &triangles);
        // Far from the origin, differences of large numbers would cost digits.
        let middle = reach::middle(&vertices);
        vertices.iter_mut().for_each(|vertex| *vertex -= middle);
        let solid = closed.and_then(|()| {
            let mut whole = integrals::over_solid(&vertices, &triangles);
            // A mesh thinner than rounding errors is flat.
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

    /// The same mesh, whose edges are meant to be round where its faces meet at no more than so many radians. Mechanics
    /// takes the triangles as they are; this is for whoever draws them.
    #[must_use]
    pub fn with_smooth(self, smooth: Option<f64>) -> Mesh {
        Mesh { smooth, ..self }
    }

    /// A surface without mechanics, as it is: about the origin of the vertices that are given.
    #[must_use]
    pub fn surface(name: &str, vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Mesh {
        let blocks = Blocks::new(&vertices);
        Mesh { name: name.to_owned(), vertices, triangles, smooth: None, blocks, solid: Err(Flaw::Flat) }
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its vertices, about its centre.
    #[must_use]
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// The triangles, each as the numbers of its vertices.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The largest angle between two faces, rad, whose common edge is meant to be round.
    #[must_use]
    pub fn smooth(&self) -> Option<f64> {
        self.smooth
    }

    /// Why it encloses no solid, if it does not.
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

    /// The farthest that it reaches along a direction in its own frame.
    pub(super) fn support(&self, direction: DVec3) -> f64 {
        self.blocks.support(&self.vertices, direction)
    }

    /// Half of the smallest edge of the box around it; `None` if it is flat.
    /// The distance of the farthest vertex from the centre of mass, m.
    pub(super) fn bounding_radius(&self) -> f64 {
        self.vertices().iter().map(|vertex| vertex.length()).fold(0.0, f64::max)
    }

    pub(super) fn half_thickness(&self) -> Option<f64> {
        Some(reach::extent(&self.vertices).min_element() / 2.0).filter(|half| *half > 0.0)
    }
}
