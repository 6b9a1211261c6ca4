//! Shapes as triangles, and materials as renderers know them that are not POV-Ray.
//!
//! A shape is drawn of [`pieces`], each a [`Form`] in a standard size, so that all balls of a scene share the
//! [`Triangles`] of one; [`appearance`] is what remains of a material without POV-Ray's patterns and reflections.

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
/// Seen from outside, the corners of each triangle go around counter-clockwise. Vertices at the same place with
/// different normals are vertices of their own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Where the vertices are.
    pub positions: Vec<[f32; 3]>,
    /// The unit normals at the vertices; they point outward.
    pub normals: Vec<[f32; 3]>,
    /// The numbers of the vertices at the corners of the triangles, three for each.
    pub indices: Vec<u32>,
}

impl Triangles {
    /// Adds a vertex, and gives its number.
    #[allow(clippy::cast_possible_truncation, reason = "no surface has more vertices than 32 bits can count")]
    fn vertex(&mut self, position: DVec3, normal: DVec3) -> u32 {
        self.positions.push(position.as_vec3().to_array());
        self.normals.push(normal.as_vec3().to_array());
        self.positions.len() as u32 - 1
    }

    /// Adds a triangle, unless two of its corners are at the same place.
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
