//! Colors that follow from others.

use crate::scene::{Color, Look, Scene};

/// The color of a ghost of a body of a color: nearer to what is behind it, which is `dark` or not.
pub fn pale(color: Color, dark: bool) -> Color {
    const PALER: f64 = 0.5;
    let towards = if dark { 0.12 } else { 0.93 };
    Color(color.0.map(|part| part + PALER * (towards - part)))
}

/// sRGB → linear light (IEC 61966-2-1).
pub(super) fn linear(color: Color) -> [f64; 3] {
    color.0.map(|c| if c <= 0.040_45 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) })
}

/// The single color of a look, if it has one that is known here.
pub(super) fn of_look(look: &Look) -> Option<Color> {
    match look {
        Look::Plain { color, .. } => Some(*color),
        Look::Library { color, .. } => *color,
        Look::Checkered | Look::Texture(_) | Look::Sdl(_) => None,
    }
}

/// The usual color of what is written.
pub(super) fn ink(scene: &Scene) -> Color {
    if scene.environment.is_dark() { Color([0.95, 0.96, 0.97]) } else { Color([0.05, 0.07, 0.10]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_light_is_darker_than_srgb_in_between() {
        let [black, middle, white] = linear(Color([0.0, 0.5, 1.0]));
        assert_eq!([black, white], [0.0, 1.0]);
        // IEC 61966-2-1: sRGB 0.5 is 21.4 % of the light.
        assert!((middle - 0.214_041).abs() < 1e-6, "{middle}");
    }

    #[test]
    fn ghosts_are_nearer_to_what_is_behind_them() {
        let [red, green, _] = pale(Color([1.0, 0.0, 0.0]), false).0;
        assert!(red > 0.9 && green > 0.4);
        let [red, green, _] = pale(Color([1.0, 0.0, 0.0]), true).0;
        assert!(red < 0.6 && green < 0.1);
    }
}
