//! The material library: materials that every scene can use by name.
//!
//! The POV-Ray definitions are in `templates/library/`, one file per family of materials.

use super::{Color, Finish, Look};

/// A material of the library, such as `gold`.
#[derive(Debug, PartialEq)]
pub struct LibraryMaterial {
    /// The name of the material in scenes, such as `gold`.
    pub name: &'static str,
    /// A short description of the look, for lists of materials. It has no full stop.
    pub meaning: &'static str,
    /// The default color as `0xrrggbb`. `None` if the material has fixed colors that a scene cannot change.
    pub color: Option<u32>,
    /// The name of the template in `templates/library/` that defines the material, without the file extension.
    pub family: &'static str,
    /// How the material's pattern is positioned on a body.
    pub pattern: Pattern,
    /// The index of refraction. `None` for an opaque material.
    pub ior: Option<f64>,
    /// An approximation of the material for renderers other than POV-Ray: the preview, and programs that show exported models.
    pub plain: PlainLook,
}

/// A material's parameters for metallic-roughness shading, as in glTF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlainLook {
    /// The mean color as a multiple of the material's color: red, green and blue in linear RGB. It was measured on a ball that POV-Ray
    /// rendered in even light. For a material with fixed colors, `tone` is the mean color itself.
    pub tone: [f64; 3],
    /// The opacity, from 0 (transparent) to 1 (opaque).
    pub cover: f64,
    /// The metalness: 1 for a metal, 0 for other materials, and a value between for mixtures.
    pub metallic: f64,
    /// The roughness, from 0 (a mirror) to 1 (chalk).
    pub roughness: f64,
}

/// The default shading parameters of library materials. Most materials override some of these parameters.
const DEFAULT_PLAIN_LOOK: PlainLook = PlainLook { tone: [1.0; 3], cover: 1.0, metallic: 0.0, roughness: 0.5 };

impl LibraryMaterial {
    /// Sets the shading parameters, with a factor `shade` for the material's color that is the same for red, green and blue.
    const fn seen(self, shade: f64, metallic: f64, roughness: f64) -> LibraryMaterial {
        self.tinged([shade; 3], metallic, roughness)
    }

    /// Sets the shading parameters, with a factor for each of red, green and blue of the material's color.
    const fn tinged(self, tone: [f64; 3], metallic: f64, roughness: f64) -> LibraryMaterial {
        LibraryMaterial { plain: PlainLook { tone, metallic, roughness, ..DEFAULT_PLAIN_LOOK }, ..self }
    }

    /// Sets the opacity and the roughness of a transparent material.
    const fn covers(self, cover: f64, roughness: f64) -> LibraryMaterial {
        LibraryMaterial { plain: PlainLook { cover, roughness, ..DEFAULT_PLAIN_LOOK }, ..self }
    }
}

/// How the pattern of a material is positioned on a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// There is no pattern: the material looks the same from all sides.
    None,
    /// The pattern has a center and an axis. They are the center and the y axis of the body.
    Centred,
    /// The pattern fills a block, and each body is cut from a different position in the block.
    Cut,
}

const fn opaque(
    name: &'static str,
    family: &'static str,
    pattern: Pattern,
    color: u32,
    meaning: &'static str,
) -> LibraryMaterial {
    LibraryMaterial {
        name,
        meaning,
        color: Some(color),
        family,
        pattern,
        ior: None,
        plain: DEFAULT_PLAIN_LOOK,
    }
}

const fn clear(
    name: &'static str,
    pattern: Pattern,
    ior: f64,
    color: u32,
    meaning: &'static str,
) -> LibraryMaterial {
    LibraryMaterial {
        name,
        meaning,
        color: Some(color),
        family: "clear",
        pattern,
        ior: Some(ior),
        plain: DEFAULT_PLAIN_LOOK,
    }
}

const fn painted(name: &'static str, family: &'static str, meaning: &'static str) -> LibraryMaterial {
    LibraryMaterial {
        name,
        meaning,
        color: None,
        family,
        pattern: Pattern::Centred,
        ior: None,
        plain: DEFAULT_PLAIN_LOOK,
    }
}

/// The family of the materials that consist of a [`Finish`] alone.
const FINISH_FAMILY: &str = "finish";

/// All materials of the library, grouped by family.
pub const MATERIALS: &[LibraryMaterial] = &[
    opaque("matte", FINISH_FAMILY, Pattern::None, 0xff_ff_ff, "Like chalk: no highlight"),
    opaque("satin", FINISH_FAMILY, Pattern::None, 0xff_ff_ff, "Like eggshell: a soft highlight"),
    opaque(
        "glossy",
        FINISH_FAMILY,
        Pattern::None,
        0xff_ff_ff,
        "Like enamel: a sharp highlight and a faint reflection",
    ),
    opaque("metal", FINISH_FAMILY, Pattern::None, 0xff_ff_ff, "Polished metal of any color"),
    opaque("mirror", FINISH_FAMILY, Pattern::None, 0xff_ff_ff, "A mirror: all of what is around it"),
    opaque(
        "luminous",
        FINISH_FAMILY,
        Pattern::None,
        0xff_ff_ff,
        "Shines by itself, evenly; lets lamps inside shine out",
    ),
    opaque("brass", "metals", Pattern::None, 0xd8_ae_55, "Yellow, polished").seen(1.0, 1.0, 0.25),
    opaque("bronze", "metals", Pattern::None, 0x9c_66_36, "Brown, dully polished").seen(1.0, 1.0, 0.35),
    opaque("copper", "metals", Pattern::None, 0xda_82_5c, "Red, polished").seen(1.0, 1.0, 0.25),
    opaque("gold", "metals", Pattern::None, 0xff_c8_4a, "Deep yellow, bright").seen(1.0, 1.0, 0.2),
    opaque("silver", "metals", Pattern::None, 0xf1_ed_e4, "White and warm, bright").seen(1.0, 1.0, 0.2),
    opaque("chrome", "metals", Pattern::None, 0xe6_ec_f2, "White and cool, almost a mirror")
        .seen(1.0, 1.0, 0.05),
    opaque("steel", "metals", Pattern::Centred, 0xb4_ba_c0, "Gray, brushed around its axis")
        .seen(1.0, 1.0, 0.4),
    opaque("iron", "metals", Pattern::Cut, 0x4a_4a_4d, "Dark, cast: rough and hardly shining")
        .seen(0.96, 1.0, 0.65),
    clear("glass", Pattern::None, 1.5, 0xf6_ff_fb, "Clear window glass").covers(0.35, 0.02),
    clear("tinted_glass", Pattern::None, 1.5, 0x2f_9c_78, "Glass of a color: bottle green").covers(0.5, 0.02),
    clear("water", Pattern::Cut, 1.33, 0xb4_e4_ee, "Clear, with a hint of blue and a moving surface")
        .covers(0.45, 0.05),
    clear("ice", Pattern::Cut, 1.31, 0xd8_f0_fa, "Half clear, with clouds and an uneven surface")
        .covers(0.7, 0.3),
    clear("bubble", Pattern::None, 1.0, 0xff_ff_ff, "A film of soap: hollow, with the colors of the rainbow")
        .covers(0.15, 0.02),
    opaque("plastic", "smooth", Pattern::None, 0x1f_6f_d2, "Evenly colored, with a broad white highlight")
        .seen(1.0, 0.0, 0.35),
    opaque("rubber", "smooth", Pattern::None, 0x2c_2c_2f, "Almost black, with a dull sheen")
        .seen(1.0, 0.0, 0.8),
    opaque("porcelain", "smooth", Pattern::None, 0xf4_f1_e8, "Glazed: a clear reflection over a milky white")
        .seen(1.0, 0.0, 0.1),
    opaque("car_paint", "smooth", Pattern::None, 0xa8_0f_1e, "Metallic paint below a clear coat")
        .seen(0.8, 0.3, 0.2),
    opaque(
        "neon",
        "smooth",
        Pattern::None,
        0xff_2f_7a,
        "A lit tube: white where it is thick, colored at the rim",
    )
    .seen(1.0, 0.0, 1.0),
    opaque("velvet", "soft", Pattern::None, 0x86_10_3a, "Deep, and brighter at the rim").seen(0.66, 0.0, 1.0),
    opaque("felt", "soft", Pattern::Cut, 0x2c_82_4a, "Fibers, like the cloth of a billiard table")
        .seen(0.88, 0.0, 1.0),
    opaque("paper", "soft", Pattern::Cut, 0xf5_f1_e6, "Off-white, with a fine grain").seen(0.96, 0.0, 0.95),
    opaque("chalk", "soft", Pattern::Cut, 0xee_ec_e6, "White, dry and dusty").seen(0.97, 0.0, 1.0),
    opaque("cork", "soft", Pattern::Cut, 0xc8_97_62, "Light brown grains with dark gaps")
        .seen(1.0, 0.0, 0.95),
    opaque("clay", "earths", Pattern::Cut, 0xb0_8c_70, "Gray brown, shaped by hand").seen(0.97, 0.0, 0.95),
    opaque("terracotta", "earths", Pattern::Cut, 0xc0_66_3c, "Baked clay, orange, with paler clouds")
        .seen(1.0, 0.0, 0.95),
    opaque("concrete", "earths", Pattern::Cut, 0xa6_a4_9e, "Gray, with pores").seen(0.93, 0.0, 0.95),
    opaque("sandstone", "earths", Pattern::Cut, 0xd9_b3_80, "Layers of sand").seen(0.96, 0.0, 0.95),
    opaque("marble", "stones", Pattern::Cut, 0xf2_f0_ec, "White and polished, with gray veins")
        .seen(0.87, 0.0, 0.2),
    opaque("granite", "stones", Pattern::Cut, 0xb8_a4_9c, "Polished grains, from black to nearly white")
        .seen(0.85, 0.0, 0.15),
    opaque("jade", "stones", Pattern::Cut, 0x3f_8f_66, "Green and polished, with clouds")
        .seen(0.95, 0.0, 0.2),
    opaque("wood", "woods", Pattern::Cut, 0xc0_8a_52, "Oak: rings, and fibers along the longest axis, oiled")
        .seen(0.87, 0.0, 0.5),
    opaque("dark_wood", "woods", Pattern::Cut, 0x74_44_28, "Walnut, polished").seen(0.85, 0.0, 0.25),
    opaque(
        "checkered",
        "toys",
        Pattern::Centred,
        0xd0_2c_2c,
        "White and colored cubes: shows how a body turns",
    )
    .seen(1.0, 0.0, 0.3),
    opaque(
        "striped",
        "toys",
        Pattern::Centred,
        0x1f_6f_b8,
        "White and colored bands around the axis, shifted on one half",
    )
    .seen(1.0, 0.0, 0.3),
    painted("beach_ball", "toys", "Six colors between two white poles").seen(1.0, 0.0, 0.3),
    opaque("moon", "planets", Pattern::Cut, 0xb9_b5_ad, "Gray, with dark seas and craters")
        .seen(0.85, 0.0, 1.0),
    painted("earth", "planets", "Oceans, land, ice at the poles, clouds").tinged(
        [0.306_999_318_927_516_36, 0.342_391_639_592_603_44, 0.393_123_130_226_722_2],
        0.0,
        0.7,
    ),
    opaque(
        "gas_giant",
        "planets",
        Pattern::Centred,
        0xdc_b4_86,
        "Bands of cloud around the axis, as on Jupiter",
    )
    .seen(0.9, 0.0, 1.0),
    opaque("sun", "planets", Pattern::Cut, 0xff_b4_2e, "Shines by itself, grained, darker at the rim")
        .tinged([0.98, 0.83, 0.67], 0.0, 1.0),
];

impl LibraryMaterial {
    /// Returns the material with this name. `None` if the library has no such material.
    pub fn named(name: &str) -> Option<&'static LibraryMaterial> {
        MATERIALS.iter().find(|material| material.name == name)
    }

    /// Returns the look of the material. `color` replaces the default color, if the material has one.
    pub(super) fn look(&'static self, color: Option<Color>) -> Look {
        let own = self.color.map(Color::from_code);
        match self.finish() {
            Some(finish) => Look::Plain { color: color.or(own).unwrap_or(Color::WHITE), finish },
            None => Look::Library { material: self, color: own.map(|own| color.unwrap_or(own)) },
        }
    }

    /// Returns the finish of a material that consists of a finish alone. `None` for other materials.
    pub(super) fn finish(&self) -> Option<Finish> {
        Finish::named(self.name).filter(|_| self.family == FINISH_FAMILY)
    }

    /// Returns whether the material emits light.
    pub fn glows(&self) -> bool {
        matches!(self.name, "luminous" | "neon" | "sun")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_material_is_described_once() {
        for (i, material) in MATERIALS.iter().enumerate() {
            let name = material.name;
            assert_eq!(
                MATERIALS.iter().position(|other| other.name == name),
                Some(i),
                "{name} is there twice"
            );
            assert!(name.bytes().all(|b| b.is_ascii_lowercase() || b == b'_'), "{name}");
            assert!(!material.meaning.is_empty() && !material.meaning.ends_with('.'), "{name}");
        }
        assert!(MATERIALS.len() >= 24);
    }

    #[test]
    fn every_finish_is_a_material_that_is_nothing_else() {
        let finishes: Vec<_> = MATERIALS.iter().filter_map(LibraryMaterial::finish).collect();
        assert_eq!(finishes, Finish::ALL);
    }
}
