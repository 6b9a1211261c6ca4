//! The colors of bodies that have no material.

use super::{Color, Finish, Look, Material};

/// The colors, in the order in which bodies get them: neighbours differ most, also for the color-blind.
pub(super) const COLORS: [(&str, Color); 8] = [
    ("red", Color([0.80, 0.07, 0.10])),
    ("blue", Color([0.08, 0.31, 0.72])),
    ("amber", Color([0.97, 0.75, 0.13])),
    ("teal", Color([0.00, 0.47, 0.41])),
    ("sky", Color([0.42, 0.72, 0.93])),
    ("violet", Color([0.58, 0.34, 0.70])),
    ("orange", Color([0.92, 0.44, 0.08])),
    ("slate", Color([0.15, 0.18, 0.24])),
];

/// The material of the given number.
pub(super) fn material(number: usize) -> Material {
    let (name, color) = COLORS[number];
    Material { name: format!("palette {name}"), look: Look::Plain { color, finish: Finish::Glossy } }
}
