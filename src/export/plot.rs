//! Writes a plot of a scene as a drawing (SVG), with the curves of the whole run.

use std::fmt::Write as _;
use std::io::Write;

use super::ExportError;
use super::format::{Contents, DRAWING, FileKind, Format};
use crate::lettering::{self, Level};
use crate::picture::{PlannedPlot, plot_alone};
use crate::report::plot::escaped;
use crate::scene::Color;
use crate::simulate::{Recorded, Selection};

/// The width of the drawing, pixels.
const WIDTH: f64 = 800.0;

/// The drawing of a plot, given by its index in the scene.
#[derive(Clone, Copy, Debug)]
pub struct PlotDrawing(pub usize);

impl Format for PlotDrawing {
    fn file_kind(&self) -> &'static FileKind {
        &DRAWING
    }

    fn option(&self) -> Option<&'static str> {
        Some("plot")
    }

    fn write(
        &self,
        run: &Recorded<'_>,
        _selection: &Selection,
        out: &mut dyn Write,
    ) -> Result<Contents, ExportError> {
        let plot = plot_alone(run.scene(), run.survey(), self.0);
        let curves = plot.curves.len();
        out.write_all(svg(&plot).as_bytes())?;
        let noun = if curves == 1 { "curve" } else { "curves" };
        Ok(Contents { words: format!("{curves} {noun}"), bytes: None, faster: 1.0 })
    }
}

/// Returns a plot as the text of an SVG file.
fn svg(plot: &PlannedPlot) -> String {
    let scale = WIDTH / plot.size[0];
    let high = plot.size[1] * scale;
    let at = |[x, y]: [f64; 2]| format!("{:.2},{:.2}", x * scale, high - y * scale);
    let bottom = plot.bottom.above_middle(1.0);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{high:.0}\" viewBox=\"0 0 {WIDTH} {high:.2}\" \
         font-family=\"DejaVu Sans, Verdana, sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
    );
    // Writing to a string cannot fail.
    for line in &plot.lines {
        let (points, color) = ([line.from, line.to].map(at).join(" "), hex(line.color));
        let _ = writeln!(out, "<polyline points=\"{points}\" stroke=\"{color}\"/>");
    }
    for curve in &plot.curves {
        for part in curve.points.split(|point| point.at.is_none()).filter(|part| part.len() > 1) {
            let points: Vec<String> = part.iter().filter_map(|point| point.at.map(at)).collect();
            let _ = writeln!(
                out,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-linejoin=\"round\"/>",
                points.join(" "),
                hex(curve.color)
            );
        }
    }
    for text in &plot.texts {
        let place = [text.x - plot.left, text.y.above_middle(1.0) - bottom];
        let (x, y) = (place[0] * scale, high - place[1] * scale);
        let anchor = match text.align {
            0.0 => "start",
            1.0 => "end",
            _ => "middle",
        };
        let (size, color, words) =
            (text.height * scale, hex(text.color), words(&text.says, text.height * scale));
        let _ = writeln!(
            out,
            "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{size:.2}\" text-anchor=\"{anchor}\" fill=\"{color}\">{words}</text>"
        );
    }
    out.push_str("</svg>\n");
    out
}

/// Returns the words of a text as the contents of an SVG element, with smaller letters for subscripts and superscripts.
fn words(text: &str, size: f64) -> String {
    let mut out = String::new();
    let mut risen = 0.0;
    for run in lettering::runs(text) {
        let (letters, rise) = (escaped(run.letters), run.level.rise() * size);
        let down = risen - rise;
        risen = rise;
        // Writing to a string cannot fail.
        let _ = match (run.level, down == 0.0) {
            (Level::Line, true) => write!(out, "{letters}"),
            (Level::Line, false) => write!(out, "<tspan dy=\"{down:.2}\">{letters}</tspan>"),
            (level, _) => {
                let small = level.size() * size;
                write!(out, "<tspan dy=\"{down:.2}\" font-size=\"{small:.2}\">{letters}</tspan>")
            }
        };
    }
    out
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the parts of a color are from 0 to 1"
)]
fn hex(Color(parts): Color) -> String {
    let [red, green, blue] = parts.map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8);
    format!("#{red:02x}{green:02x}{blue:02x}")
}
