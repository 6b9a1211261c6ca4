//! Writes texts and the scale bar on the image plane in front of the camera, in SDL.

use super::super::{sdl::Style, text};
use super::color;
use crate::font::{Typeface, Weight};
use crate::lettering;
use crate::picture::{Bar, LINE, Screen, Text, Vertical, number};

/// Returns the SDL transform from coordinates in the image plane to world coordinates.
pub(super) fn transform(screen: &Screen, style: Style) -> String {
    let mut out = "matrix <".to_owned();
    for row in screen.axes() {
        for entry in (row / style.unit).to_array() {
            number::write(&mut out, entry, style.digits);
            out.push_str(", ");
        }
    }
    let middle = (screen.middle() / style.unit).to_array();
    for (i, entry) in middle.into_iter().enumerate() {
        number::write(&mut out, entry, style.digits);
        out.push_str(if i < 2 { ", " } else { ">" });
    }
    out
}

/// Appends a text on the image plane.
pub(super) fn write(out: &mut String, text: &Text<'_>, style: Style) {
    let digits = |inset: f64| {
        let mut out = String::new();
        number::write(&mut out, inset, 4);
        out
    };
    label(out, ("Label", text), |rise| height(text.y.raised(rise), digits), style);
}

/// Appends a text on the panel of a plot.
pub(super) fn write_on_panel(out: &mut String, text: &Text<'_>, style: Style) {
    label(out, ("Word", text), |rise| height(text.y.raised(rise), short), style);
}

/// Appends the scale bar and its number.
pub(super) fn write_bar(out: &mut String, bar: &Bar, number: &Text<'_>, style: Style) {
    let y = height(bar.y, short);
    let (from, to, thickness) = (short(bar.from), short(bar.to), length(bar.thickness));
    let ink = color(bar.color, style);
    out.push_str(&format!("Bar(<{from}, {y}, 0>, {to}, {thickness}, {ink}) // scale bar\n"));
    label(out, ("Label", number), |rise| format!("{y} + {}", length(bar.above + rise)), style);
}

/// Appends a text. `y` gives the vertical position of letters at a distance above the base line.
fn label(out: &mut String, (of, text): (&str, &Text<'_>), y: impl Fn(f64) -> String, style: Style) {
    let (ink, name) = (color(text.color, style), text::comment(text.name));
    let usual = Typeface::usual().font(Weight::Regular).file_name();
    for part in parts(text) {
        // POV-Ray refuses an empty text, so a dash replaces it.
        let said = if part.letters.trim().is_empty() { "-" } else { part.letters };
        let said = text::string(said);
        let (x, y, height, align) = (short(part.x), y(part.rise), length(part.height), short(part.align));
        let font = text.typeface.font(part.weight).file_name();
        let call = match font == usual {
            true => format!("{of}("),
            false => format!("{of}_in(\"assets/{}\", ", text::string(font)),
        };
        out.push_str(&format!("{call}\"{said}\", <{x}, {y}, 0>, {height}, {align}, {ink}) // {name}\n"));
    }
}

/// A part of a text with letters of one size and weight, in units of the image plane.
struct TextRun<'a> {
    letters: &'a str,
    weight: Weight,
    x: f64,
    /// The distance of the part's base line above that of the text.
    rise: f64,
    height: f64,
    align: f64,
}

/// Divides a text into parts with letters of one size and weight, each on one line. An empty line has no parts, if there are others.
fn parts<'a>(text: &'a Text<'_>) -> Vec<TextRun<'a>> {
    if text.says.trim().is_empty() {
        return parts_of_line(text, "");
    }
    let mut parts = Vec::new();
    let mut below = 0.0;
    for line in text.says.split('\n') {
        if !line.trim().is_empty() {
            let moved = parts_of_line(text, line).into_iter();
            parts.extend(moved.map(|part| TextRun { rise: part.rise - below, ..part }));
        }
        below += LINE * text.height;
    }
    parts
}

/// Divides a line of a text into parts with letters of one size and weight.
fn parts_of_line<'a>(text: &Text<'_>, line: &'a str) -> Vec<TextRun<'a>> {
    let runs: Vec<lettering::Run<'a>> = lettering::runs(line).collect();
    let part = |(letters, weight), x, (rise, size): (f64, f64), align| TextRun {
        letters,
        weight,
        x,
        rise: rise * text.height,
        height: size * text.height,
        align,
    };
    let [_, _, ..] = runs.as_slice() else {
        let letters = runs.first().map_or(("", Weight::Regular), |run| (run.letters, run.weight));
        return vec![part(letters, text.x, (0.0, 1.0), text.align)];
    };
    // POV-Ray places a text by its ink, as does the scene's `align`. So the ink of each part is placed.
    let (mut at, mut inks) = (0.0, Vec::new());
    for run in runs {
        let (size, font) = (run.level.size(), text.typeface.font(run.weight));
        // POV-Ray counts spaces at the ends as ink, so they are left out. Spaces alone are no part.
        let letters = run.letters.trim_start();
        at += size * font.width(&run.letters[..run.letters.len() - letters.len()]);
        let run = lettering::Run { letters: letters.trim_end(), ..run };
        inks.extend(font.ink(run.letters).map(|ink| (run, ink.map(|x| at + size * x))));
        at += size * font.width(letters);
    }
    let ends =
        inks.first().zip(inks.last()).map_or([0.0; 2], |((_, [begin, _]), (_, [_, end]))| [*begin, *end]);
    let begin = text.x - text.height * (ends[0] + text.align * (ends[1] - ends[0]));
    let placed = |(run, [left, _]): (lettering::Run<'a>, [f64; 2])| {
        let size = (run.level.rise(), run.level.size());
        part((run.letters, run.weight), begin + text.height * left, size, 0.0)
    };
    inks.into_iter().map(placed).collect()
}

/// Returns a vertical position in the image plane as an SDL expression. It is an expression because the upper and lower edge of the image
/// depend on the aspect ratio, which is known only when POV-Ray renders the image.
pub(super) fn height(y: Vertical, inset: impl Fn(f64) -> String) -> String {
    match y {
        Vertical::Middle(height) => short(height),
        Vertical::Top(below) => format!("Screen_top - {}", inset(below)),
        Vertical::Bottom(above) => format!("{} - Screen_top", inset(above)),
    }
}

/// Formats a coordinate in the image plane, with a precision finer than a pixel.
pub(super) fn short(place: f64) -> String {
    let mut out = String::new();
    number::write(&mut out, (place * 1e5).round() / 1e5, 6);
    out
}

/// Formats a length in the image plane. Small lengths get more digits, since texts are far smaller than the width of a very wide picture.
pub(super) fn length(length: f64) -> String {
    if length >= 1e-3 {
        return short(length);
    }
    let mut out = String::new();
    number::write(&mut out, length, 4);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::font::Font;
    use crate::scene::Color;

    fn regular() -> &'static Font {
        Typeface::usual().font(Weight::Regular)
    }

    /// The parts of a text at the middle of the picture, with a height of 1.
    fn parts_of(says: &str, align: f64) -> Vec<(String, f64, f64, f64)> {
        let says = says.split('\n').map(|line| lettering::set(line, 0..line.len(), &mut None).unwrap());
        let says = says.collect::<Vec<_>>().join("\n").into();
        let (y, color) = (Vertical::Middle(0.0), Color::WHITE);
        let text = Text {
            name: "t",
            says,
            x: 0.0,
            y,
            height: 1.0,
            align,
            color,
            typeface: Typeface::usual(),
            anchor: None,
        };
        parts(&text)
            .into_iter()
            .map(|part| (part.letters.to_owned(), part.x, part.rise, part.height))
            .collect()
    }

    #[test]
    fn a_subscript_begins_where_the_letter_before_it_ends() {
        let parts = parts_of("x_{max} = 2", 0.0);
        let letters: Vec<&str> = parts.iter().map(|(letters, ..)| letters.as_str()).collect();
        assert_eq!(letters, ["x", "max", "= 2"]);
        assert_eq!(parts[0], ("x".to_owned(), 0.0, 0.0, 1.0));
        let (_, x, rise, height) = parts[1];
        assert!((0.5..0.7).contains(&x) && rise < -0.1 && height == lettering::SCRIPT_SIZE, "{parts:?}");
        // The space before the sign is about a third of the height.
        let end = x + lettering::SCRIPT_SIZE * regular().width("max");
        assert!((0.25..0.45).contains(&(parts[2].1 - end)), "{parts:?}");
        let left = parts_of("x_{max} = 2", 1.0);
        let shift = parts[0].1 - left[0].1;
        let ink_end = parts[2].1 + regular().width("= 2");
        // The ink of the last letters is narrower than their width by the gaps at both sides.
        assert!((shift - ink_end).abs() < 0.25, "it ends at its place: {left:?}");
    }

    #[test]
    fn lines_stand_below_each_other_and_empty_ones_take_room() {
        let parts = parts_of("a\n\nx_{max}", 0.5);
        let rises: Vec<f64> = parts.iter().map(|(_, _, rise, _)| *rise).collect();
        assert_eq!(parts.len(), 3);
        assert!(rises[0] == 0.0 && (rises[1] + 2.0 * LINE).abs() < 1e-9 && rises[2] < rises[1], "{parts:?}");
        assert_eq!(parts_of(" ", 0.0).len(), 1, "a text without letters is drawn as a dash");
    }
}
