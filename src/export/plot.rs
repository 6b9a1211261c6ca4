//! Writes a plot of a scene as a drawing (SVG), with the curves of the whole run.

use std::borrow::Cow;
use std::io::{self, Write};

use super::ExportError;
use super::format::{Contents, DRAWING, FileKind, Format};
use crate::picture::{PlannedPlot, PlotBar, PlotLine, plot_alone};
use crate::scene::{Color, PlotKind, Scene};
use crate::simulate::{Recorded, Selection};
use crate::svg::{Anchor, HALF_OF_LETTERS, Svg};

/// The width of the drawing, pixels.
const WIDTH: f64 = 800.0;
/// The width of the lines of grid and axes, pixels.
const LINE_WIDTH: f64 = 1.0;
/// The width of the curves, pixels.
const CURVE_WIDTH: f64 = 2.0;
/// The fonts of the texts. Their letters are as wide as those in pictures.
const FONTS: &str = "DejaVu Sans, Verdana, sans-serif";

/// The drawing of the plot of a scene that has this name.
#[derive(Clone, Debug)]
pub struct PlotDrawing(pub String);

impl PlotDrawing {
    /// Returns the index of the plot in a scene.
    fn number(&self, scene: &Scene) -> Option<usize> {
        scene.plots.iter().position(|plot| plot.name == self.0)
    }

    /// Says that a scene does not have the plot, and which ones it has.
    fn unknown(&self, scene: &Scene) -> String {
        let names: Vec<&str> = scene.plots.iter().map(|plot| plot.name.as_str()).collect();
        let known = match names.is_empty() {
            true => "it has none".to_owned(),
            false => format!("it has `{}`", names.join("`, `")),
        };
        format!("the scene has no plot `{}`: {known}", self.0)
    }
}

impl Format for PlotDrawing {
    fn file_kind(&self) -> &'static FileKind {
        &DRAWING
    }

    fn option(&self) -> Option<&'static str> {
        Some("plot")
    }

    fn lack(&self, scene: &Scene) -> Option<Cow<'static, str>> {
        self.number(scene).is_none().then(|| self.unknown(scene).into())
    }

    fn write(
        &self,
        run: &Recorded<'_>,
        _selection: &Selection,
        out: &mut dyn Write,
    ) -> Result<Contents, ExportError> {
        let scene = run.scene();
        let unknown = || io::Error::new(io::ErrorKind::NotFound, self.unknown(scene));
        let number = self.number(scene).ok_or_else(unknown)?;
        let (plot, bars) = plot_alone(scene, run.survey(), number);
        out.write_all(svg(&plot, &bars).as_bytes())?;
        let plot = &scene.plots[number];
        let (count, noun) = match plot.kind {
            PlotKind::Histogram { bins, .. } => (usize::from(bins), "bin"),
            PlotKind::Curves | PlotKind::Bars => (plot.curves.len(), plot.kind.noun()),
        };
        let words = match count {
            1 => format!("1 {noun}"),
            count => format!("{count} {noun}s"),
        };
        Ok(Contents { words, bytes: None, faster: 1.0 })
    }
}

/// Returns a plot as the text of an SVG file.
fn svg(plot: &PlannedPlot, bars: &[PlotBar]) -> String {
    let scale = WIDTH / plot.size[0];
    let high = plot.size[1] * scale;
    let at = |[x, y]: [f64; 2]| [x * scale, high - y * scale];
    let mut svg = Svg::new([WIDTH, high], Color::WHITE.bytes(), FONTS);
    let (axes, grid): (Vec<&PlotLine>, Vec<&PlotLine>) = plot.lines.iter().partition(|line| line.is_axis);
    for line in grid {
        svg.line([line.from, line.to].map(at), LINE_WIDTH, line.color.bytes());
    }
    for bar in bars {
        svg.rectangle([bar.from, bar.to].map(at), bar.color.bytes());
    }
    for line in axes {
        svg.line([line.from, line.to].map(at), LINE_WIDTH, line.color.bytes());
    }
    for curve in &plot.curves {
        for part in curve.points.split(|point| point.at.is_none()).filter(|part| part.len() > 1) {
            svg.line(part.iter().filter_map(|point| point.at.map(at)), CURVE_WIDTH, curve.color.bytes());
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the value of an attribute of an element.
    fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
        let (_, rest) = element.split_once(&format!(" {name}=\"")).unwrap();
        rest.split_once('"').unwrap().0
    }

    /// Returns the points of a line.
    fn points(line: &str) -> Vec<[f64; 2]> {
        let points = attribute(line, "points").split(' ').map(|point| point.split_once(',').unwrap());
        points.map(|(x, y)| [x, y].map(|part| part.parse().unwrap())).collect()
    }

    /// Returns a function from positions along an axis to values, as a reader finds it from the first and the last number at the axis, and the
    /// lines of the grid beside these numbers. The numbers have this anchor, and their positions this attribute.
    fn scale(svg: &str, anchor: &str, position: &str) -> impl Fn(f64) -> f64 {
        let axis = usize::from(position == "y");
        let lines = svg.lines().filter(|line| line.starts_with("<polyline")).map(points);
        let lines = lines.filter(|points| points[0][axis] == points[points.len() - 1][axis]);
        let lines: Vec<f64> = lines.map(|points| points[0][axis]).collect();
        let number = |element: &str| {
            let words = element.split_once('>')?.1.strip_suffix("</text>")?.replace('−', "-");
            let at = attribute(element, position).parse::<f64>().ok()?;
            let line =
                lines.iter().min_by(|one, other| (**one - at).abs().total_cmp(&(**other - at).abs()))?;
            Some((*line, words.parse::<f64>().ok()?))
        };
        let texts = svg.lines().filter(|line| line.starts_with("<text"));
        let numbers = texts.filter(|text| attribute(text, "text-anchor") == anchor).filter_map(number);
        let numbers: Vec<(f64, f64)> = numbers.collect();
        let [first, .., last] = numbers[..] else { panic!("{svg}") };
        move |at: f64| first.1 + (at - first.0) * (last.1 - first.1) / (last.0 - first.0)
    }

    /// A ball falls 5 t² metres in t seconds. Read by the numbers at the axes, each point of the curve says so.
    #[test]
    fn the_curve_of_a_fall_is_read_from_the_drawing() {
        let text = "simulation = { duration = 2, gravity = [0, -10, 0], integrator = 'velocity-verlet' }
            [body.ball]\nshape.sphere.radius = 0.5\n[plot.other]\ny = 'ball.vy'\n[plot.fall]\ny = 'ball.y'\n";
        let scene = Scene::parse(text).unwrap();
        let run = Recorded::new(&scene).unwrap();
        let mut bytes = Vec::new();
        let fall = PlotDrawing("fall".to_owned());
        assert_eq!(fall.lack(&scene), None);
        let contents = fall.write(&run, &Selection::first(1), &mut bytes).unwrap();
        assert_eq!(contents.words, "1 curve");
        let svg = String::from_utf8(bytes).unwrap();
        let [time, height] = [scale(&svg, "middle", "x"), scale(&svg, "end", "y")];
        let is_curve = |line: &&str| line.starts_with("<polyline") && attribute(line, "stroke-width") == "2";
        let curves: Vec<&str> = svg.lines().filter(is_curve).collect();
        let [curve] = curves[..] else { panic!("{svg}") };
        let points: Vec<[f64; 2]> = points(curve).into_iter().map(|[x, y]| [time(x), height(y)]).collect();
        assert!(points.len() > 10, "{points:?}");
        let [[begin, top], .., [end, bottom]] = points[..] else { panic!("{points:?}") };
        for (found, expected) in [(begin, 0.0), (top, 0.0), (end, 2.0), (bottom, -20.0)] {
            assert!((found - expected).abs() < 0.01, "{points:?}");
        }
        for [t, y] in points {
            assert!((y + 5.0 * t * t).abs() < 0.01, "{y} at {t}");
        }
    }

    #[test]
    fn a_plot_that_the_scene_does_not_have_is_lacking() {
        let plot = "y = 't'\n";
        let scene =
            Scene::parse(&format!("[body.b]\nshape.sphere.radius = 1\n[plot.a]\n{plot}[plot.b]\n{plot}"))
                .unwrap();
        let lack = PlotDrawing("c".to_owned()).lack(&scene);
        assert_eq!(lack.as_deref(), Some("the scene has no plot `c`: it has `a`, `b`"));
        let run = Recorded::new(&scene).unwrap();
        let written = PlotDrawing("c".to_owned()).write(&run, &Selection::first(1), &mut Vec::new());
        assert!(matches!(written, Err(ExportError::Io(error)) if error.kind() == io::ErrorKind::NotFound));
    }
}
