//! Writes a plot of a scene as a drawing (SVG), with the curves of the whole run.

use std::io::Write;

use super::ExportError;
use super::format::{Contents, DRAWING, FileKind, Format};
use crate::picture::{PlannedPlot, plot_alone};
use crate::scene::Color;
use crate::simulate::{Recorded, Selection};
use crate::svg::{Anchor, HALF_OF_LETTERS, Svg};

/// The width of the drawing, pixels.
const WIDTH: f64 = 800.0;
/// The width of the lines of grid and axes, pixels.
const RULED: f64 = 1.0;
/// The width of the curves, pixels.
const DRAWN: f64 = 2.0;
/// The fonts of the texts. Their letters are as wide as those in pictures.
const FONTS: &str = "DejaVu Sans, Verdana, sans-serif";

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
    let at = |[x, y]: [f64; 2]| [x * scale, high - y * scale];
    let mut svg = Svg::new([WIDTH, high], Color::WHITE.bytes(), FONTS);
    for line in &plot.lines {
        svg.line([line.from, line.to].map(at), RULED, line.color.bytes());
    }
    for curve in &plot.curves {
        for part in curve.points.split(|point| point.at.is_none()).filter(|part| part.len() > 1) {
            svg.line(part.iter().filter_map(|point| point.at.map(at)), DRAWN, curve.color.bytes());
        }
    }
    let bottom = plot.bottom.above_middle(1.0);
    for text in &plot.texts {
        let middle = text.y.above_middle(1.0) + HALF_OF_LETTERS * text.height;
        let anchor = match text.align {
            0.0 => Anchor::Start,
            1.0 => Anchor::End,
            _ => Anchor::Middle,
        };
        let place = at([text.x - plot.left, middle - bottom]);
        svg.text(place, &text.says, anchor, text.height * scale, text.color.bytes());
    }
    svg.finish()
}
