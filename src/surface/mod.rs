//! Shapes as triangles, and materials for renderers other than POV-Ray.
//!
//! A shape consists of [`pieces`], each a [`Form`] of standard size, so all balls of a scene share the same
//! [`Triangles`]. [`appearance`] is a material without POV-Ray's patterns and reflections.

mod angles;
mod appearance;
mod form;
mod helix;
mod lathe;
mod mesh;
mod motif;
pub(crate) mod normals;
mod piece;
mod straight;
#[cfg(test)]
mod tests;

use glam::DVec3;

pub use appearance::{Appearance, BEACH_BALL, Motif, appearance, ground};
pub use form::{Detail, Form};
pub use piece::{Piece, pieces};

/// A surface of triangles.
///
/// Seen from outside, the corners of each triangle go counter-clockwise. Vertices at the same position with different
/// normals are separate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// The positions of the vertices.
    pub positions: Vec<[f32; 3]>,
    /// The unit normals at the vertices; they point outward.
    pub normals: Vec<[f32; 3]>,
    /// The vertex indices at the corners of the triangles, three for each.
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

    /// Adds a triangle, unless two of its corners coincide.
    fn triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
        if a != b && b != c && c != a {
            self.indices.extend(corners);
        }
    }

    /// Adds a flat or curved piece with four corners.
    fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.triangle([a, b, c]);
        self.triangle([a, c, d]);
    }
}
