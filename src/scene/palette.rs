//! Materials that the scene does not declare: default colors of bodies, and materials of the library.

use std::collections::HashMap;

use super::{Color, Finish, LibraryMaterial, Look, Material};
use crate::dynamics::Shape;

/// The default colors, in the order in which bodies get them. Neighbouring colors are easy to tell apart, also for
/// color-blind people.
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

/// Materials that the scene does not declare. Each is made when a body first needs it.
#[derive(Default)]
pub(super) struct Palette {
    /// The number of bodies that have used up a place in the sequence of colors, copies included.
    turns: usize,
    /// The index of the material of each color, if the material exists already.
    colors: [Option<usize>; COLORS.len()],
    checkered: Option<usize>,
    /// The indices of the library materials that bodies use, by name.
    by_name: HashMap<&'static str, usize>,
}

/// The default look of a body without a material.
#[derive(Clone, Copy)]
pub(super) enum Usual {
    /// A default color, by its index.
    Color(usize),
    /// The checkered look of the ground.
    Checkered,
}

impl Palette {
    /// The default look of the next body, in the order of the file. A new body at the end of the file changes no other
    /// body's color.
    pub(super) fn next(&mut self, shape: &Shape) -> Usual {
        if matches!(shape, Shape::Plane { .. }) {
            return Usual::Checkered;
        }
        self.turns += 1;
        Usual::Color((self.turns - 1) % COLORS.len())
    }

    /// The index of a library material. Makes the material when it is first needed.
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

    /// The index of the material for a default look. Makes the material when it is first needed.
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
