//! The fonts of texts in pictures. Texts are set in DejaVu Sans, unless a label has a font of its own. jabuka puts copies of the files beside
//! the scripts.

use std::borrow::Cow;
use std::fmt;
use std::sync::{LazyLock, OnceLock};

use owned_ttf_parser::{AsFaceRef, Face, OutlineBuilder, OwnedFace};

/// The weight of letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// The usual letters.
    Regular,
    /// Letters with thicker strokes.
    Bold,
}

/// A font file.
pub struct Font {
    file_name: Cow<'static, str>,
    /// The font, parsed. `None` only for fonts that the host has not given, or that do not parse.
    face: Option<OwnedFace>,
}

/// The fonts of a text, one for each weight.
pub struct Typeface {
    regular: Font,
    /// `None` if bold letters are set in the regular font.
    bold: Option<Font>,
}

/// The contents of the files of DejaVu Sans, regular and bold.
#[cfg(feature = "fonts")]
pub(crate) static BUILT_IN: [&[u8]; 2] = [
    include_bytes!("../templates/assets/DejaVuSans.ttf"),
    include_bytes!("../templates/assets/DejaVuSans-Bold.ttf"),
];
#[cfg(not(feature = "fonts"))]
static BUILT_IN: [&[u8]; 2] = [&[]; 2];

static GIVEN: OnceLock<[Vec<u8>; 2]> = OnceLock::new();

/// Gives the library the contents of the files of DejaVu Sans, regular and bold. Without the feature `fonts`, its host must do so before it
/// reads the first scene. Otherwise no text has a letter that can be drawn.
pub fn give(files: [Vec<u8>; 2]) {
    // The fonts that were given first stay.
    let _ = GIVEN.set(files);
}

/// Returns the files of DejaVu Sans, regular and bold: their names and contents.
pub fn files() -> [(&'static str, &'static [u8]); 2] {
    let [regular, bold] = GIVEN.get().map_or(BUILT_IN, |files| files.each_ref().map(Vec::as_slice));
    [("DejaVuSans.ttf", regular), ("DejaVuSans-Bold.ttf", bold)]
}

static DEJAVU_SANS: LazyLock<Typeface> = LazyLock::new(|| {
    let [regular, bold] = files().map(|(name, bytes)| Font {
        file_name: name.into(),
        face: OwnedFace::from_vec(bytes.to_vec(), 0).ok(),
    });
    Typeface { regular, bold: Some(bold) }
});

impl Typeface {
    /// DejaVu Sans, in which texts are set that have no font of their own.
    pub fn usual() -> &'static Typeface {
        &DEJAVU_SANS
    }

    /// Creates the typeface of a font file, which has one weight. `file_name` is its path among the assets.
    ///
    /// # Errors
    ///
    /// Returns the reason why POV-Ray cannot set texts in the font.
    pub fn of_file(file_name: String, bytes: Vec<u8>) -> Result<Typeface, &'static str> {
        if bytes.starts_with(b"ttcf") {
            return Err("it is a collection of fonts, and POV-Ray reads files with one font");
        }
        let face = OwnedFace::from_vec(bytes, 0).map_err(|_| "it is not a TrueType font")?;
        let tables = face.as_face_ref().tables();
        if tables.glyf.is_none() {
            return Err("its outlines are those of PostScript, and POV-Ray reads TrueType outlines");
        }
        if tables.cmap.is_none_or(|cmap| cmap.subtables.into_iter().all(|table| !table.is_unicode())) {
            return Err("it has no table of Unicode letters");
        }
        Ok(Typeface { regular: Font { file_name: file_name.into(), face: Some(face) }, bold: None })
    }

    /// Returns the font of a weight.
    pub fn font(&self, weight: Weight) -> &Font {
        match (&self.bold, weight) {
            (Some(bold), Weight::Bold) => bold,
            (None, Weight::Bold) | (_, Weight::Regular) => &self.regular,
        }
    }

    /// Returns whether bold letters differ from regular ones.
    pub fn has_bold(&self) -> bool {
        self.bold.is_some()
    }
}

impl PartialEq for Typeface {
    /// Typefaces are equal if they are the same one.
    fn eq(&self, other: &Typeface) -> bool {
        std::ptr::eq(self, other)
    }
}

impl fmt::Debug for Typeface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Typeface").field(&self.regular.file_name).finish()
    }
}

impl Font {
    /// The path of the font's file among the assets.
    pub fn file_name(&self) -> &str {
        &self.file_name
    }

    /// The contents of the font's file.
    pub fn bytes(&self) -> &[u8] {
        self.face.as_ref().map_or(&[], OwnedFace::as_slice)
    }

    fn face(&self) -> Option<&Face<'_>> {
        self.face.as_ref().map(OwnedFace::as_face_ref)
    }

    /// Returns whether a text can contain a letter: the font has it, and POV-Ray draws it right. POV-Ray sets letters from left to right, and
    /// does not join them as Arabic needs.
    pub fn has(&self, letter: char) -> bool {
        let is_right_to_left =
            matches!(letter, '\u{590}'..='\u{8ff}' | '\u{fb1d}'..='\u{fdff}' | '\u{fe70}'..='\u{feff}');
        // POV-Ray 3.7 knows only the letters of Unicode's basic plane.
        let is_drawn = !letter.is_control() && letter <= '\u{ffff}' && !is_right_to_left;
        is_drawn && self.face().is_some_and(|face| face.glyph_index(letter).is_some())
    }

    /// Returns the width of a text, relative to the size of the font (its em): the sum of the advance widths of its letters.
    pub fn width(&self, text: &str) -> f64 {
        let Some(face) = self.face() else { return 0.0 };
        let advance = |letter: char| face.glyph_hor_advance(face.glyph_index(letter).unwrap_or_default());
        let advances = text.chars().map(|letter| f64::from(advance(letter).unwrap_or_default()));
        advances.sum::<f64>() / f64::from(face.units_per_em())
    }

    /// Returns where the ink of a text begins and ends, relative to the size of the font, measured from where its first letter begins.
    /// `None` for a text without ink.
    pub fn ink(&self, text: &str) -> Option<[f64; 2]> {
        let face = self.face()?;
        let em = f64::from(face.units_per_em());
        let bounds = |letter: char| face.glyph_bounding_box(face.glyph_index(letter)?);
        let mut at = 0.0;
        let mut ink: Option<[f64; 2]> = None;
        for letter in text.chars() {
            if let Some(bounds) = bounds(letter) {
                let [left, right] = [bounds.x_min, bounds.x_max].map(|x| at + f64::from(x) / em);
                ink = Some(ink.map_or([left, right], |[begin, end]| [begin.min(left), end.max(right)]));
            }
            at += self.width(letter.encode_utf8(&mut [0; 4]));
        }
        ink
    }

    /// Returns the outline of a text, relative to the size of the font, with x to the right and y upwards from where its first letter begins.
    pub fn outline(&self, text: &str) -> Vec<Step> {
        let Some(face) = self.face() else { return Vec::new() };
        let mut outline = Outline { steps: Vec::new(), left: 0.0, em: f64::from(face.units_per_em()) };
        for letter in text.chars() {
            let glyph = face.glyph_index(letter).unwrap_or_default();
            face.outline_glyph(glyph, &mut outline);
            outline.left += f64::from(face.glyph_hor_advance(glyph).unwrap_or_default());
        }
        outline.steps
    }
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

    // TrueType outlines have quadratic curves only.
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
        for weight in [Weight::Regular, Weight::Bold] {
            let font = Typeface::usual().font(weight);
            assert!(
                text.chars().all(|letter| font.has(letter)),
                "{:?}",
                text.chars().find(|letter| !font.has(*letter))
            );
            for missing in ['漢', 'א', 'ب', '🙂', '\n'] {
                assert!(!font.has(missing), "{missing}");
            }
        }
    }

    /// The outline of a letter is as wide as its ink.
    #[test]
    fn outlines_are_where_the_ink_is() {
        let fonts = [Weight::Regular, Weight::Bold].map(|weight| Typeface::usual().font(weight));
        for (text, font) in ["x", "Δφ = 30°", "10⁻³ m"].into_iter().zip(fonts.into_iter().cycle()) {
            let points = font.outline(text).into_iter().map(|step| match step {
                Step::Move(to) | Step::Line(to) | Step::Curve { to, .. } => to,
            });
            let (left, right) = points.fold((f64::INFINITY, f64::NEG_INFINITY), |(left, right), [x, _]| {
                (left.min(x), right.max(x))
            });
            let [begin, end] = font.ink(text).unwrap();
            assert!((left - begin).abs() < 0.01 && (right - end).abs() < 0.01, "{text}: {left} {right}");
        }
        assert_eq!(fonts[0].outline(" "), []);
        assert!(fonts[1].width("bold") > 1.05 * fonts[0].width("bold"));
    }

    #[test]
    fn a_font_of_ones_own_must_be_one_that_povray_reads() {
        let own = |bytes: &[u8]| Typeface::of_file("own.ttf".to_owned(), bytes.to_vec());
        assert_eq!(own(BUILT_IN[1]).unwrap().font(Weight::Bold).file_name(), "own.ttf");
        for bytes in [b"ttcf\0\x01".as_slice(), b"", b"no font", &BUILT_IN[0][..1000]] {
            assert!(own(bytes).is_err());
        }
    }
}
