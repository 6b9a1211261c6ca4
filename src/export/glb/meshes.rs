//! Combines base shapes and materials into glTF meshes, which several bodies can share.

use std::collections::HashMap;

use glam::{DAffine3, DVec3};

use super::document::{Accessor, Mesh, Primitive};
use super::geometry::{Geometry, Known};
use super::materials::{self, MaterialKey, PaintedObject, Paints};
use crate::scene::Scene;
use crate::surface::{BaseShape, Detail, Piece, SurfacePattern};

/// The glTF meshes of a document, with their materials and triangles.
pub(super) struct Meshes {
    pub(super) meshes: Vec<Mesh>,
    /// The index of each mesh in `meshes`. The map is never iterated, so its random order does not matter.
    known: HashMap<(BaseShape, MaterialKey, Option<Cut>), u32>,
    pub(super) paints: Paints,
    pub(super) accessors: Vec<Accessor>,
    pub(super) geometry: Geometry,
}

/// The transform from a base shape to a pattern, as the bits of its twelve `f32` numbers.
type Cut = [u32; 12];

impl Meshes {
    pub(super) fn new(detail: Detail) -> Meshes {
        Meshes {
            meshes: Vec::new(),
            known: HashMap::new(),
            paints: Paints::default(),
            accessors: Vec::new(),
            geometry: Geometry::new(detail),
        }
    }

    /// Returns the index of the mesh for a piece of a body. `None` if the piece has no triangles. `size` is the size of the material's
    /// pattern, m. Without a size, or if the pattern would be invisible, the mesh has the mean of the pattern's colors.
    pub(super) fn number(
        &mut self,
        scene: &Scene,
        piece: &Piece,
        material: PaintedObject,
        size: Option<f64>,
    ) -> Option<u32> {
        let what = piece.color.map_or(material, PaintedObject::from);
        let paint = MaterialKey { what, both_sides: !piece.form.is_closed(), color: None };
        let (name, look) = materials::look(what, scene);
        let cut = size.filter(|_| look.pattern != SurfacePattern::None).map(|size| cut(piece, size));
        let key = (piece.form.clone(), paint, cut);
        if let Some(&number) = self.known.get(&key) {
            return Some(number);
        }
        let form = &piece.form;
        let parts = cut.and_then(|cut| {
            let place = DAffine3::from_cols_array(&cut.map(|bits| f64::from(f32::from_bits(bits))));
            self.geometry.split(form, look.pattern, place, &mut self.accessors)
        });
        let primitives = match parts {
            Some(parts) => {
                let parts = parts.into_iter().enumerate();
                let parts = parts
                    .filter_map(|(color, part)| Some((MaterialKey { color: Some(color), ..paint }, part?)));
                parts.map(|(paint, part)| self.primitive(scene, paint, part)).collect()
            }
            None => {
                let whole = self.geometry.form(form, &mut self.accessors)?;
                vec![self.primitive(scene, paint, whole)]
            }
        };
        self.meshes.push(Mesh { name: format!("{}, {name}", form.name()), primitives });
        let number = self.meshes.len() as u32 - 1;
        self.known.insert(key, number);
        Some(number)
    }

    fn primitive(&mut self, scene: &Scene, paint: MaterialKey, part: Known) -> Primitive {
        let material = self.paints.number(paint, scene);
        Primitive { attributes: part.attributes, indices: part.indices, material }
    }
}

/// Returns the transform from a piece's base shape to a pattern of this size, m. The pattern is fixed to the body. On a plane, it is fixed
/// to the plane itself.
#[allow(clippy::cast_possible_truncation, reason = "bodies of one kind shall be cut alike, but for rounding")]
fn cut(piece: &Piece, size: f64) -> Cut {
    let scale = piece.scale / size;
    let place = if piece.form == BaseShape::PLANE {
        let middle = piece.orientation.conjugate() * piece.location / size;
        DAffine3::from_translation(DVec3::new(middle.x, 0.0, middle.z)) * DAffine3::from_scale(scale)
    } else {
        DAffine3::from_scale_rotation_translation(scale, piece.orientation, piece.location / size)
    };
    place.to_cols_array().map(|number| (number as f32 + 0.0).to_bits())
}
