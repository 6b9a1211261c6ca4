//! Approximates materials for renderers other than POV-Ray.

use crate::scene::{Color, Finish, LibraryMaterial, Look, LookNumber, Material, PlainLook, Preset};

/// The appearance of a material in a renderer other than POV-Ray, described by metallic-roughness shading, as in glTF. Colors are linear,
/// with components from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Appearance {
    /// The color of the material: red, green, blue, and opacity (1 for opaque).
    pub color: [f64; 4],
    /// The metalness of the material: 1 for a metal, 0 for other materials.
    pub metallic: f64,
    /// The roughness of the surface: from 0 for a perfect mirror to 1 for chalk.
    pub roughness: f64,
    /// The part of its color that the material emits by itself, from 0 to 1. The rest is reflected.
    pub glow: f64,
    /// The pattern of the material.
    pub pattern: SurfacePattern,
    /// The second color of the pattern: red, green, blue. `None` without a pattern.
    pub second: Option<[f64; 3]>,
}

/// A pattern that makes rotation visible. Lengths are relative to the radius of a ball with the volume of the body; for the ground, they
/// are relative to the edge of a tile. The pattern has the center and axes of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SurfacePattern {
    /// No pattern: a single color.
    None,
    /// Cubes with an edge of 0.5 in alternating colors. The center of the body is a corner of eight cubes. The cube from 0 to 0.5 along
    /// all axes has the second color.
    Checkered,
    /// Bands of height 0.22 around y in alternating colors. The middle band, from -0.11 to 0.11, has the second
    /// color where x is negative. Where x is positive, the colors change places.
    Striped,
    /// Six sectors around y in the colors [`BEACH_BALL`]. The poles, |y| ≥ 0.911, have the second color. [`Appearance::color`] is the mean
    /// of the sectors.
    BeachBall,
    /// Square tiles with an edge of 1 in alternating colors, in the x-z plane. The tile from 0 to 1 along both axes has the second color.
    Ground,
}

/// The colors of a beach ball's sectors. The first sector extends from x by 60° towards -z; the next ones follow in the same direction.
pub const BEACH_BALL: [Color; 6] = [
    Color([0.83, 0.13, 0.15]),
    Color([0.96, 0.95, 0.92]),
    Color([0.98, 0.76, 0.14]),
    Color([0.1, 0.52, 0.36]),
    Color([0.93, 0.46, 0.1]),
    Color([0.1, 0.36, 0.75]),
];

/// The white of patterned materials.
const WHITE: Color = Color([0.96, 0.95, 0.92]);

/// The color of materials defined by POV-Ray's scene description language, whose real color is unknown.
const UNKNOWN_COLOR: Color = Color([0.6, 0.6, 0.6]);

/// The opacity of materials whose POV-Ray code makes them transparent. The code is not evaluated, so the real opacity is unknown.
const UNKNOWN_OPACITY: f64 = 0.35;

/// POV-Ray's keywords for transparency. Source: its documentation, 3.4.1.7 (colors).
const SHINES_THROUGH: [&str; 8] = ["rgbf", "rgbt", "rgbft", "srgbf", "srgbt", "srgbft", "filter", "transmit"];

impl Appearance {
    fn new(color: [f64; 3], metallic: f64, roughness: f64) -> Appearance {
        let [red, green, blue] = color.map(|part| part.min(1.0));
        let color = [red, green, blue, 1.0];
        Appearance { color, metallic, roughness, glow: 0.0, pattern: SurfacePattern::None, second: None }
    }

    fn patterned(self, pattern: SurfacePattern, second: Color) -> Appearance {
        Appearance { pattern, second: Some(second.linear()), ..self }
    }

    /// Returns the same appearance with a transparency and a glow, both from 0 to 1.
    #[must_use]
    pub fn with(self, transparency: f64, glow: f64) -> Appearance {
        let [red, green, blue, cover] = self.color;
        let glow = self.glow.max(glow);
        Appearance { color: [red, green, blue, cover * (1.0 - transparency)], glow, ..self }
    }

    /// The colors of the pattern, in the order of [`SurfacePattern::split`]. Without a pattern, only the color of the material.
    #[must_use]
    pub fn colors(&self) -> Vec<[f64; 3]> {
        let [red, green, blue, _] = self.color;
        let first = match self.pattern {
            SurfacePattern::BeachBall => BEACH_BALL.map(Color::linear).to_vec(),
            SurfacePattern::None
            | SurfacePattern::Checkered
            | SurfacePattern::Striped
            | SurfacePattern::Ground => vec![[red, green, blue]],
        };
        first.into_iter().chain(self.second).collect()
    }

    /// The mean color of a two-colored pattern, with the opacity. For other materials, their color.
    #[must_use]
    pub fn mean(&self) -> [f64; 4] {
        match (self.pattern, self.second) {
            (SurfacePattern::Checkered | SurfacePattern::Striped | SurfacePattern::Ground, Some(second)) => {
                let mean = |i: usize| f64::midpoint(self.color[i], second[i]);
                [mean(0), mean(1), mean(2), self.color[3]]
            }
            (SurfacePattern::None | SurfacePattern::BeachBall, _) | (_, None) => self.color,
        }
    }
}

/// Approximates a look in an environment, which colors the checkered ground. Looks that only POV-Ray can evaluate become gray.
#[must_use]
pub fn appearance(look: &Look, preset: Preset) -> Appearance {
    match look {
        Look::Plain { color, finish } => plain(*color, *finish),
        Look::Library { material, color } => library(material, color.unwrap_or(Color::WHITE)),
        Look::Checkered => ground(preset),
        Look::Texture(_) => Appearance::new(UNKNOWN_COLOR.linear(), 0.0, 0.6),
        Look::Sdl(text) => {
            let look = Appearance::new(UNKNOWN_COLOR.linear(), 0.0, 0.6);
            let [red, green, blue, all] = look.color;
            Appearance {
                color: [red, green, blue, if is_clear(text) { UNKNOWN_OPACITY } else { all }],
                ..look
            }
        }
    }
}

/// Approximates a material in an environment. A transparency or a glow that follows a value is left out, since each body has its own in each
/// frame.
#[must_use]
pub fn appearance_of(material: &Material, preset: Preset) -> Appearance {
    let fixed = |number: LookNumber| number.fixed().unwrap_or(0.0);
    appearance(&material.look, preset).with(fixed(material.transparency), fixed(material.glow))
}

/// True if a text in POV-Ray's language contains a keyword for transparency.
fn is_clear(text: &str) -> bool {
    let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    text.split(|letter| !is_word(letter)).any(|word| SHINES_THROUGH.contains(&word))
}

fn plain(color: Color, finish: Finish) -> Appearance {
    let color = color.linear();
    match finish {
        Finish::Matte => Appearance::new(color, 0.0, 1.0),
        Finish::Satin => Appearance::new(color, 0.0, 0.5),
        Finish::Glossy => Appearance::new(color, 0.0, 0.2),
        Finish::Metal => Appearance::new(color, 1.0, 0.25),
        // A mirror has a nearly colorless reflection, with a slight tint of its color.
        Finish::Mirror => Appearance::new(color.map(|part| 0.85 + 0.06 * part), 1.0, 0.03),
        Finish::Luminous => Appearance { glow: 1.0, ..Appearance::new(color, 0.0, 1.0) },
    }
}

/// Approximates a material of the library, with the given color if the material can be colored.
fn library(material: &LibraryMaterial, tint: Color) -> Appearance {
    let PlainLook { tone, cover, metallic, roughness } = material.plain;
    let tint = tint.linear();
    let look = Appearance::new(std::array::from_fn(|i| tone[i] * tint[i]), metallic, roughness);
    let look = match material.name {
        "checkered" => look.patterned(SurfacePattern::Checkered, WHITE),
        "striped" => look.patterned(SurfacePattern::Striped, WHITE),
        "beach_ball" => Appearance::new(mean(&BEACH_BALL), metallic, roughness)
            .patterned(SurfacePattern::BeachBall, WHITE),
        _ => look,
    };
    let [red, green, blue, _] = look.color;
    Appearance { color: [red, green, blue, cover], glow: if material.glows() { 1.0 } else { 0.0 }, ..look }
}

/// The mean of six colors in linear light.
fn mean(colors: &[Color; 6]) -> [f64; 3] {
    let sum = colors.iter().fold([0.0; 3], |sum, color| {
        let [red, green, blue] = color.linear();
        [sum[0] + red, sum[1] + green, sum[2] + blue]
    });
    sum.map(|part| part / 6.0)
}

/// The checkered ground of an environment. Planes without a material have the same appearance.
#[must_use]
pub fn ground(preset: Preset) -> Appearance {
    let [light, dark] = tiles(preset);
    Appearance::new(dark.linear(), 0.0, 0.9).patterned(SurfacePattern::Ground, light)
}

/// The colors of the light and the dark tiles of the ground. They equal those in `templates/common.inc`.
fn tiles(preset: Preset) -> [Color; 2] {
    let [light, dark] = match preset {
        Preset::Daylight => [[0.835, 0.82, 0.8], [0.785, 0.772, 0.755]],
        Preset::Studio => [[0.88; 3], [0.86; 3]],
        Preset::Night => [[0.5, 0.52, 0.56], [0.38, 0.4, 0.44]],
        Preset::Blackboard => [[0.22, 0.26, 0.27], [0.16, 0.195, 0.205]],
        Preset::Paper => [[0.98; 3], [0.86, 0.89, 0.93]],
        Preset::Space => [[0.5; 3], [0.4; 3]],
    };
    [Color(light), Color(dark)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::MATERIALS;

    fn look(material: &'static LibraryMaterial) -> Look {
        Look::Library { material, color: material.color.map(Color::from_code) }
    }

    #[test]
    fn words_of_povray_that_let_light_through_are_seen() {
        let cover = |text: &str| appearance(&Look::Sdl(text.into()), Preset::Daylight).color[3];
        assert!(cover("texture { pigment { color rgbt <0.8, 0.9, 1, 0.88> } }") < 0.5);
        assert!(cover("pigment { color White transmit 0.5 }") < 0.5);
        assert_eq!(cover("pigment { color rgb <0.8, 0.9, 1> } // filters"), 1.0);
    }

    /// A library material without an approximation of its own would get the default appearance: opaque, not metallic, with a roughness of
    /// 0.5.
    #[test]
    fn every_material_of_the_library_is_known() {
        for material in MATERIALS.iter().filter(|material| Finish::named(material.name).is_none()) {
            let found = appearance(&look(material), Preset::Daylight);
            let part = |part: f64| (0.0..=1.0).contains(&part);
            assert!(found.color.into_iter().chain([found.metallic, found.roughness]).all(part), "{found:?}");
            assert_eq!(found.glow == 1.0, material.glows(), "{}", material.name);
            assert_eq!(found.color[3] < 1.0, material.ior.is_some(), "{}", material.name);
            assert_eq!(found.metallic == 1.0, material.family == "metals", "{}", material.name);
            let usual = Appearance::new(found.color[..3].try_into().unwrap(), 0.0, 0.5);
            assert!(found != usual || material.name == "wood", "{} is not in the table", material.name);
        }
    }

    #[test]
    fn what_has_a_finish_has_its_color() {
        let red = Color([1.0, 0.0, 0.0]);
        for finish in Finish::ALL {
            let found = appearance(&Look::Plain { color: red, finish }, Preset::Daylight);
            assert!(found.color[0] > found.color[1] && found.color[3] == 1.0, "{finish:?}");
            assert_eq!(found.glow == 1.0, finish == Finish::Luminous);
        }
    }

    #[test]
    fn patterns_have_the_colors_of_the_scripts() {
        let toys = include_str!("../../templates/library/toys.inc");
        for Color([red, green, blue]) in BEACH_BALL.into_iter().chain([WHITE]) {
            assert!(toys.contains(&format!("color srgb <{red}, {green}, {blue}>")), "{red}");
        }
        let common = include_str!("../../templates/common.inc");
        for preset in Preset::ALL {
            let [Color(light), Color(dark)] = tiles(preset);
            let text = format!("\"{}\": {{\"light\": {light:?}, \"dark\": {dark:?},", preset.name());
            assert!(common.contains(&text), "{text}");
        }
    }

    #[test]
    fn a_checkered_plane_looks_like_the_ground_of_its_environment() {
        for preset in Preset::ALL {
            assert_eq!(appearance(&Look::Checkered, preset), ground(preset), "{}", preset.name());
        }
    }

    #[test]
    fn the_mean_of_a_pattern_lies_between_its_colors() {
        for material in ["checkered", "striped"] {
            let found = appearance(&look(LibraryMaterial::named(material).unwrap()), Preset::Daylight);
            let second = found.second.unwrap();
            let mean = found.mean();
            assert!((0..3).all(|i| (found.color[i] - mean[i]) * (mean[i] - second[i]) > 0.0), "{mean:?}");
        }
    }
}
