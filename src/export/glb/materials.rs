//! Converts the looks of bodies to glTF materials.

use std::collections::HashMap;

use super::document::{Material, Shading};
use crate::scene::{self, Color, Finish, Look, LookNumber, Scene};
use crate::surface::{Appearance, SurfacePattern, appearance, appearance_of, ground};

/// The key of a glTF material: what it colors, and how.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct MaterialKey {
    pub(super) what: PaintedObject,
    /// True if the back of the surface is visible as well.
    pub(super) both_sides: bool,
    /// The index of a color of the pattern. `None` for the mean of the pattern's colors.
    pub(super) color: Option<usize>,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum PaintedObject {
    /// The material with this index in the scene.
    Material(usize),
    /// The material with this index in the scene, with what follows a value.
    Mapped(usize, MappedLook),
    /// An sRGB color, as the bits of its three components.
    Color([u64; 3]),
    /// The sRGB color of a spring or joint, as the bits of its three components.
    Link([u64; 3]),
    /// The ground of the scene's surroundings.
    Ground,
    /// The unknown look of a body without a material, which only POV-Ray code defines.
    Unknown,
}

/// The part of a look that follows a value. Numbers are kept as their bits, so that equal looks share a material.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct MappedLook {
    /// The sRGB color.
    color: Option<[u64; 3]>,
    transparency: Option<u64>,
    glow: Option<u64>,
}

impl MappedLook {
    pub(super) fn new(color: Option<Color>, transparency: Option<f64>, glow: Option<f64>) -> MappedLook {
        MappedLook {
            color: color.map(|color| color.0.map(f64::to_bits)),
            transparency: transparency.map(f64::to_bits),
            glow: glow.map(f64::to_bits),
        }
    }

    /// Returns a material in this look.
    fn of(self, material: &scene::Material) -> scene::Material {
        let number =
            |bits: Option<u64>, usual| bits.map_or(usual, |it| LookNumber::Fixed(f64::from_bits(it)));
        let color = self.color.map(|color| Color(color.map(f64::from_bits)));
        scene::Material {
            look: color.map_or_else(|| material.look.clone(), |color| material.look.with_color(color)),
            transparency: number(self.transparency, material.transparency),
            glow: number(self.glow, material.glow),
            ..material.clone()
        }
    }
}

impl From<Color> for PaintedObject {
    fn from(color: Color) -> PaintedObject {
        PaintedObject::Color(color.0.map(f64::to_bits))
    }
}

/// The glTF materials of a document.
#[derive(Default)]
pub(super) struct Paints {
    pub(super) materials: Vec<Material>,
    /// The index of each material in `materials`. The map is never iterated, so its random order does not matter.
    known: HashMap<MaterialKey, u32>,
}

impl Paints {
    /// Returns the index of a material. Adds the material if it is new.
    pub(super) fn number(&mut self, paint: MaterialKey, scene: &Scene) -> u32 {
        *self.known.entry(paint).or_insert_with(|| {
            self.materials.push(material(paint, scene));
            self.materials.len() as u32 - 1
        })
    }
}

fn material(paint: MaterialKey, scene: &Scene) -> Material {
    let (mut name, mut look) = look(paint.what, scene);
    if let Some((number, [red, green, blue])) = paint.color.and_then(|i| Some((i, *look.colors().get(i)?))) {
        name = format!("{name}, color {}", number + 1);
        look = Appearance { color: [red, green, blue, look.color[3]], pattern: SurfacePattern::None, ..look };
    }
    shaded(name, &look, paint.both_sides)
}

/// Returns the name of the painted object's material, and the appearance of this material for renderers other than POV-Ray.
pub(super) fn look(what: PaintedObject, scene: &Scene) -> (String, Appearance) {
    let preset = scene.environment.preset;
    let satin =
        |bits: [u64; 3]| Look::Plain { color: Color(bits.map(f64::from_bits)), finish: Finish::Satin };
    match what {
        PaintedObject::Material(number) => {
            let material = &scene.materials[number];
            (material.name.clone(), appearance_of(material, preset))
        }
        PaintedObject::Mapped(number, look) => {
            let material = &scene.materials[number];
            (material.name.clone(), appearance_of(&look.of(material), preset))
        }
        PaintedObject::Color(bits) => ("axes".to_owned(), appearance(&satin(bits), preset)),
        PaintedObject::Link(bits) => ("link".to_owned(), appearance(&satin(bits), preset)),
        PaintedObject::Ground => ("ground".to_owned(), ground(preset)),
        PaintedObject::Unknown => ("unknown".to_owned(), appearance(&Look::Sdl("".into()), preset)),
    }
}

fn shaded(name: String, appearance: &Appearance, double_sided: bool) -> Material {
    let [red, green, blue, cover] = appearance.mean();
    // What glows does not reflect light as well: otherwise, it would be brighter than its color.
    let glow = appearance.glow;
    let reflected = 1.0 - glow;
    let base = [red * reflected, green * reflected, blue * reflected, cover];
    Material {
        name,
        pbr_metallic_roughness: Shading {
            base_color_factor: base,
            metallic_factor: appearance.metallic,
            roughness_factor: appearance.roughness,
        },
        emissive_factor: (glow > 0.0).then(|| [red, green, blue].map(|part| part * glow)),
        alpha_mode: (cover < 1.0).then_some("BLEND"),
        double_sided,
    }
}
