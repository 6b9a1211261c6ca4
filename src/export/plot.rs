//! Writes a plot of a scene as a drawing (SVG, PNG or PDF), with the curves of the whole run, or the bars of its last moment, or as a table of
//! its values.

use std::borrow::Cow;
use std::io::{self, Write};

use super::ExportError;
use super::format::{Contents, DRAWING, FileKind, Format, IMAGE, PAGE, TABLE};
use super::plot_values;
use crate::diagnostic::nearest;
use crate::drawing::{Drawing, Item};
use crate::picture::{PlannedPlot, PlotBar, PlotLine, plot_alone};
use crate::scene::{Color, PlotKind, Scene};
use crate::simulate::{Recorded, Selection};
use crate::svg::{Anchor, HALF_OF_LETTERS};

/// The width of the drawing, pixels.
const PLOT_WIDTH: f64 = 800.0;
/// The width of the lines of grid and axes, pixels.
const LINE_WIDTH: f64 = 1.0;
/// The width of the curves, pixels.
const CURVE_WIDTH: f64 = 2.0;
/// The fonts of the texts. Their letters are as wide as those in pictures.
const FONTS: &str = "DejaVu Sans, Verdana, sans-serif";

/// The drawing of a plot of a scene.
#[derive(Clone, Debug)]
pub struct PlotDrawing {
    /// The name of the plot.
    pub name: String,
    /// The kind of the file.
    pub file: PlotFile,
}

/// A kind of file that a plot can be written to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlotFile {
    /// Lines and letters in SVG.
    Svg,
    /// An image in PNG.
    Png {
        /// The width of the image, pixels.
        width: u32,
    },
    /// Lines and letters on a page in PDF.
    Pdf,
    /// A table of the values in each frame.
    Csv,
}

impl PlotFile {
    /// The usual width of an image, pixels.
    pub const USUAL_WIDTH: u32 = 1600;
    /// The largest width of an image, pixels.
    pub const MAX_WIDTH: u32 = 10_000;
}

impl PlotDrawing {
    /// Returns the index of the plot in a scene.
    fn number(&self, scene: &Scene) -> Option<usize> {
        scene.plots.iter().position(|plot| plot.name == self.name)
    }

    /// Says that a scene does not have the plot, and which ones it has. `None` if it has the plot.
    pub fn unknown(&self, scene: &Scene) -> Option<String> {
        let names = || scene.plots.iter().map(|plot| plot.name.as_str());
        if self.number(scene).is_some() {
            return None;
        }
        let known = match nearest(&self.name, names()) {
            _ if scene.plots.is_empty() => "it has none".to_owned(),
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("it has `{}`", names().collect::<Vec<_>>().join("`, `")),
        };
        Some(format!("the scene has no plot `{}`: {known}", self.name))
    }
}

impl Format for PlotDrawing {
    fn file_kind(&self) -> &'static FileKind {
        match self.file {
            PlotFile::Svg => &DRAWING,
            PlotFile::Png { .. } => &IMAGE,
            PlotFile::Pdf => &PAGE,
            PlotFile::Csv => &TABLE,
        }
    }

    fn option(&self) -> Option<&'static str> {
        Some("plot")
    }

    fn lack(&self, scene: &Scene) -> Option<Cow<'static, str>> {
        self.unknown(scene).map(Cow::from)
    }

    fn write(
        &self,
        run: &Recorded<'_>,
        selection: &Selection,
        out: &mut dyn Write,
    ) -> Result<Contents, ExportError> {
        let scene = run.scene();
        let unknown = || io::Error::new(io::ErrorKind::NotFound, self.unknown(scene).unwrap_or_default());
        let number = self.number(scene).ok_or_else(unknown)?;
        let (plot, bars) = plot_alone(scene, run.survey(), number);
        let drawing = drawing(&plot, &bars);
        let bytes = match self.file {
            PlotFile::Svg => drawing.svg(FONTS).into_bytes(),
            PlotFile::Png { width } => drawing.png(width).map_err(io::Error::from)?,
            PlotFile::Pdf => drawing.pdf(),
            PlotFile::Csv => {
                let rows = plot_values::write(run, number, selection, out)?;
                return Ok(Contents::of_rows(rows, &format!("the plot {}", self.name), run, selection));
            }
        };
        out.write_all(&bytes)?;
        let plot = &scene.plots[number];
        let (count, noun) = match plot.kind {
            PlotKind::Histogram { bins, .. } => (usize::from(bins), "bin"),
            PlotKind::Curves | PlotKind::Bars { .. } => (plot.curves.len(), plot.kind.noun()),
        };
        let words = match count {
            1 => format!("1 {noun}"),
            count => format!("{count} {noun}s"),
        };
        Ok(Contents { words, bytes: None, faster: 1.0 })
    }
}

/// Returns a plot as a drawing.
fn drawing(plot: &PlannedPlot, bars: &[PlotBar]) -> Drawing {
    let scale = PLOT_WIDTH / plot.size[0];
    let high = plot.size[1] * scale;
    let at = |[x, y]: [f64; 2]| [x * scale, high - y * scale];
    let rule = |line: &PlotLine| {
        let points = vec![at(line.from), at(line.to)];
        Item::Line { points, width: LINE_WIDTH, color: line.color.bytes() }
    };
    let (axes, grid): (Vec<&PlotLine>, Vec<&PlotLine>) = plot.lines.iter().partition(|line| line.is_axis);
    let mut items: Vec<Item> = grid.into_iter().map(rule).collect();
    items.extend(
        bars.iter()
            .map(|bar| Item::Rectangle { corners: [at(bar.from), at(bar.to)], color: bar.color.bytes() }),
    );
    items.extend(axes.into_iter().map(rule));
    for curve in &plot.curves {
        for part in curve.points.split(|point| point.at.is_none()).filter(|part| part.len() > 1) {
            let points = part.iter().filter_map(|point| point.at.map(at)).collect();
            items.push(Item::Line { points, width: CURVE_WIDTH, color: curve.color.bytes() });
        }
    }
    let bottom = plot.bottom.above_middle(1.0);
    items.extend(plot.texts.iter().map(|text| {
        let middle = text.y.above_middle(1.0) + HALF_OF_LETTERS * text.height;
        Item::Text {
            at: at([text.x - plot.left, middle - bottom]),
            says: text.says.to_string(),
            anchor: match text.align {
                0.0 => Anchor::Start,
                1.0 => Anchor::End,
                _ => Anchor::Middle,
            },
            size: text.height * scale,
            color: text.color.bytes(),
        }
    }));
    Drawing { size: [PLOT_WIDTH, high], background: Color::WHITE.bytes(), items }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawing_of(name: &str, file: PlotFile) -> PlotDrawing {
        PlotDrawing { name: name.to_owned(), file }
    }

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
        let fall = drawing_of("fall", PlotFile::Svg);
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
        let lack = drawing_of("speed", PlotFile::Pdf).lack(&scene);
        assert_eq!(lack.as_deref(), Some("the scene has no plot `speed`: it has `a`, `b`"));
        let run = Recorded::new(&scene).unwrap();
        let written = drawing_of("speed", PlotFile::Pdf).write(&run, &Selection::first(1), &mut Vec::new());
        assert!(matches!(written, Err(ExportError::Io(error)) if error.kind() == io::ErrorKind::NotFound));
    }

    /// The image and the page have what the drawing has: in the image, a pixel of the middle of each bar has its color, and the bar of −2
    /// goes down from the same line as that of 4 goes up.
    #[test]
    fn bars_are_pixels_of_the_image() {
        let text = "simulation.duration = 1\n[body.ball]\nshape.sphere.radius = 0.5
            [plot.p]\nbars = ['4*t', '-2*t', '0*t']\nnames = ['up', 'down', 'none']\nrange = [-4, 4]";
        let scene = Scene::parse(text).unwrap();
        let run = Recorded::new(&scene).unwrap();
        let mut bytes = Vec::new();
        let contents =
            drawing_of("p", PlotFile::Png { width: 400 }).write(&run, &Selection::first(1), &mut bytes);
        assert_eq!(contents.unwrap().words, "3 bars");
        let mut image = png::Decoder::new(io::Cursor::new(bytes)).read_info().unwrap();
        let mut rgb = vec![0; image.output_buffer_size().unwrap()];
        let size = image.next_frame(&mut rgb).unwrap();
        let (plot, bars) = plot_alone(&scene, run.survey(), 0);
        assert!(size.width == 400 && bars.len() == 2 && bars[0].from[1] == bars[1].to[1]);
        let scale = 400.0 / plot.size[0];
        for bar in bars {
            let [x, y] = [0, 1].map(|axis| (bar.from[axis] + bar.to[axis]) / 2.0 * scale);
            let place = 3 * (400 * (f64::from(size.height) - y) as usize + x as usize);
            assert_eq!(rgb[place..place + 3], bar.color.bytes());
        }
        let mut page = Vec::new();
        drawing_of("p", PlotFile::Pdf).write(&run, &Selection::first(1), &mut page).unwrap();
        let page = String::from_utf8(page).unwrap();
        assert!(
            page.starts_with("%PDF-1.4\n")
                && page.matches(" re\n").count() + page.matches(" re f\n").count() == 3
        );
    }
}
