//! What lengths are read from: the scale bar and the grid.

use glam::DVec3;

use super::super::screen::Screen;
use super::super::stage::Scenery;
use super::super::{framing, sdl::Style};
use super::color;
use super::labels::{self, short};
use crate::scene::{Color, GridPlane, Preset, ScaleBar, Scene};

/// The height of the numbers, as part of the picture's height.
const SIZE: f64 = 0.045;
/// The most numbers along an edge of the grid.
const MOST_NUMBERS: f64 = 15.0;
/// The most lines of the grid, each way.
const MOST_LINES: f64 = 400.0;

/// The scale bar and the grid of a scene.
pub(super) struct Rulers {
    style: Style,
    bar: Option<ScaleBar>,
    /// The lines of the grid, which are the same in all frames.
    lines: String,
    /// Its numbers, each with the point that it belongs to and the side of it on which it stands.
    numbers: Vec<(String, DVec3, Beside)>,
    /// The middle of the motion.
    middle: DVec3,
    /// The height of a line of text on the screen.
    height: f64,
    ink: String,
}

/// Where a number or a name stands beside its point.
#[derive(Clone, Copy, PartialEq)]
enum Beside {
    /// A number of the axis to the right.
    Below,
    /// A number of the other axis.
    Left,
    /// The name of the axis to the right, behind its last number.
    End,
    /// The name of the other axis.
    Above,
}

impl Rulers {
    pub(super) fn new(scene: &Scene, scenery: &Scenery, style: Style) -> Rulers {
        let aspect = f64::from(scene.output.height) / f64::from(scene.output.width);
        let mut rulers = Rulers {
            style,
            bar: scene.scale_bar,
            lines: String::new(),
            numbers: Vec::new(),
            middle: (scenery.bounds.min + scenery.bounds.max) / 2.0,
            height: SIZE * 2.0 * aspect,
            ink: color(labels::ink(scene), style),
        };
        if let Some(grid) = scene.grid {
            let spacing = grid.spacing.unwrap_or(scenery.tile);
            let line = line_color(scene);
            rulers.grid(grid.plane, spacing, scenery, &color(line, style));
        }
        rulers
    }

    fn grid(&mut self, plane: GridPlane, spacing: f64, scenery: &Scenery, line: &str) {
        let (min, max) = (scenery.bounds.min / spacing, scenery.bounds.max / spacing);
        // Bodies may reach out a little; and where 0 is near, it is there.
        let (low, high) = ((min + 0.3).floor(), (max - 0.3).ceil());
        let low = glam::DVec3::select(low.cmpgt(DVec3::ZERO) & low.cmple(0.3 * high), DVec3::ZERO, low);
        let mut high = high.max(low + 1.0);
        let mut low = low;
        if plane == GridPlane::Ground {
            // Motion in a plane needs a ground to stand on, too.
            let lacking = (0.4 * (high.x - low.x) - (high.z - low.z)).max(0.0);
            low.z -= (lacking / 2.0).ceil();
            high.z += (lacking / 2.0).ceil();
        }
        if (high - low).max_element() > MOST_LINES {
            return;
        }
        let radius = 0.22 * scenery.stroke;
        // The plane is spanned by two axes; along the third it stays where it is, just before ground or air.
        let (first, second, place) = match plane {
            GridPlane::Ground => (DVec3::X, DVec3::Z, DVec3::Y * scenery.ground),
            GridPlane::Wall => (DVec3::X, DVec3::Y, DVec3::Z * (low.z * spacing)),
        };
        let corner = |a: f64, b: f64| place + (first * a + second * b) * spacing;
        let (a0, a1) = (low.dot(first), high.dot(first));
        let (b0, b1) = (low.dot(second), high.dot(second));
        self.lines.push_str("union { // grid\n");
        // The lines through 0 are the axes.
        let width = |number: f64| if number == 0.0 { 2.2 * radius } else { radius };
        let mut put = |from: DVec3, to: DVec3, radius: f64| {
            self.lines.push_str("  cylinder { ");
            self.style.point(&mut self.lines, from);
            self.lines.push_str(", ");
            self.style.point(&mut self.lines, to);
            self.lines.push_str(", ");
            self.style.length(&mut self.lines, radius);
            self.lines.push_str(" }\n");
        };
        let mut a = a0;
        while a <= a1 {
            put(corner(a, b0), corner(a, b1), width(a));
            a += 1.0;
        }
        let mut b = b0;
        while b <= b1 {
            put(corner(a0, b), corner(a1, b), width(b));
            b += 1.0;
        }
        self.lines.push_str(&format!(
            "  pigment {{ color srgb {line} }} finish {{ ambient 0 diffuse 0 emission 1 }} no_shadow no_reflection\n}}\n"
        ));
        let (front, top, name) = match plane {
            GridPlane::Ground => (b1, b0, "z"),
            GridPlane::Wall => (b0, b1, "y"),
        };
        self.numbers_along((a0, a1), spacing, Beside::Below, |a| corner(a, front));
        self.numbers_along((b0, b1), spacing, Beside::Left, |b| corner(a0, b));
        let (_, symbol) = prefixed(spacing);
        self.numbers.push((format!("{name} ({symbol})"), corner(a0, top), Beside::Above));
        self.numbers.push((format!("x ({symbol})"), corner(a1, front), Beside::End));
    }

    /// Numbers along an edge.
    fn numbers_along(
        &mut self,
        (low, high): (f64, f64),
        spacing: f64,
        beside: Beside,
        at: impl Fn(f64) -> DVec3,
    ) {
        let every = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0];
        let every = every.into_iter().find(|every| (high - low) / every <= MOST_NUMBERS).unwrap_or(100.0);
        let (unit, _) = prefixed(spacing);
        let mut number = (low / every).ceil() * every;
        while number <= high {
            self.numbers.push((value(number * spacing / unit), at(number), beside));
            number += every;
        }
    }

    /// Appends the bar, the lines and the numbers, as a camera sees them.
    pub(super) fn write(&self, out: &mut String, screen: &Screen) {
        out.push_str(&self.lines);
        // The names of the axes come first; what would stand on another is left out.
        let mut placed: Vec<(f64, f64, f64)> = Vec::new();
        for (said, point, beside) in self.numbers.iter().rev() {
            let Some(spot) = screen.spot(*point) else { continue };
            let height = self.height;
            let (x, y, align) = match beside {
                Beside::Below => (spot.x, spot.y - height, 0.5),
                Beside::Left => (spot.x - 0.4 * height, spot.y - 0.3 * height, 1.0),
                Beside::End => (spot.x + 0.8 * height, spot.y - height, 0.0),
                Beside::Above => (spot.x, spot.y + 0.7 * height, 0.5),
            };
            // About half an em a letter.
            #[allow(clippy::cast_precision_loss, reason = "it is a few letters")]
            let half = 0.25 * self.height * (said.chars().count() as f64 + 0.6);
            let middle = x + (1.0 - 2.0 * align) * half;
            let collides = |&(other, at, wide): &(f64, f64, f64)| {
                (middle - other).abs() < half + wide && (y - at).abs() < 0.9 * self.height
            };
            if x.abs() > 1.2 || y.abs() > 1.2 || placed.iter().any(collides) {
                continue;
            }
            placed.push((middle, y, half));
            labels::write(out, said, (&short(x), &short(y)), self.height, align, &self.ink);
            out.push_str(
                " // grid
",
            );
        }
        if let Some(bar) = self.bar {
            self.bar(out, bar, screen);
        }
    }

    fn bar(&self, out: &mut String, bar: ScaleBar, screen: &Screen) {
        let Some(spot) = screen.spot(self.middle) else { return };
        let length =
            bar.length.unwrap_or_else(|| framing::decimal_step(0.5 / spot.metre) * digit(0.5 / spot.metre));
        let width = length * spot.metre;
        let (x, align) = labels::across(bar.corner);
        let left = x - align * width;
        let inset = short(labels::MARGIN + if labels::is_top(bar.corner) { 1.6 } else { 0.25 } * self.height);
        let y = match labels::is_top(bar.corner) {
            true => format!("Screen_top - {inset}"),
            false => format!("{inset} - Screen_top"),
        };
        let (unit, symbol) = prefixed(length);
        let (from, to) = (short(left), short(left + width));
        out.push_str(&format!("Bar(<{from}, {y}, 0>, {to}, {}, {}) // scale bar\n", short(0.005), self.ink));
        let said = format!("{} {symbol}", value(length / unit));
        let above = format!("{y} + {}", short(0.45 * self.height));
        labels::write(out, &said, (&short(left + width / 2.0), &above), self.height, 0.5, &self.ink);
        out.push_str(" // scale bar\n");
    }
}

/// The color of the lines of a grid: seen, and no more than that.
fn line_color(scene: &Scene) -> Color {
    match scene.environment.preset {
        _ if scene.environment.is_dark() => Color([0.34, 0.38, 0.43]),
        Preset::Paper | Preset::Studio => Color([0.70, 0.75, 0.80]),
        _ => Color([0.36, 0.40, 0.46]),
    }
}

/// 1, 2 or 5: the largest that is not larger than a number within its decade.
fn digit(number: f64) -> f64 {
    let rest = number / framing::decimal_step(number) + 1e-9;
    [5.0, 2.0].into_iter().find(|digit| *digit <= rest).unwrap_or(1.0)
}

/// The unit in which a length is written, m, and its symbol.
fn prefixed(length: f64) -> (f64, &'static str) {
    const UNITS: [(f64, &str); 8] = [
        (1e9, "million km"),
        (1e3, "km"),
        (1.0, "m"),
        (1e-2, "cm"),
        (1e-3, "mm"),
        (1e-6, "µm"),
        (1e-9, "nm"),
        (1e-12, "pm"),
    ];
    // Tenths of a metre are more usual than tens of centimetres.
    let fits = |(unit, _): &&(f64, &str)| length >= if *unit == 1.0 { 0.1 } else { unit * 0.999_999 };
    UNITS.iter().find(fits).copied().unwrap_or((1e-12, "pm"))
}

/// A number of a ruler: short, with a real minus sign.
fn value(number: f64) -> String {
    let mut out = String::new();
    super::super::number::write(&mut out, number, 6);
    out.replace('-', "–")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_usual_units() {
        for (length, said) in [
            (2.0, "2 m"),
            (0.5, "0.5 m"),
            (0.05, "5 cm"),
            (2e-9, "2 nm"),
            (5e4, "50 km"),
            (1e11, "100 million km"),
        ] {
            let (unit, symbol) = prefixed(length);
            assert_eq!(format!("{} {symbol}", value(length / unit)), said);
        }
    }
}
