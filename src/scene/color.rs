//! Colors.

/// A color in sRGB, as screens and color pickers show it: red, green and blue from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color(pub [f64; 3]);

/// The colors that have names.
pub(super) const NAMES: &[(&str, u32)] = &[
    ("white", 0xff_ff_ff),
    ("silver", 0xc0_c0_c0),
    ("gray", 0x80_80_80),
    ("black", 0x00_00_00),
    ("red", 0xff_00_00),
    ("maroon", 0x80_00_00),
    ("orange", 0xff_a5_00),
    ("yellow", 0xff_ff_00),
    ("olive", 0x80_80_00),
    ("lime", 0x00_ff_00),
    ("green", 0x00_80_00),
    ("teal", 0x00_80_80),
    ("cyan", 0x00_ff_ff),
    ("blue", 0x00_00_ff),
    ("navy", 0x00_00_80),
    ("purple", 0x80_00_80),
    ("magenta", 0xff_00_ff),
    ("pink", 0xff_c0_cb),
    ("brown", 0xa5_2a_2a),
    ("gold", 0xff_d7_00),
];

/// The colors that have names, each with what it is short for.
pub(crate) fn names() -> Vec<(&'static str, String)> {
    NAMES.iter().map(|&(name, code)| (name, format!("#{code:06x}"))).collect()
}

impl Color {
    /// White.
    pub const WHITE: Color = Color([1.0; 3]);

    /// The color that a text stands for: `#rrggbb` or a name of CSS.
    pub fn parse(text: &str) -> Option<Color> {
        if let Some(&(_, code)) = NAMES.iter().find(|(name, _)| *name == text) {
            return Some(Color::from_code(code));
        }
        let digits = text.strip_prefix('#')?;
        let all_hex = digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit());
        all_hex.then(|| u32::from_str_radix(digits, 16).ok().map(Color::from_code))?
    }

    /// The color `0xrrggbb`.
    pub fn from_code(code: u32) -> Color {
        Color([16, 8, 0].map(|shift| f64::from(code >> shift & 0xff) / 255.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_six_hexadecimal_digits_or_a_name() {
        assert_eq!(Color::parse("#ff0080"), Some(Color([1.0, 0.0, 128.0 / 255.0])));
        assert_eq!(Color::parse("white"), Some(Color::WHITE));
        for wrong in ["", "#", "#fff", "#ff00gg", "#+f0080", "ff0080", "#ff0080ff", "#ffé0", "blurple"] {
            assert_eq!(Color::parse(wrong), None, "{wrong}");
        }
    }
}
