//! Colors in sRGB, and the parser for colors in scenes.

use serde::Serialize;

pub(super) use super::color_names::NAMES;

/// A color in sRGB, as on screens and in color pickers: red, green and blue from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Color(pub [f64; 3]);

/// Returns the name of each named CSS color, with its value as `#rrggbb`.
pub(crate) fn names() -> Vec<(&'static str, String)> {
    NAMES.iter().map(|&(name, code)| (name, format!("#{code:06x}"))).collect()
}

impl Color {
    /// The color white.
    pub const WHITE: Color = Color([1.0; 3]);

    /// The colors of curves in charts and plots, in the order in which curves get them. People with any color vision can distinguish them.
    /// Source: M. Okabe & K. Ito, *Color Universal Design* (2008), with a gray and a brown for black and yellow, which cannot be seen on dark
    /// and on light backgrounds.
    pub const OF_CURVES: [Color; 8] = [
        Color([0.0, 0.447, 0.698]),
        Color([0.835, 0.369, 0.0]),
        Color([0.0, 0.62, 0.451]),
        Color([0.8, 0.475, 0.655]),
        Color([0.337, 0.706, 0.914]),
        Color([0.902, 0.624, 0.0]),
        Color([0.35, 0.35, 0.38]),
        Color([0.55, 0.34, 0.16]),
    ];

    /// The color of water.
    pub const OF_WATER: Color = Color([0.16, 0.48, 0.68]);

    /// Parses a color: `#rrggbb`, `#rgb`, or a CSS name in uppercase or lowercase letters. `None` for other texts.
    pub fn parse(text: &str) -> Option<Color> {
        if let Some(&(_, code)) = NAMES.iter().find(|(name, _)| name.eq_ignore_ascii_case(text)) {
            return Some(Color::from_code(code));
        }
        let digits = text.strip_prefix('#')?;
        if !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
            return None;
        }
        let code = u32::from_str_radix(digits, 16).ok()?;
        match digits.len() {
            6 => Some(Color::from_code(code)),
            // Double each digit: `#rgb` is short for `#rrggbb`.
            3 => Some(Color::from_code(
                ((code >> 8) & 0xf) * 0x11_00_00 + ((code >> 4) & 0xf) * 0x11_00 + (code & 0xf) * 0x11,
            )),
            _ => None,
        }
    }

    /// Creates a color from a number `0xrrggbb`.
    pub fn from_code(code: u32) -> Color {
        Color([16, 8, 0].map(|shift| f64::from(code >> shift & 0xff) / 255.0))
    }

    /// Returns red, green and blue from 0 to 255.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the parts are from 0 to 255")]
    pub fn bytes(self) -> [u8; 3] {
        self.0.map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8)
    }

    /// Converts the color to linear RGB: red, green and blue from 0 to 1 (IEC 61966-2-1).
    pub fn linear(self) -> [f64; 3] {
        self.0.map(|c| if c <= 0.040_45 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_hexadecimal_digits_or_a_name() {
        assert_eq!(Color::parse("#ff0080"), Some(Color([1.0, 0.0, 128.0 / 255.0])));
        assert_eq!(Color::parse("#F08"), Color::parse("#ff0088"));
        assert_eq!(Color::parse("white"), Some(Color::WHITE));
        assert_eq!(Color::parse("SlateGrey"), Color::parse("slategray"));
        assert_eq!(Color::parse("rebeccapurple"), Color::parse("#663399"));
        for wrong in
            ["", "#", "#ff", "#ffff", "#ff00gg", "#+f0080", "ff0080", "#ff0080ff", "#ffé0", "blurple"]
        {
            assert_eq!(Color::parse(wrong), None, "{wrong}");
        }
    }

    /// The first six are those of Okabe and Ito, as bytes.
    #[test]
    fn colors_of_curves_are_those_of_the_source() {
        let bytes =
            [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [86, 180, 233], [230, 159, 0]];
        assert_eq!(Color::OF_CURVES.map(Color::bytes)[..6], bytes);
    }

    #[test]
    fn css_has_148_names_each_once_and_in_small_letters() {
        assert_eq!(NAMES.len(), 148);
        for pair in NAMES.windows(2) {
            assert!(pair[0].0 < pair[1].0, "{} is not in order", pair[1].0);
        }
        assert!(NAMES.iter().all(|(name, _)| name.bytes().all(|b| b.is_ascii_lowercase())));
    }

    #[test]
    fn linear_light_is_darker_than_srgb_in_between() {
        let [black, middle, white] = Color([0.0, 0.5, 1.0]).linear();
        assert_eq!([black, white], [0.0, 1.0]);
        // The expected value from IEC 61966-2-1: sRGB 0.5 is a linear intensity of 21.4 %.
        assert!((middle - 0.214_041).abs() < 1e-6, "{middle}");
    }
}
