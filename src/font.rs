//! The font of all texts in pictures: DejaVu Sans. jabuka puts a copy of its file beside the scripts.

use std::sync::LazyLock;

use ttf_parser::Face;

/// The name of the font's file.
pub const FILE_NAME: &str = "DejaVuSans.ttf";

/// The contents of the font's file.
pub static FILE_BYTES: &[u8] = include_bytes!("../templates/assets/DejaVuSans.ttf");

/// The font, parsed. It always parses, as the tests below show.
static FACE: LazyLock<Option<Face<'static>>> = LazyLock::new(|| Face::parse(FILE_BYTES, 0).ok());

/// Returns whether a text can contain a letter: the font has it, and POV-Ray draws it right. POV-Ray sets letters from left to right, and
/// does not join them as Arabic needs.
pub fn has(letter: char) -> bool {
    let is_right_to_left =
        matches!(letter, '\u{590}'..='\u{8ff}' | '\u{fb1d}'..='\u{fdff}' | '\u{fe70}'..='\u{feff}');
    // POV-Ray 3.7 knows only the letters of Unicode's basic plane.
    let is_drawn = !letter.is_control() && letter <= '\u{ffff}' && !is_right_to_left;
    is_drawn && FACE.as_ref().is_some_and(|face| face.glyph_index(letter).is_some())
}

/// Returns the width of a text, relative to the size of the font (its em): the sum of the advance widths of its letters.
pub fn width(text: &str) -> f64 {
    let Some(face) = FACE.as_ref() else { return 0.0 };
    let advance = |letter: char| face.glyph_hor_advance(face.glyph_index(letter).unwrap_or_default());
    let advances = text.chars().map(|letter| f64::from(advance(letter).unwrap_or_default()));
    advances.sum::<f64>() / f64::from(face.units_per_em())
}

/// Returns where the ink of a text begins and ends, relative to the size of the font, measured from where its first letter begins.
/// `None` for a text without ink.
pub fn ink(text: &str) -> Option<[f64; 2]> {
    let face = FACE.as_ref()?;
    let em = f64::from(face.units_per_em());
    let bounds = |letter: char| face.glyph_bounding_box(face.glyph_index(letter)?);
    let mut at = 0.0;
    let mut ink: Option<[f64; 2]> = None;
    for letter in text.chars() {
        if let Some(bounds) = bounds(letter) {
            let [left, right] = [bounds.x_min, bounds.x_max].map(|x| at + f64::from(x) / em);
            ink = Some(ink.map_or([left, right], |[begin, end]| [begin.min(left), end.max(right)]));
        }
        at += width(letter.encode_utf8(&mut [0; 4]));
    }
    ink
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_many_languages_are_there() {
        let text = "Δφ = 30°, Höhe 2,5·10⁻³ m, Å, ×, é, ł, Ж, ω₀, −1, ½, ∂, ∑, ≈, →";
        assert!(text.chars().all(has), "{:?}", text.chars().find(|letter| !has(*letter)));
        for missing in ['漢', 'א', 'ب', '🙂', '\n'] {
            assert!(!has(missing), "{missing}");
        }
    }
}
