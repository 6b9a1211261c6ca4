//! Writes texts and the scale bar on the image plane in front of the camera, in SDL.

use super::super::{sdl::Style, text};
use super::color;
use crate::picture::{Bar, Screen, Text, Vertical, number};

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
    label(out, ("Label", text), &height(text.y, digits), style);
}

/// Appends a text on the panel of a plot.
pub(super) fn write_on_panel(out: &mut String, text: &Text<'_>, style: Style) {
    label(out, ("Word", text), &height(text.y, short), style);
}

/// Appends the scale bar and its number.
pub(super) fn write_bar(out: &mut String, bar: &Bar, number: &Text<'_>, style: Style) {
    let y = height(bar.y, short);
    let (from, to, thickness) = (short(bar.from), short(bar.to), length(bar.thickness));
    let ink = color(bar.color, style);
    out.push_str(&format!("Bar(<{from}, {y}, 0>, {to}, {thickness}, {ink}) // scale bar\n"));
    label(out, ("Label", number), &format!("{y} + {}", length(bar.above)), style);
}

fn label(out: &mut String, (of, text): (&str, &Text<'_>), y: &str, style: Style) {
    // POV-Ray refuses an empty text, so a dash replaces it.
    let said = if text.says.trim().is_empty() { "-" } else { &text.says };
    let said = text::string(said);
    let (x, height, align) = (short(text.x), length(text.height), short(text.align));
    let (ink, name) = (color(text.color, style), text::comment(text.name));
    out.push_str(&format!("{of}(\"{said}\", <{x}, {y}, 0>, {height}, {align}, {ink}) // {name}\n"));
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
