//! Breaks labels into lines, where they are wider than the picture.

use super::super::framing::Free;
use super::super::text::{LINE, MARGIN};
use super::said::sample;
use super::{adapted, height};
use crate::lettering;
use crate::scene::{Label, LabelPlace, Output, Piece};

/// The largest part of the picture's height that a label in a corner may take after it was broken into lines.
const MAX_BROKEN_HEIGHT: f64 = 0.5;
/// The same for a label in the center.
const MOST_IN_CENTER: f64 = 0.9;

/// A label whose lines fit into the picture.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// The label, with a line break after each line.
    pub(super) label: Label,
    /// The height of a line of text in the image plane.
    pub(super) height: f64,
    /// The number of lines.
    pub(super) rows: usize,
    /// The width of the longest line.
    pub(super) wide: f64,
}

/// The spaces at which a label may be broken.
#[derive(Clone, Copy, PartialEq)]
enum Breaks {
    /// All but those between a number and its unit.
    Anywhere,
    /// Neither those beside a sign of [`FORMULA_SIGNS`].
    BesideFormulas,
}

/// The signs that stay in one line with what is on either side of them.
const FORMULA_SIGNS: [char; 12] = ['=', '≈', '≠', '<', '>', '≤', '≥', '∝', '·', '×', '/', '→'];

impl Block {
    /// Breaks a label into lines at spaces if it is wider than the free part of the picture. The lines get about the same length. A formula
    /// such as `v = 2 m/s` stays in one line if it fits. If a word is too long, or if there are too many lines, the letters get smaller. A
    /// label beside a body keeps its lines.
    pub(super) fn new(label: &Label, free: Free, output: Output) -> Block {
        let aspect = f64::from(output.height) / f64::from(output.width);
        let mut height = height(label, output);
        let room = 2.0 * (free.half - MARGIN);
        let words = Words::of(label, Breaks::BesideFormulas);
        let (words, allowed) = if words.longest() * height > room {
            (Words::of(label, Breaks::Anywhere), Breaks::Anywhere)
        } else {
            (words, Breaks::BesideFormulas)
        };
        let (mut rows, mut breaks, mut wide) = (words.lines.len(), Vec::new(), words.widest());
        let most = match label.place {
            LabelPlace::Body { .. } => f64::INFINITY,
            LabelPlace::Corner(_) => MAX_BROKEN_HEIGHT * 2.0 * aspect,
            LabelPlace::Center => MOST_IN_CENTER * 2.0 * aspect,
        };
        if most.is_finite() && wide * height > room {
            height = height.min(room / words.longest().max(1e-9));
            rows = words.broken(room / height).0;
            while rows > words.lines.len() && row_heights(rows) * height > most {
                height *= 0.95;
                rows = words.broken(room / height).0;
            }
            // The least width with the same number of lines makes lines of about the same length.
            let (mut low, mut high) = (words.longest(), room / height);
            for _ in 0..20 {
                let middle = (low + high) / 2.0;
                if words.broken(middle).0 > rows { low = middle } else { high = middle }
            }
            (_, breaks, wide) = words.broken(high);
        }
        Block { label: with_breaks(label, &breaks, allowed), height, rows, wide: wide * height }
    }

    /// The height of all lines.
    pub(super) fn high(&self) -> f64 {
        row_heights(self.rows) * self.height
    }
}

/// The height of lines, relative to the size of their letters.
#[allow(clippy::cast_precision_loss, reason = "there are few lines")]
fn row_heights(rows: usize) -> f64 {
    rows as f64 * LINE
}

/// The widths of the words of a label, relative to the size of its letters. A word is what stands between two spaces; a value is as wide
/// as a number of the largest expected length.
struct Words {
    /// The words of each line that the scene writes. No line is without words, but words can be empty.
    lines: Vec<Vec<f64>>,
    space: f64,
}

impl Words {
    fn of(label: &Label, allowed: Breaks) -> Words {
        let text: String = label.text.iter().map(sample).collect();
        let text = adapted(label, text.into());
        let wide = |words: &str| lettering::width(words, label.typeface());
        let mut lines: Vec<Vec<f64>> = Vec::new();
        for (separator, word) in parts(&text, allowed) {
            match (separator, lines.last_mut()) {
                (Some(' '), Some(line)) => line.push(wide(word)),
                _ => lines.push(vec![wide(word)]),
            }
        }
        Words { lines, space: wide(" ") }
    }

    /// The width of the longest word.
    fn longest(&self) -> f64 {
        self.lines.iter().flatten().copied().fold(0.0, f64::max)
    }

    /// The width of the longest line that the scene writes.
    fn widest(&self) -> f64 {
        self.broken(f64::INFINITY).2
    }

    /// Breaks the lines where they would be longer than `room`. Returns the number of lines, the numbers of the spaces that become breaks,
    /// and the width of the longest line.
    fn broken(&self, room: f64) -> (usize, Vec<usize>, f64) {
        let (mut breaks, mut widest, mut space) = (Vec::new(), 0.0_f64, 0);
        for line in &self.lines {
            let mut wide = line[0];
            for word in &line[1..] {
                let longer = wide + self.space + word;
                if longer > room * (1.0 + 1e-9) {
                    breaks.push(space);
                    widest = widest.max(wide);
                    wide = *word;
                } else {
                    wide = longer;
                }
                space += 1;
            }
            widest = widest.max(wide);
        }
        (self.lines.len() + breaks.len(), breaks, widest)
    }
}

/// Returns the bytes of a set text at which it can be split: its line breaks, and the spaces that are `allowed`. `follows` tells whether a
/// number stands right before the text.
fn splits(text: &str, follows: bool, allowed: Breaks) -> impl Iterator<Item = usize> {
    lettering::spaces(text).filter(move |at| {
        let (before, after) =
            (lettering::without_marks(&text[..*at]), lettering::without_marks(&text[at + 1..]));
        let is_after_number = match before {
            "" => follows,
            before => before.ends_with(|c: char| c.is_numeric()),
        };
        let is_in_formula = allowed == Breaks::BesideFormulas
            && (before.ends_with(FORMULA_SIGNS) || after.starts_with(FORMULA_SIGNS));
        let is_before_unit = is_after_number && after.starts_with(char::is_alphabetic);
        text[*at..].starts_with('\n') || !(is_before_unit || is_in_formula)
    })
}

/// Splits a set text where it can be. Returns each part with the space or line break before it, if any.
fn parts(text: &str, allowed: Breaks) -> Vec<(Option<char>, &str)> {
    let (mut parts, mut begin, mut separator) = (Vec::new(), 0, None);
    for at in splits(text, false, allowed) {
        parts.push((separator, &text[begin..at]));
        // Both are one byte long.
        (begin, separator) = (at + 1, text[at..].chars().next());
    }
    parts.push((separator, &text[begin..]));
    parts
}

/// Replaces spaces of a label, given by their numbers, by line breaks.
fn with_breaks(label: &Label, breaks: &[usize], allowed: Breaks) -> Label {
    let mut number = 0;
    let mut broken = label.clone();
    if breaks.is_empty() {
        return broken;
    }
    let mut follows = false;
    for piece in &mut broken.text {
        let ends_with_number = sample(piece).ends_with(|c: char| c.is_numeric());
        let follows = std::mem::replace(&mut follows, ends_with_number);
        let Piece::Words(words) = piece else { continue };
        let spaces: Vec<usize> =
            splits(words, follows, allowed).filter(|at| words[*at..].starts_with(' ')).collect();
        for at in spaces {
            if breaks.contains(&number) {
                words.replace_range(at..=at, "\n");
            }
            number += 1;
        }
    }
    broken
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::font::Typeface;
    use crate::scene::Scene;

    fn block(label: &str, size: [u32; 2]) -> Block {
        let [width, height] = size;
        let scene = Scene::parse(&format!(
            "output.size = [{width}, {height}]\n[body.ball]\nshape.sphere.radius = 1\n[label.note]\n{label}"
        ));
        let scene = scene.unwrap();
        Block::new(&scene.labels[0], Free::ALL, scene.output)
    }

    /// The lines of a block, with `#` for a value.
    fn lines(block: &Block) -> Vec<String> {
        let piece = |piece: &Piece| match piece {
            Piece::Words(words) => words.clone(),
            Piece::Value { .. } => "#".to_owned(),
        };
        block.label.text.iter().map(piece).collect::<String>().split('\n').map(str::to_owned).collect()
    }

    #[test]
    fn a_label_wider_than_the_picture_is_broken_into_lines_of_about_the_same_length() {
        let text = "text = 'A ball falls from a height of ${ball.y:.1} m to the ground, and loses energy at each impact'";
        let wide = block(text, [320, 180]);
        let usual = block("text = 'short'", [320, 180]);
        assert_eq!(wide.height, usual.height, "its letters do not shrink");
        let said = lines(&wide);
        assert_eq!((said.len(), wide.rows), (2, 2), "{said:?}");
        let widths: Vec<f64> = said.iter().map(|line| lettering::width(line, Typeface::usual())).collect();
        assert!(widths.iter().all(|wide| *wide > 0.7 * widths[0]), "{said:?}");
        assert!(wide.wide < 2.0 - 2.0 * MARGIN);
        assert_eq!(lines(&block(text, [1280, 360])).len(), 1, "a wide picture has room for one line");
    }

    #[test]
    fn a_number_and_its_unit_stay_in_one_line() {
        for width in (200..400).step_by(10) {
            let text = "text = 'It has 18 m/s, and then ${ball.speed:.1} m/s, and at the end 2 m/s'";
            let said = lines(&block(text, [width, 180]));
            assert!(said.iter().all(|line| !line.starts_with("m/s")), "{said:?}");
        }
    }

    #[test]
    fn a_formula_stays_in_one_line() {
        for width in (200..400).step_by(10) {
            let text = "text = 'Two masses: m₁ = 2 kg and m₂ = 3 kg, v = ${ball.speed:.1} m/s at the end'";
            let said = lines(&block(text, [width, 180]));
            let is_torn = |line: &String| line.starts_with('=') || line.ends_with('=');
            assert!(said.len() > 1 && !said.iter().any(is_torn), "{said:?}");
        }
        let chain = "a = b = c = d = e = f = g = h = i = j = k = l = m = n = o = p";
        let said = block(&format!("text = '{chain}'"), [320, 180]);
        assert!(said.rows > 1, "a formula too long for the picture is broken: {said:?}");
    }

    #[test]
    fn a_line_break_of_the_scene_stays() {
        assert_eq!(lines(&block(r#"text = "one\ntwo words""#, [320, 180])), ["one", "two words"]);
        let both =
            block("text = \"Head\\nA ball falls from a height of 10 m, and it loses energy\"", [320, 180]);
        let said = lines(&both);
        assert!(said.len() == 3 && said[0] == "Head", "{said:?}");
    }

    #[test]
    fn letters_shrink_if_a_word_is_too_long_or_there_are_too_many_lines() {
        let usual = block("text = 'short'", [320, 180]).height;
        let word = block(&format!("text = '{}'", "W".repeat(80)), [320, 180]);
        assert!(word.height < usual && word.rows == 1, "{word:?}");
        let many = block(&format!("size = 0.2\ntext = '{}'", "word ".repeat(30).trim()), [320, 180]);
        assert!(many.high() <= 0.5 * 2.0 * 180.0 / 320.0 && many.rows > 4, "{many:?}");
    }
}
