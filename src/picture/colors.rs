//! Colors derived from other colors.

use crate::scene::Color;

/// The color of a body's ghost: the body's color, mixed with the color of a `dark` or light background.
pub fn pale(color: Color, dark: bool) -> Color {
    const GHOST_BLEND: f64 = 0.5;
    let towards = if dark { 0.12 } else { 0.93 };
    Color(color.0.map(|part| part + GHOST_BLEND * (towards - part)))
}

/// Adjusts a color so that it stands out from a `dark` or light background. Dark colors become lighter on a dark background.
pub(super) fn seen(color: Color, dark: bool) -> Color {
    const BRIGHT_ENOUGH: f64 = 0.12;
    let [red, green, blue] = color.linear();
    let bright = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
    let white = if dark { (1.0 - bright / BRIGHT_ENOUGH).max(0.0) * 0.6 } else { 0.0 };
    Color(color.0.map(|part| part + white * (1.0 - part)))
}

/// The default color of text on a `dark` or light background.
pub(super) fn ink(dark: bool) -> Color {
    if dark { Color([0.95, 0.96, 0.97]) } else { Color([0.05, 0.07, 0.10]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dark_colors_become_lighter_before_the_dark() {
        let (slate, amber) = (Color([0.15, 0.18, 0.24]), Color([0.97, 0.75, 0.13]));
        assert_eq!([seen(slate, false), seen(amber, true)], [slate, amber]);
        let [red, green, blue] = seen(slate, true).0;
        assert!(red > 0.5 && red < green && green < blue);
    }

    #[test]
    fn ghosts_are_nearer_to_what_is_behind_them() {
        let [red, green, _] = pale(Color([1.0, 0.0, 0.0]), false).0;
        assert!(red > 0.9 && green > 0.4);
        let [red, green, _] = pale(Color([1.0, 0.0, 0.0]), true).0;
        assert!(red < 0.6 && green < 0.1);
    }
}
