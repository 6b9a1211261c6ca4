//! The materials that a scene does not declare: the colors of bodies without one, and those of the library.

use std::collections::HashMap;

use super::{Color, Finish, LibraryMaterial, Look, Material};
use crate::dynamics::Shape;

/// The colors, in the order in which bodies get them: neighbours differ most, also for the color-blind.
const COLORS: [(&str, Color); 8] = [
    ("red", Color([0.80, 0.07, 0.10])),
    ("blue", Color([0.08, 0.31, 0.72])),
    ("amber", Color([0.97, 0.75, 0.13])),
    ("teal", Color([0.00, 0.47, 0.41])),
    ("sky", Color([0.42, 0.72, 0.93])),
    ("violet", Color([0.58, 0.34, 0.70])),
    ("orange", Color([0.92, 0.44, 0.08])),
    ("slate", Color([0.15, 0.18, 0.24])),
];

/// The materials that a scene does not declare, each made when it is first needed.
#[derive(Default)]
pub(super) struct Palette {
    /// How many bodies have had their turn, copies included.
    turns: usize,
    /// The numbers of the materials that have been made.
    colors: [Option<usize>; COLORS.len()],
    checkered: Option<usize>,
    /// The materials of the library that bodies name, by their names.
    by_name: HashMap<&'static str, usize>,
}

/// The look of a body without a material.
#[derive(Clone, Copy)]
pub(super) enum Usual {
    /// One of the colors.
    Color(usize),
    /// Like the ground.
    Checkered,
}

impl Palette {
    /// The usual look of the next body, in the order of the file. A body added at the end changes no other's.
    pub(super) fn next(&mut self, shape: &Shape) -> Usual {
        if matches!(shape, Shape::Plane { .. }) {
            return Usual::Checkered;
        }
        self.turns += 1;
        Usual::Color((self.turns - 1) % COLORS.len())
    }

    /// The number of a material of the library.
    pub(super) fn of_library(
        &mut self,
        material: &'static LibraryMaterial,
        materials: &mut Vec<Material>,
    ) -> usize {
        *self.by_name.entry(material.name).or_insert_with(|| {
            materials.push(Material { name: material.name.to_owned(), look: material.look(None) });
            materials.len() - 1
        })
    }

    /// The number of the material for a usual look.
    pub(super) fn material(&mut self, usual: Usual, materials: &mut Vec<Material>) -> usize {
        let made = match usual {
            Usual::Color(number) => &mut self.colors[number],
            Usual::Checkered => &mut self.checkered,
        };
        *made.get_or_insert_with(|| {
            materials.push(material(usual));
            materials.len() - 1
        })
    }
}

fn material(usual: Usual) -> Material {
    match usual {
        Usual::Checkered => Material { name: "checkered".to_owned(), look: Look::Checkered },
        Usual::Color(number) => {
            let (name, color) = COLORS[number];
            Material { name: format!("palette {name}"), look: Look::Plain { color, finish: Finish::Glossy } }
        }
    }
}
