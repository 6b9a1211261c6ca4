//! Materials that the scene does not declare: default colors of bodies, and materials of the library.

use std::collections::HashMap;

use super::{Color, Finish, LibraryMaterial, Look, Material};
use crate::physics::Shape;

/// The default colors, in the order in which bodies get them. Neighboring colors are easy to distinguish, also for color-blind people.
const DEFAULT_COLORS: [(&str, Color); 8] = [
    ("red", Color([0.80, 0.07, 0.10])),
    ("blue", Color([0.08, 0.31, 0.72])),
    ("amber", Color([0.97, 0.75, 0.13])),
    ("teal", Color([0.00, 0.47, 0.41])),
    ("sky", Color([0.42, 0.72, 0.93])),
    ("violet", Color([0.58, 0.34, 0.70])),
    ("orange", Color([0.92, 0.44, 0.08])),
    ("slate", Color([0.15, 0.18, 0.24])),
];

/// The materials that the scene does not declare. Each material is made when a body first needs it.
#[derive(Default)]
pub(super) struct DefaultLooks {
    /// The number of bodies that have advanced the sequence of default colors. Copies count as well.
    turns: usize,
    /// The index of the material for each default color. `None` if no body has needed the color yet.
    colors: [Option<usize>; DEFAULT_COLORS.len()],
    checkered: Option<usize>,
    /// The index of the material for each library material in use, by name.
    by_name: HashMap<&'static str, usize>,
}

/// The default look of a body without a material.
#[derive(Clone, Copy)]
pub(super) enum DefaultLook {
    /// A default color, by its index in the palette.
    Color(usize),
    /// The checkered pattern of the ground, for planes.
    Checkered,
}

impl DefaultLooks {
    /// Returns the default look of the next body in the order of the file. If a user adds a body at the end of the file, the colors of the
    /// other bodies stay the same.
    pub(super) fn next(&mut self, shape: &Shape) -> DefaultLook {
        if matches!(shape, Shape::Plane { .. }) {
            return DefaultLook::Checkered;
        }
        self.turns += 1;
        DefaultLook::Color((self.turns - 1) % DEFAULT_COLORS.len())
    }

    /// Returns the index of a library material in `materials`. Adds the material when it is first needed.
    pub(super) fn of_library(
        &mut self,
        material: &'static LibraryMaterial,
        materials: &mut Vec<Material>,
    ) -> usize {
        *self.by_name.entry(material.name).or_insert_with(|| {
            materials.push(Material::new(material.name, material.look(None)));
            materials.len() - 1
        })
    }

    /// Returns the index in `materials` of the material for a default look. Adds the material when it is first needed.
    pub(super) fn material(&mut self, usual: DefaultLook, materials: &mut Vec<Material>) -> usize {
        let made = match usual {
            DefaultLook::Color(number) => &mut self.colors[number],
            DefaultLook::Checkered => &mut self.checkered,
        };
        *made.get_or_insert_with(|| {
            materials.push(material(usual));
            materials.len() - 1
        })
    }
}

fn material(usual: DefaultLook) -> Material {
    match usual {
        DefaultLook::Checkered => Material::new("checkered", Look::Checkered),
        DefaultLook::Color(number) => {
            let (name, color) = DEFAULT_COLORS[number];
            let look = Look::Plain { color, finish: Finish::Glossy };
            Material::new(&format!("palette {name}"), look)
        }
    }
}
