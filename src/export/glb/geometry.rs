//! Stores the triangles of a scene. Each base shape (a shape in a standard size, called form) is stored once, and bodies scale it.

use std::collections::HashMap;

use glam::DAffine3;

use super::document::{Accessor, Attributes, BufferView, FLOAT, UNSIGNED_INT};
use crate::surface::{BaseShape, Detail, SurfacePattern, Triangles};

/// The indices of the glTF buffer views, in the order in which the document lists them.
const VERTICES: u32 = 0;
const INDICES: u32 = 1;
const KEYS: u32 = 2;

/// The accessors of a base shape's positions, normals and triangle indices, by their index in the document.
#[derive(Clone, Copy)]
pub(super) struct Known {
    pub(super) attributes: Attributes,
    pub(super) indices: u32,
}

/// The triangles of all base shapes that have been added so far.
pub(super) struct Geometry {
    detail: Detail,
    /// For each base shape, first the positions of its vertices, then their normals.
    pub(super) vertices: Vec<[f32; 3]>,
    pub(super) indices: Vec<u32>,
    /// The accessors of each base shape, `None` for a shape without triangles. The map is never iterated, so its random order does not
    /// matter.
    known: HashMap<BaseShape, Option<Known>>,
}

impl Geometry {
    pub(super) fn new(detail: Detail) -> Geometry {
        Geometry { detail, vertices: Vec::new(), indices: Vec::new(), known: HashMap::new() }
    }

    /// Returns the accessors of a base shape. Adds the shape if it is new.
    pub(super) fn form(&mut self, form: &BaseShape, accessors: &mut Vec<Accessor>) -> Option<Known> {
        if let Some(known) = self.known.get(form) {
            return *known;
        }
        let known = self.add(form.triangles(self.detail), accessors);
        self.known.insert(form.clone(), known);
        known
    }

    /// Cuts a base shape along the borders of a pattern. Returns, for each color of the pattern, the accessors of the triangles with that
    /// color. `to_pattern` is the transform from the shape to the pattern.
    pub(super) fn split(
        &mut self,
        form: &BaseShape,
        pattern: SurfacePattern,
        to_pattern: DAffine3,
        accessors: &mut Vec<Accessor>,
    ) -> Option<Vec<Option<Known>>> {
        let parts = pattern.split(&form.triangles(self.detail), to_pattern)?;
        Some(parts.into_iter().map(|part| self.add(part, accessors)).collect())
    }

    /// Adds triangles, and returns their accessors. `None` if there are no triangles.
    fn add(&mut self, triangles: Triangles, accessors: &mut Vec<Accessor>) -> Option<Known> {
        if triangles.indices.is_empty() {
            return None;
        }
        let Triangles { positions, normals, indices } = triangles;
        let first = accessors.len() as u32;
        let (min, max) = bounds(&positions);
        let vectors = |byte_offset: usize, count: usize| Accessor {
            buffer_view: VERTICES,
            byte_offset: byte_offset as u64,
            component_type: FLOAT,
            count,
            kind: "VEC3",
            min: Vec::new(),
            max: Vec::new(),
        };
        let begin = 12 * self.vertices.len();
        accessors.push(Accessor { min, max, ..vectors(begin, positions.len()) });
        accessors.push(vectors(begin + 12 * positions.len(), normals.len()));
        accessors.push(Accessor {
            buffer_view: INDICES,
            byte_offset: 4 * self.indices.len() as u64,
            component_type: UNSIGNED_INT,
            kind: "SCALAR",
            ..vectors(0, indices.len())
        });
        self.vertices.extend(positions.into_iter().chain(normals));
        self.indices.extend(indices);
        Some(Known { attributes: Attributes { position: first, normal: first + 1 }, indices: first + 2 })
    }

    /// Returns the index of the buffer view with the keyframes. Empty views are left out, so the index is 0 if there are no triangles.
    pub(super) fn keys(&self) -> u32 {
        if self.vertices.is_empty() { 0 } else { KEYS }
    }

    /// Returns the views of the buffer: vertices, indices and keyframes. `keys` is the size of the keyframes in bytes.
    pub(super) fn views(&self, keys: u64) -> Vec<BufferView> {
        let (vertices, indices) = (12 * self.vertices.len() as u64, 4 * self.indices.len() as u64);
        let view = |byte_offset, byte_length, byte_stride, target| BufferView {
            buffer: 0,
            byte_offset,
            byte_length,
            byte_stride,
            target,
        };
        // The numbers 34962 and 34963 are glTF's codes for the targets ARRAY_BUFFER and ELEMENT_ARRAY_BUFFER.
        let all = [
            view(0, vertices, Some(12), Some(34_962)),
            view(vertices, indices, None, Some(34_963)),
            view(vertices + indices, keys, None, None),
        ];
        all.into_iter().filter(|view| view.byte_length > 0).collect()
    }
}

/// Returns the smallest and the largest value of each coordinate.
fn bounds(positions: &[[f32; 3]]) -> (Vec<f64>, Vec<f64>) {
    let of = |pick: fn(f32, f32) -> f32| {
        let axis = |i: usize| positions.iter().map(|position| position[i]).reduce(pick).map(f64::from);
        (0..3).filter_map(axis).collect()
    };
    (of(f32::min), of(f32::max))
}
