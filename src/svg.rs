//! Writes drawings of lines and texts as SVG.

use std::fmt::Write as _;

use crate::font::Weight;
use crate::lettering::{self, Level};

/// A color: red, green and blue, 0 to 255.
pub(crate) type Rgb = [u8; 3];

/// The part of a text that lies at its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// The start of the text.
    Start,
    /// The middle of the text.
    Middle,
    /// The end of the text.
    End,
}

/// An SVG document that is being written. Positions are in pixels, from the upper left corner.
pub(crate) struct Svg {
    text: String,
}

impl Svg {
    /// Begins a document of a width and height, with a background and the fonts of its texts.
    pub(crate) fn new(size: [f64; 2], background: Rgb, fonts: &str) -> Svg {
        let [width, height] = size.map(hundredths);
        let fill = hex(background);
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"{fonts}\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"{fill}\"/>\n"
        );
        Svg { text }
    }

    /// Adds a line through points.
    pub(crate) fn line(&mut self, points: impl IntoIterator<Item = [f64; 2]>, width: f64, color: Rgb) {
        let points: Vec<String> = points.into_iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(
            self.text,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"/>",
            points.join(" "),
            hex(color),
            hundredths(width)
        );
    }

    /// Adds a filled rectangle, given two opposite corners.
    pub(crate) fn rectangle(&mut self, [one, other]: [[f64; 2]; 2], color: Rgb) {
        let [x, y] = [0, 1].map(|axis| one[axis].min(other[axis]));
        let [width, height] = [0, 1].map(|axis| (one[axis] - other[axis]).abs());
        // Writing to a string cannot fail.
        let _ = writeln!(
            self.text,
            "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" fill=\"{}\"/>",
            hex(color)
        );
    }

    /// Adds a text in one line. `at` is the position of its anchor, at half the height of the letters. `size` is the size of the font.
    pub(crate) fn text(&mut self, [x, y]: [f64; 2], text: &str, anchor: Anchor, size: f64, color: Rgb) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        // Writing to a string cannot fail.
        let _ = writeln!(
            self.text,
            "<text x=\"{x:.2}\" y=\"{y:.2}\" dy=\"{HALF_OF_LETTERS}em\" font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{}\">{}</text>",
            hundredths(size),
            hex(color),
            words(text, size)
        );
    }

    /// Ends the document, and returns its text.
    pub(crate) fn finish(self) -> String {
        self.text + "</svg>\n"
    }
}

/// The height of the middle of letters above their base line, in sizes of the font.
pub(crate) const HALF_OF_LETTERS: f64 = 0.35;

/// Rounds a length to hundredths of a pixel.
fn hundredths(length: f64) -> f64 {
    (length * 100.0).round() / 100.0
}

fn hex([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Returns the words of a text as the contents of an element, with smaller letters for subscripts and superscripts, and bold ones.
fn words(text: &str, size: f64) -> String {
    let mut out = String::new();
    let mut risen = 0.0;
    for run in lettering::runs(text) {
        let (letters, rise) = (escaped(run.letters), run.level.rise() * size);
        let down = risen - rise;
        risen = rise;
        let bold = if run.weight == Weight::Bold { " font-weight=\"bold\"" } else { "" };
        // Writing to a string cannot fail.
        let _ = match (run.level, down == 0.0) {
            (Level::Line, true) if bold.is_empty() => write!(out, "{letters}"),
            (Level::Line, _) => write!(out, "<tspan dy=\"{down:.2}\"{bold}>{letters}</tspan>"),
            (level, _) => {
                let small = level.size() * size;
                write!(out, "<tspan dy=\"{down:.2}\" font-size=\"{small:.2}\"{bold}>{letters}</tspan>")
            }
        };
    }
    out
}

/// Escapes a text for use between XML tags. Control characters are removed.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars().filter(|c| !c.is_control()) {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_has_its_lines_and_texts() {
        let mut svg = Svg::new([100.0, 50.125], [255; 3], "serif");
        svg.line([[0.0, 1.0], [99.999, 50.0]], 2.0, [0, 114, 178]);
        svg.text([50.0, 25.0], "a < b", Anchor::Middle, 14.0, [0; 3]);
        assert_eq!(
            svg.finish(),
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100\" height=\"50.13\" viewBox=\"0 0 100 50.13\" font-family=\"serif\">\n\
             <rect width=\"100\" height=\"50.13\" fill=\"#ffffff\"/>\n\
             <polyline points=\"0.00,1.00 100.00,50.00\" fill=\"none\" stroke=\"#0072b2\" stroke-width=\"2\" stroke-linejoin=\"round\"/>\n\
             <text x=\"50.00\" y=\"25.00\" dy=\"0.35em\" font-size=\"14\" text-anchor=\"middle\" fill=\"#000000\">a &lt; b</text>\n\
             </svg>\n"
        );
    }

    #[test]
    fn a_name_is_text_and_nothing_else() {
        assert_eq!(escaped("a<b>&\u{1b}c"), "a&lt;b&gt;&amp;c");
    }
}
