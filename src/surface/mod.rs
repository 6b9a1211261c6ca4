//! Converts shapes to triangles, and approximates materials, for renderers other than POV-Ray.
//!
//! A shape consists of [`pieces`]. Each piece is a [`BaseShape`] in a standard size, which is scaled when it is drawn. All balls of a scene
//! therefore share the same [`Triangles`]. [`appearance`] approximates a material without POV-Ray's patterns and reflections.
//!
//! A base shape of a standard size is one set of triangles, shared by all bodies that scale it (`base_shape.rs`). Patterns with plane
//! borders — checkered, striped, a beach ball — are cut into the triangles (`pattern.rs`), since a texture would need coordinates that fit
//! every shape; all other patterns become one mean color.

mod angles;
mod appearance;
mod base_shape;
mod helix;
mod lathe;
mod mesh;
pub(crate) mod normals;
mod pattern;
mod piece;
mod straight;
#[cfg(test)]
mod tests;

use glam::DVec3;

pub use appearance::{Appearance, BEACH_BALL, SurfacePattern, appearance, appearance_of, ground};
pub use base_shape::{BaseShape, Detail};
pub use piece::{Piece, pieces};

/// A surface that consists of triangles.
///
/// Seen from outside, the corners of each triangle are in counterclockwise order. Vertices at the same position with different normals are
/// separate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// The positions of the vertices.
    pub positions: Vec<[f32; 3]>,
    /// The outward unit normals at the vertices.
    pub normals: Vec<[f32; 3]>,
    /// The indices of the vertices at the corners of the triangles, three per triangle.
    pub indices: Vec<u32>,
}

impl Triangles {
    /// Adds a vertex and returns its index.
    #[allow(clippy::cast_possible_truncation, reason = "no surface has more vertices than 32 bits can count")]
    fn vertex(&mut self, position: DVec3, normal: DVec3) -> u32 {
        self.positions.push(position.as_vec3().to_array());
        self.normals.push(normal.as_vec3().to_array());
        self.positions.len() as u32 - 1
    }

    /// Adds a triangle. Skips triangles in which two corners coincide.
    fn triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
        if a != b && b != c && c != a {
            self.indices.extend(corners);
        }
    }

    /// Adds a quadrilateral as two triangles.
    fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.triangle([a, b, c]);
        self.triangle([a, c, d]);
    }
}
