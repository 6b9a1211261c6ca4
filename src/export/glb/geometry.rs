//! The forms of a scene; each is stored once.

use std::collections::HashMap;

use glam::DAffine3;

use super::document::{Accessor, Attributes, BufferView, FLOAT, UNSIGNED_INT};
use crate::surface::{Detail, Form, Motif, Triangles};

/// The indices of the glTF buffer views, in the order in which the document lists them.
const VERTICES: u32 = 0;
const INDICES: u32 = 1;
const KEYS: u32 = 2;

/// The numbers of the accessors of a form.
#[derive(Clone, Copy)]
pub(super) struct Known {
    pub(super) attributes: Attributes,
    pub(super) indices: u32,
}

/// The triangles of all forms so far.
pub(super) struct Geometry {
    detail: Detail,
    /// Positions and normals.
    pub(super) vertices: Vec<[f32; 3]>,
    pub(super) indices: Vec<u32>,
    /// The map is only used for look-ups, never iterated. A form without triangles is `None`.
    known: HashMap<Form, Option<Known>>,
}

impl Geometry {
    pub(super) fn new(detail: Detail) -> Geometry {
        Geometry { detail, vertices: Vec::new(), indices: Vec::new(), known: HashMap::new() }
    }

    /// The accessors of a form, which is added if it is new.
    pub(super) fn form(&mut self, form: &Form, accessors: &mut Vec<Accessor>) -> Option<Known> {
        if let Some(known) = self.known.get(form) {
            return *known;
        }
        let known = self.add(form.triangles(self.detail), accessors);
        self.known.insert(form.clone(), known);
        known
    }

    /// A form cut along the borders of a pattern. Gives for each color the accessors of the parts with that color.
    pub(super) fn split(
        &mut self,
        form: &Form,
        motif: Motif,
        to_pattern: DAffine3,
        accessors: &mut Vec<Accessor>,
    ) -> Option<Vec<Option<Known>>> {
        let parts = motif.split(&form.triangles(self.detail), to_pattern)?;
        Some(parts.into_iter().map(|part| self.add(part, accessors)).collect())
    }

    /// Adds triangles, unless there are none.
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

    /// The number of the view with the keys. Empty views are left out.
    pub(super) fn keys(&self) -> u32 {
        if self.vertices.is_empty() { 0 } else { KEYS }
    }

    /// The views of the buffer; the last one has this many bytes of keys.
    pub(super) fn views(&self, keys: u64) -> Vec<BufferView> {
        let (vertices, indices) = (12 * self.vertices.len() as u64, 4 * self.indices.len() as u64);
        let view = |byte_offset, byte_length, byte_stride, target| BufferView {
            buffer: 0,
            byte_offset,
            byte_length,
            byte_stride,
            target,
        };
        // Targets: ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER.
        let all = [
            view(0, vertices, Some(12), Some(34_962)),
            view(vertices, indices, None, Some(34_963)),
            view(vertices + indices, keys, None, None),
        ];
        all.into_iter().filter(|view| view.byte_length > 0).collect()
    }
}

/// The minimum and the maximum of each coordinate.
fn bounds(positions: &[[f32; 3]]) -> (Vec<f64>, Vec<f64>) {
    let of = |pick: fn(f32, f32) -> f32| {
        let axis = |i: usize| positions.iter().map(|position| position[i]).reduce(pick).map(f64::from);
        (0..3).filter_map(axis).collect()
    };
    (of(f32::min), of(f32::max))
}
