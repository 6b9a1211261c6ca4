//! The font of all texts in pictures: DejaVu Sans. jabuka puts a copy of its file beside the scripts.

use std::sync::LazyLock;

use ttf_parser::{Face, OutlineBuilder};

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

/// A step of the outline of letters. Each closed line begins with a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// To the start of a closed line.
    Move([f64; 2]),
    /// Along a straight line.
    Line([f64; 2]),
    /// Along a quadratic Bézier curve.
    Curve {
        /// The control point of the curve.
        control: [f64; 2],
        /// The end of the curve.
        to: [f64; 2],
    },
}

/// Returns the outline of a text, relative to the size of the font, with x to the right and y upwards from where its first letter begins.
pub fn outline(text: &str) -> Vec<Step> {
    let Some(face) = FACE.as_ref() else { return Vec::new() };
    let mut outline = Outline { steps: Vec::new(), left: 0.0, em: f64::from(face.units_per_em()) };
    for letter in text.chars() {
        let glyph = face.glyph_index(letter).unwrap_or_default();
        face.outline_glyph(glyph, &mut outline);
        outline.left += f64::from(face.glyph_hor_advance(glyph).unwrap_or_default());
    }
    outline.steps
}

/// An outline that is being read from the font.
struct Outline {
    steps: Vec<Step>,
    /// Where the letter begins, in units of the font.
    left: f64,
    /// The size of the font, in its units.
    em: f64,
}

impl Outline {
    fn at(&self, x: f32, y: f32) -> [f64; 2] {
        [(self.left + f64::from(x)) / self.em, f64::from(y) / self.em]
    }
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.steps.push(Step::Move(self.at(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.steps.push(Step::Line(self.at(x, y)));
    }

    fn quad_to(&mut self, control_x: f32, control_y: f32, x: f32, y: f32) {
        self.steps.push(Step::Curve { control: self.at(control_x, control_y), to: self.at(x, y) });
    }

    // The font has quadratic curves only.
    fn curve_to(&mut self, _: f32, _: f32, _: f32, _: f32, x: f32, y: f32) {
        self.line_to(x, y);
    }

    fn close(&mut self) {}
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

    /// The outline of a letter is as wide as its ink.
    #[test]
    fn outlines_are_where_the_ink_is() {
        for text in ["x", "Δφ = 30°", "10⁻³ m"] {
            let points = outline(text).into_iter().map(|step| match step {
                Step::Move(to) | Step::Line(to) | Step::Curve { to, .. } => to,
            });
            let (left, right) = points.fold((f64::INFINITY, f64::NEG_INFINITY), |(left, right), [x, _]| {
                (left.min(x), right.max(x))
            });
            let [begin, end] = ink(text).unwrap();
            assert!((left - begin).abs() < 0.01 && (right - end).abs() < 0.01, "{text}: {left} {right}");
        }
        assert_eq!(outline(" "), []);
    }
}
