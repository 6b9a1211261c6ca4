//! The grid: lines with numbers, to read lengths from.

use glam::DVec3;

use super::length::{prefixed, value};
use super::screen::Screen;
use super::stage::Scenery;
use super::text::{MARGIN, Text, Vertical, least_height, width};
use crate::scene::{self, Color, GridPlane, Preset, Scene};
use crate::simulate::Bounds;

/// The height of the numbers of rulers, as part of the picture's height.
pub(super) const SIZE: f64 = 0.045;
/// The least height of these numbers, pixels.
pub(super) const LEAST_PIXELS: f64 = 11.0;
/// The most lines of the grid, each way.
const MOST_LINES: f64 = 400.0;
/// Numbers stand at every line, every second, every fifth and so on, as there is room.
const STEPS: [f64; 9] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0];
/// The radius of a line, in strokes.
const RADIUS: f64 = 0.22;
/// The least radius of a line, pixels: thinner lines break up.
const LEAST_RADIUS: f64 = 0.6;

/// The lines of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The lines, first those that are crossed by the axis to the right.
    pub lines: Vec<Line>,
    /// Their color.
    pub color: Color,
}

/// A line of a grid: a cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Where it begins, m.
    pub from: DVec3,
    /// Where it ends, m.
    pub to: DVec3,
    /// Half its width, m.
    pub radius: f64,
}

/// What is known of a grid before its picture: where its plane is, and how far it extends.
#[derive(Clone, Debug)]
pub(super) struct Ruler {
    plane: GridPlane,
    /// The distance between lines, m.
    spacing: f64,
    /// The spacing that the scene gives, m, if it would make too many lines.
    too_fine: Option<f64>,
    /// The numbers of the first and the last lines along x, y and z, counted from the origin.
    low: DVec3,
    high: DVec3,
    /// The height of the ground, m.
    ground: f64,
    /// The height of a line of text on the screen.
    height: f64,
    /// The width of the image, pixels, and its height as part of its width.
    pixels: f64,
    aspect: f64,
    color: Color,
    ink: Color,
}

/// A grid with its numbers.
#[derive(Clone, Debug)]
pub(super) struct Ruled {
    grid: Grid,
    /// The numbers of both axes.
    axes: [Axis; 2],
    /// The height of a line of text on the screen.
    height: f64,
    aspect: f64,
    ink: Color,
}

/// The numbers along one edge of a grid.
#[derive(Clone, Debug)]
struct Axis {
    /// On which side of their points they stand.
    beside: Beside,
    /// Each with the number of its line and with its point.
    numbers: Vec<(f64, String, DVec3)>,
    /// The name of the axis, and where it stands.
    title: (String, DVec3),
}

/// Where a number or a name stands beside its point.
#[derive(Clone, Copy, Debug, PartialEq)]
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

impl Ruler {
    /// The grid of a scene. A camera that moves sees only a width of `part` (m) of it.
    pub(super) fn new(
        scene: &Scene,
        grid: scene::Grid,
        scenery: &Scenery,
        part: Option<f64>,
        ink: Color,
    ) -> Ruler {
        let (width, height) = (f64::from(scene.output.width), f64::from(scene.output.height));
        let given = grid.spacing.unwrap_or(scenery.tile);
        let whole = (scenery.bounds.max - scenery.bounds.min).max_element();
        let extent = part.unwrap_or(whole);
        let coarser = |spacing: &f64| extent / spacing <= MOST_LINES - 4.0;
        let spacing = if coarser(&given) {
            given
        } else {
            let decade = super::decimal_step(extent / (MOST_LINES - 4.0));
            [2.0, 5.0, 10.0].map(|digit| digit * decade).into_iter().find(coarser).unwrap_or(scenery.tile)
        };
        let (low, high) = extent_in_lines(grid.plane, scenery.bounds, spacing);
        Ruler {
            plane: grid.plane,
            spacing,
            too_fine: (spacing > given).then_some(given),
            low,
            high,
            ground: scenery.ground,
            height: (SIZE * 2.0 * height / width).max(least_height(LEAST_PIXELS, scene.output)),
            pixels: width,
            aspect: height / width,
            color: line_color(scene),
            ink,
        }
    }

    /// The spacing that the scene gives and the one that is drawn, m, if the first would make too many lines.
    pub(super) fn too_fine(&self) -> Option<(f64, f64)> {
        self.too_fine.map(|given| (given, self.spacing))
    }

    /// The box around the whole grid, m.
    pub(super) fn bounds(&self) -> Bounds {
        let (first, second, place) = self.axes();
        let corner =
            |number: DVec3| place + (first * number.dot(first) + second * number.dot(second)) * self.spacing;
        Bounds { min: corner(self.low), max: corner(self.high) }
    }

    /// The axes that span the plane, and a point of it. It stays where it is along the third: just before ground or air.
    fn axes(&self) -> (DVec3, DVec3, DVec3) {
        match self.plane {
            GridPlane::Ground => (DVec3::X, DVec3::Z, DVec3::Y * self.ground),
            GridPlane::Wall => (DVec3::X, DVec3::Y, DVec3::Z * (self.low.z * self.spacing)),
        }
    }

    /// The whole grid with its numbers, in a picture where a stroke is so wide and the camera sees a width of `view`, m.
    pub(super) fn whole(&self, stroke: f64, view: f64) -> Ruled {
        self.rule(self.low, self.high, stroke, view)
    }

    /// The part of the grid that a camera sees which looks at a point and moves.
    pub(super) fn around(&self, point: DVec3, stroke: f64, view: f64) -> Ruled {
        // In front, the ground leaves the picture soon; behind, the horizon is near.
        let window = match self.plane {
            GridPlane::Ground => [DVec3::new(0.36, 0.0, 0.30), DVec3::new(0.36, 0.0, 0.13)],
            GridPlane::Wall => {
                let up = 0.38 * self.aspect;
                [DVec3::new(0.38, up, 0.0), DVec3::new(0.38, up, 0.0)]
            }
        };
        let (first, second, _) = self.axes();
        let spanned = first + second;
        let low = ((point - window[0] * view) / self.spacing).ceil() * spanned;
        let high = ((point + window[1] * view) / self.spacing).floor() * spanned;
        let rest = DVec3::ONE - spanned;
        let low = low.clamp(self.low, self.high) * spanned + self.low * rest;
        let high = high.clamp(self.low, self.high) * spanned + self.high * rest;
        self.rule(low, high.max(low), stroke, view)
    }

    fn rule(&self, low: DVec3, high: DVec3, stroke: f64, view: f64) -> Ruled {
        let spacing = self.spacing;
        let (first, second, place) = self.axes();
        let radius = (RADIUS * stroke).max(LEAST_RADIUS * view / self.pixels);
        let corner = |a: f64, b: f64| place + (first * a + second * b) * spacing;
        let (a0, a1) = (low.dot(first), high.dot(first));
        let (b0, b1) = (low.dot(second), high.dot(second));
        // The lines through 0 are the axes.
        let width = |number: f64| if number == 0.0 { 2.2 * radius } else { radius };
        let mut lines = Vec::new();
        let mut put = |from: DVec3, to: DVec3, radius: f64| {
            if from != to {
                lines.push(Line { from, to, radius });
            }
        };
        for a in marks(a0, a1) {
            put(corner(a, b0), corner(a, b1), width(a));
        }
        for b in marks(b0, b1) {
            put(corner(a0, b), corner(a1, b), width(b));
        }
        let (front, top, name) = match self.plane {
            GridPlane::Ground => (b1, b0, "z"),
            GridPlane::Wall => (b0, b1, "y"),
        };
        let (_, symbol) = prefixed(spacing);
        let right = Axis {
            beside: Beside::Below,
            numbers: self.numbers((a0, a1), |a| corner(a, front)),
            title: (format!("x ({symbol})"), corner(a1, front)),
        };
        let other = Axis {
            beside: Beside::Left,
            numbers: self.numbers((b0, b1), |b| corner(a0, b)),
            title: (format!("{name} ({symbol})"), corner(a0, top)),
        };
        Ruled {
            grid: Grid { lines, color: self.color },
            axes: [right, other],
            height: self.height,
            aspect: self.aspect,
            ink: self.ink,
        }
    }

    /// The numbers along an edge.
    fn numbers(&self, (low, high): (f64, f64), at: impl Fn(f64) -> DVec3) -> Vec<(f64, String, DVec3)> {
        let (unit, _) = prefixed(self.spacing);
        let mut numbers = Vec::new();
        for number in marks(low, high) {
            numbers.push((number, value(number * self.spacing / unit), at(number)));
        }
        numbers
    }
}

/// The first and the last lines of a grid that is drawn where everything takes place.
fn extent_in_lines(plane: GridPlane, bounds: Bounds, spacing: f64) -> (DVec3, DVec3) {
    // Bodies may reach out a little; and where 0 is near, it is there.
    let (low, high) = ((bounds.min / spacing + 0.3).floor(), (bounds.max / spacing - 0.3).ceil());
    let mut low = DVec3::select(low.cmpgt(DVec3::ZERO) & low.cmple(0.3 * high), DVec3::ZERO, low);
    let mut high = high.max(low + 1.0);
    // Motion along a line needs a plane to be seen in: at least 0.4 times as wide as long.
    let widen = |low: &mut f64, high: &mut f64, least: f64| {
        let lacking = (least - (*high - *low)).max(0.0);
        *low -= (lacking / 2.0).ceil();
        *high += (lacking / 2.0).ceil();
    };
    let [x, y, z] = (high - low).to_array();
    match plane {
        GridPlane::Ground => {
            widen(&mut low.x, &mut high.x, 0.4 * z);
            widen(&mut low.z, &mut high.z, 0.4 * x);
        }
        GridPlane::Wall => widen(&mut low.x, &mut high.x, 0.4 * y),
    }
    (low, high)
}

/// A text that has its place, without its color: its base line begins at x; how wide it is.
struct Placed {
    says: String,
    x: f64,
    y: f64,
    align: f64,
    middle: f64,
    half: f64,
}

impl Ruled {
    /// The lines.
    pub(super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The numbers as they stand on the plane before a camera.
    pub(super) fn numbers(&self, screen: &Screen) -> Vec<Text<'static>> {
        let mut placed: Vec<Placed> = Vec::new();
        for axis in &self.axes {
            let (says, point) = &axis.title;
            let beside = if axis.beside == Beside::Below { Beside::End } else { Beside::Above };
            placed.extend(self.place(says, *point, beside, screen).map(|text| self.kept_inside(text)));
        }
        for axis in &self.axes {
            let every = |step: f64| {
                let numbers = axis.numbers.iter().filter(move |(number, _, _)| number % step == 0.0);
                let placed = numbers.filter_map(|(_, says, at)| self.place(says, *at, axis.beside, screen));
                placed.filter(|text| self.is_inside(text)).collect::<Vec<_>>()
            };
            let fits = |texts: &Vec<Placed>| !texts.windows(2).any(|pair| self.collide(&pair[0], &pair[1]));
            let numbers = STEPS.into_iter().map(every).find(fits).unwrap_or_default();
            // What would stand on a name, or on a number of the other axis, is left out.
            for number in numbers {
                if !placed.iter().any(|other| self.collide(other, &number)) {
                    placed.push(number);
                }
            }
        }
        let text = |Placed { says, x, y, align, .. }: Placed| Text {
            name: "grid",
            says: says.into(),
            x,
            y: Vertical::Middle(y),
            height: self.height,
            align,
            color: self.ink,
        };
        placed.into_iter().map(text).collect()
    }

    fn place(&self, says: &str, point: DVec3, beside: Beside, screen: &Screen) -> Option<Placed> {
        let spot = screen.spot(point)?;
        let height = self.height;
        let (x, y, align) = match beside {
            Beside::Below => (spot.x, spot.y - height, 0.5),
            Beside::Left => (spot.x - 0.4 * height, spot.y - 0.3 * height, 1.0),
            Beside::End => (spot.x + 0.8 * height, spot.y - height, 0.0),
            Beside::Above => (spot.x, spot.y + 0.7 * height, 0.5),
        };
        let half = width(says, height) / 2.0;
        Some(Placed { says: says.to_owned(), x, y, align, middle: x + (1.0 - 2.0 * align) * half, half })
    }

    /// A name that would leave the picture, moved to its edge.
    fn kept_inside(&self, text: Placed) -> Placed {
        let room = (1.0 - MARGIN / 2.0 - text.half).max(0.0);
        let high = self.aspect - self.height;
        let middle = text.middle.min(room).max(-room);
        let y = text.y.min(high.max(0.0)).max(0.3 * self.height - self.aspect);
        Placed { x: text.x + middle - text.middle, middle, y, ..text }
    }

    fn is_inside(&self, text: &Placed) -> bool {
        let above = text.y + 0.7 * self.height;
        text.middle.abs() + text.half < 1.0 && text.y > -self.aspect && above < self.aspect
    }

    fn collide(&self, a: &Placed, b: &Placed) -> bool {
        (a.middle - b.middle).abs() < a.half + b.half + 0.3 * self.height
            && (a.y - b.y).abs() < 0.9 * self.height
    }
}

/// The whole numbers from `low` to `high`. They are counted: far from 0, the sum of a number and 1 is that number.
fn marks(low: f64, high: f64) -> impl Iterator<Item = f64> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "what is too large is cut")]
    let last = (high - low).min(MOST_LINES) as u32;
    (0..=last).map(move |number| low + f64::from(number)).filter(move |mark| *mark <= high)
}

/// The color of the lines of a grid: seen, and no more than that.
fn line_color(scene: &Scene) -> Color {
    match scene.environment.preset {
        _ if scene.environment.is_dark() => Color([0.34, 0.38, 0.43]),
        Preset::Paper | Preset::Studio => Color([0.70, 0.75, 0.80]),
        _ => Color([0.36, 0.40, 0.46]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_end_also_where_one_more_makes_no_difference() {
        assert_eq!(marks(-1.0, 2.0).collect::<Vec<_>>(), [-1.0, 0.0, 1.0, 2.0]);
        assert!(marks(1e16, 1e16 + 2.0).count() <= 3);
        assert!(marks(1e300, 2e300).count() <= 402);
        assert_eq!(marks(f64::NAN, 1.0).count(), 0);
    }
}
