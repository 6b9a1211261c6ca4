//! Writes drawings as PDF 1.4: one page of paths. Letters are paths, too, so that a file needs no fonts.
//!
//! ISO 32000-1:2008, sections 7.5 (the structure of files), 8.5 (paths) and 8.6 (colors).

use std::fmt::Write as _;

use super::{Drawing, Item, outlines};
use crate::font::Step;
use crate::svg::Rgb;

/// The size of a pixel of a drawing, in the points of PDF (1/72 inch). In SVG, a pixel is 1/96 inch.
const POINTS_PER_PIXEL: f64 = 0.75;

impl Drawing {
    /// Returns the drawing as the bytes of a PDF file.
    pub(crate) fn pdf(&self) -> Vec<u8> {
        let [width, height] = self.size.map(|length| number(length * POINTS_PER_PIXEL));
        let contents = self.contents();
        let objects = [
            "<< /Type /Catalog /Pages 2 0 R >>".to_owned(),
            "<< /Type /Pages /Kids [3 0 R] /Count 1 >>".to_owned(),
            format!(
                "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width} {height}] /Resources << >> /Contents 4 0 R >>"
            ),
            format!("<< /Length {} >>\nstream\n{contents}endstream", contents.len()),
        ];
        let mut out = "%PDF-1.4\n".to_owned();
        let mut table = format!("xref\n0 {}\n0000000000 65535 f \n", objects.len() + 1);
        for (index, object) in objects.iter().enumerate() {
            // Writing to a string cannot fail.
            let _ = writeln!(table, "{:010} 00000 n ", out.len());
            let _ = writeln!(out, "{} 0 obj\n{object}\nendobj", index + 1);
        }
        let (count, start) = (objects.len() + 1, out.len());
        let _ = write!(out, "{table}trailer\n<< /Size {count} /Root 1 0 R >>\nstartxref\n{start}\n%%EOF\n");
        out.into_bytes()
    }

    /// Returns the operators that draw the page.
    fn contents(&self) -> String {
        let [width, height] = self.size;
        let mut out = String::new();
        // From here on, positions are those of the drawing: in pixels from the upper left corner. Joins of lines are round.
        let _ = writeln!(
            out,
            "{POINTS_PER_PIXEL} 0 0 -{POINTS_PER_PIXEL} 0 {} cm 1 j",
            number(height * POINTS_PER_PIXEL)
        );
        rectangle(&mut out, [[0.0; 2], [width, height]], self.background);
        for item in &self.items {
            match item {
                Item::Line { points, width, color } => {
                    let _ = writeln!(out, "{} RG {} w", ink(*color), number(*width));
                    for (index, point) in points.iter().enumerate() {
                        let _ = writeln!(out, "{} {}", at(*point), if index == 0 { "m" } else { "l" });
                    }
                    out.push_str("S\n");
                }
                Item::Rectangle { corners, color } => rectangle(&mut out, *corners, *color),
                Item::Text { at, says, anchor, size, color } => {
                    let _ = writeln!(out, "{} rg", ink(*color));
                    letters(&mut out, &outlines(*at, says, *anchor, *size));
                }
            }
        }
        out
    }
}

/// Appends a filled rectangle.
fn rectangle(out: &mut String, [[x, y], [right, bottom]]: [[f64; 2]; 2], color: Rgb) {
    let size = at([right - x, bottom - y]);
    let _ = writeln!(out, "{} rg {} {size} re f", ink(color), at([x, y]));
}

/// Appends filled outlines. PDF has cubic curves only: their control points are two thirds of the way to that of a quadratic one.
fn letters(out: &mut String, steps: &[Step]) {
    let mut here = [0.0; 2];
    for step in steps {
        let _ = match *step {
            Step::Move(to) => writeln!(out, "{} m", at(to)),
            Step::Line(to) => writeln!(out, "{} l", at(to)),
            Step::Curve { control, to } => {
                let [one, other] = [here, to]
                    .map(|end| at([0, 1].map(|axis| end[axis] + (control[axis] - end[axis]) * 2.0 / 3.0)));
                writeln!(out, "{one} {other} {} c", at(to))
            }
        };
        let (Step::Move(to) | Step::Line(to) | Step::Curve { to, .. }) = *step;
        here = to;
    }
    if !steps.is_empty() {
        out.push_str("f\n");
    }
}

fn at([x, y]: [f64; 2]) -> String {
    format!("{} {}", number(x), number(y))
}

/// A color as the operands of an operator.
fn ink(color: Rgb) -> String {
    let [red, green, blue] = color.map(|part| number(f64::from(part) / 255.0));
    format!("{red} {green} {blue}")
}

/// Writes a number with three decimals, without zeros at its end. PDF has no exponents.
fn number(number: f64) -> String {
    let text = format!("{number:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg::Anchor;

    fn drawing() -> Drawing {
        let items = vec![
            Item::Line { points: vec![[1.0, 2.0], [3.5, 4.25]], width: 2.0, color: [255, 0, 0] },
            Item::Rectangle { corners: [[10.0, 20.0], [30.0, 60.0]], color: [0, 0, 255] },
            Item::Text {
                at: [50.0, 25.0],
                says: "x".to_owned(),
                anchor: Anchor::Start,
                size: 20.0,
                color: [0; 3],
            },
        ];
        Drawing { size: [100.0, 80.0], background: [255; 3], items }
    }

    #[test]
    fn each_object_begins_where_the_table_says() {
        let pdf = String::from_utf8(drawing().pdf()).unwrap();
        let table = pdf.split_once("\nxref\n").unwrap().1;
        let places: Vec<usize> =
            table.lines().skip(2).take(4).map(|line| line[..10].parse().unwrap()).collect();
        for (index, place) in places.iter().enumerate() {
            assert!(pdf[*place..].starts_with(&format!("{} 0 obj\n", index + 1)), "{index}");
        }
        let start: usize = pdf.split_once("startxref\n").unwrap().1.lines().next().unwrap().parse().unwrap();
        assert!(pdf[start..].starts_with("xref\n0 5\n"));
        let (_, rest) = pdf.split_once("/Length ").unwrap();
        let length: usize = rest.split(' ').next().unwrap().parse().unwrap();
        assert_eq!(&rest[rest.find("stream\n").unwrap() + 7 + length..][..9], "endstream");
    }

    #[test]
    fn lines_rectangles_and_letters_are_paths() {
        let contents = drawing().contents();
        for part in
            ["0.75 0 0 -0.75 0 60 cm", "1 0 0 RG 2 w\n1 2 m\n3.5 4.25 l\nS\n", "0 0 1 rg 10 20 20 40 re f"]
        {
            assert!(contents.contains(part), "{part} is not in {contents}");
        }
        assert!(contents.ends_with("f\n") && contents.matches(" m\n").count() >= 2, "{contents}");
    }
}
