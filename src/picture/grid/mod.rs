//! The grid: lines with numbers, to read positions from.

mod numbers;

use glam::DVec3;

use self::numbers::{Axis, Beside, Number};
use super::camera::Placed;
use super::length::{prefixed, value};
use super::stage::Scenery;
use super::text::usual_height;
use super::thing::{Form, Line, Thing};
use crate::decimal::round_above;
use crate::scene::{self, Color, DecimalSign, GridPlane, Preset, Scene};
use crate::simulate::{Bounds, anchors};

pub(super) use self::numbers::GridLayout;

/// The height of the numbers at grid lines, relative to the shorter side of the picture.
pub(super) const SIZE: f64 = 0.045;
/// The smallest height of the numbers at grid lines, pixels.
pub(super) const LEAST_PIXELS: f64 = 11.0;
/// The largest number of grid lines in each direction.
const MOST_LINES: f64 = 400.0;
/// The radius of a grid line, in strokes. A stroke is the width of a clearly visible line.
const RADIUS: f64 = 0.22;
/// The smallest radius of a grid line, pixels: thinner lines look broken.
const LEAST_RADIUS: f64 = 0.6;
/// The extent of a grid in each direction from the aim of a moving camera, in widths of the picture.
const WINDOW: f64 = 1.5;

/// The plane, the spacing and the extent of a grid. [`GridLayout`] is the grid laid out for a camera.
#[derive(Clone, Debug)]
pub(super) struct GridPlan {
    plane: GridPlane,
    /// The distance between two lines, m.
    spacing: f64,
    /// The spacing that the scene gives, m, if the drawn spacing is larger because there would be too many lines.
    too_fine: Option<f64>,
    /// The indices of the first and the last lines along x, y and z. The line with index n is n spacings from the origin.
    low: DVec3,
    high: DVec3,
    /// The height of the ground, m.
    ground: f64,
    /// The height below which the ground hides an upright grid, m. −∞ if it hides nothing.
    floor: f64,
    /// The height of a line of text in the image plane.
    height: f64,
    /// The width of the image, pixels, and its height relative to its width.
    pixels: f64,
    aspect: f64,
    color: Color,
    ink: Color,
    sign: DecimalSign,
}

impl GridPlan {
    /// Plans the grid of a scene. `part` is the width in view of a moving camera, m; `None` for a fixed camera.
    pub(super) fn new(
        scene: &Scene,
        grid: scene::Grid,
        scenery: &Scenery,
        part: Option<f64>,
        ink: Color,
    ) -> GridPlan {
        let (width, height) = (f64::from(scene.output.width), f64::from(scene.output.height));
        let given = grid.spacing.unwrap_or(scenery.spacing);
        let whole = (scenery.bounds.max - scenery.bounds.min).max_element();
        let extent = part.map_or(whole, |part| (2.0 * WINDOW * part).min(whole));
        let spacing = if extent / given <= MOST_LINES - 4.0 {
            given
        } else {
            let round = round_above(extent / (MOST_LINES - 4.0));
            if round.is_finite() { round } else { scenery.spacing }
        };
        let point = |point: DVec3| Bounds { min: point, max: point };
        let bounds = anchors(scene).map(point).fold(scenery.bounds, Bounds::union);
        let (low, high) = extent_in_lines(grid.plane, bounds, spacing);
        let has_ground = scene.environment.ground.is_some() && !scene.output.transparent;
        let is_hidden = has_ground && scenery.ground < (high.y - 0.5) * spacing;
        GridPlan {
            plane: grid.plane,
            spacing,
            too_fine: (spacing > given).then_some(given),
            low,
            high,
            ground: scenery.ground,
            floor: if is_hidden { scenery.ground } else { f64::NEG_INFINITY },
            height: usual_height(SIZE, LEAST_PIXELS, scene.output),
            pixels: width,
            aspect: height / width,
            color: line_color(scene),
            ink,
            sign: scene.output.decimal,
        }
    }

    /// The spacing that the scene gives and the drawn spacing, m. `None` if they are equal; the drawn one is larger if there would be too
    /// many lines.
    pub(super) fn too_fine(&self) -> Option<(f64, f64)> {
        self.too_fine.map(|given| (given, self.spacing))
    }

    /// The box around the whole grid, m.
    pub(super) fn bounds(&self) -> Bounds {
        let (first, second, place) = self.axes();
        let corner =
            |number: DVec3| place + (first * number.dot(first) + second * number.dot(second)) * self.spacing;
        let (min, max) = (self.above_floor(corner(self.low)), corner(self.high));
        Bounds { min, max }
    }

    /// Lifts a point of an upright grid to the ground if the ground would hide it.
    fn above_floor(&self, point: DVec3) -> DVec3 {
        if self.plane.is_level() { point } else { point.with_y(point.y.max(self.floor)) }
    }

    /// The unit vectors along the grid's lines, and a point in the plane of the grid, m.
    fn axes(&self) -> (DVec3, DVec3, DVec3) {
        match self.plane {
            GridPlane::Ground => (DVec3::X, DVec3::Z, DVec3::Y * self.ground),
            GridPlane::Wall => (DVec3::X, DVec3::Y, DVec3::Z * (self.low.z * self.spacing)),
            GridPlane::Xy => (DVec3::X, DVec3::Y, DVec3::ZERO),
            GridPlane::Xz => (DVec3::X, DVec3::Z, DVec3::ZERO),
            GridPlane::Yz => (DVec3::Z, DVec3::Y, DVec3::ZERO),
        }
    }

    /// Lays out the whole grid with its numbers, for a stroke width (m) and a width in view (m).
    pub(super) fn whole(&self, stroke: f64, view: f64) -> GridLayout {
        self.rule(self.low, self.high, stroke, view)
    }

    /// Lays out the part of the grid around the view of a moving camera. Its lines extend beyond all edges of the picture.
    pub(super) fn seen_by(&self, camera: &Placed, stroke: f64, view: f64) -> GridLayout {
        let (first, second, place) = self.axes();
        let (look_at, normal) = (camera.look_at(), first.cross(second));
        let screen = camera.screen();
        let window = DVec3::splat(WINDOW * view);
        let far = 2.0 * window.x + camera.location().distance(look_at);
        // The points of the grid's plane that are seen in the corners of the picture. Where the plane is out of sight, use distant points.
        let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]].map(|[x, y]| {
            let (origin, direction) = screen.ray(x, y * self.aspect);
            let away = (place - origin).dot(normal) / direction.dot(normal);
            origin + direction * if away > 0.0 { away.min(far) } else { far }
        });
        let min = corners.into_iter().fold(corners[0], DVec3::min).max(look_at - window);
        let max = corners.into_iter().fold(corners[0], DVec3::max).min(look_at + window);
        let spanned = first + second;
        let rest = DVec3::ONE - spanned;
        let low = (min / self.spacing).floor().clamp(self.low, self.high) * spanned + self.low * rest;
        let high = (max / self.spacing).ceil().clamp(self.low, self.high) * spanned + self.high * rest;
        self.rule(low, high.max(low), stroke, view)
    }

    fn rule(&self, low: DVec3, high: DVec3, stroke: f64, view: f64) -> GridLayout {
        let spacing = self.spacing;
        let (first, second, place) = self.axes();
        let radius = (RADIUS * stroke).max(LEAST_RADIUS * view / self.pixels);
        let corner = |a: f64, b: f64| self.above_floor(place + (first * a + second * b) * spacing);
        let (a0, a1) = (low.dot(first), high.dot(first));
        let (b0, b1) = (low.dot(second), high.dot(second));
        let is_hidden = |b: f64| !self.plane.is_level() && b * spacing < self.floor;
        // The numbers of lines on the ground are at their near ends; those of lines on a wall are at their lower or left ends.
        let (near, far) = if self.plane.is_level() { (b1, b0) } else { (b0, b1) };
        let across = marks(a0, a1).map(|a| (a, [corner(a, near), corner(a, far)]));
        let along = marks(b0, b1).filter(|b| !is_hidden(*b)).map(|b| (b, [corner(a0, b), corner(a1, b)]));
        let (across, along): (Vec<_>, Vec<_>) = (across.collect(), along.collect());
        // The lines through 0 are the coordinate axes, and are drawn wider.
        let width = |number: f64| if number == 0.0 { 2.2 * radius } else { radius };
        let lines = across.iter().chain(&along).filter(|(_, [from, to])| from != to);
        let lines = lines.map(|(number, [from, to])| Line { from: *from, to: *to, radius: width(*number) });
        let (unit, symbol) = prefixed(spacing);
        let numbers = |lines: &[(f64, [DVec3; 2])]| {
            let says = |line: f64| value(line * spacing / unit, self.sign);
            let number = |&(line, ends): &(f64, _)| Number { line, says: says(line), ends };
            lines.iter().map(number).collect::<Vec<_>>()
        };
        // The axis name is written at the last number, so lines on the ground are listed from near to far.
        let (beside, name, along) = match self.plane.is_level() {
            true => (Beside::LeftOnGround, "z", along.iter().rev().copied().collect()),
            false => (Beside::Left, "y", along.clone()),
        };
        let name_across = if self.plane == GridPlane::Yz { "z" } else { "x" };
        let axis = |beside, name, lines: &[_]| Axis {
            beside,
            numbers: numbers(lines),
            title: format!("{name} ({symbol})"),
        };
        GridLayout {
            axes: [axis(Beside::Below, name_across, &across), axis(beside, name, &along)],
            lines: Thing {
                name: "grid".into(),
                form: Form::Lines { lines: lines.collect() },
                color: self.color,
            },
            height: self.height,
            aspect: self.aspect,
            ink: self.ink,
        }
    }
}

/// The indices of the first and the last lines along x, y and z of a grid that covers the whole motion.
fn extent_in_lines(plane: GridPlane, bounds: Bounds, spacing: f64) -> (DVec3, DVec3) {
    // Bodies may extend a little beyond the grid. A nearby origin is included.
    let (low, high) = ((bounds.min / spacing + 0.3).floor(), (bounds.max / spacing - 0.3).ceil());
    let mut low = DVec3::select(low.cmpgt(DVec3::ZERO) & low.cmple(0.3 * high), DVec3::ZERO, low);
    let mut high = high.max(low + 1.0);
    // For motion along a line, the grid is widened to at least 0.4 times its length.
    let widen = |low: &mut f64, high: &mut f64, least: f64| {
        let lacking = (least - (*high - *low)).max(0.0);
        *low -= (lacking / 2.0).ceil();
        *high += (lacking / 2.0).ceil();
    };
    let [x, y, z] = (high - low).to_array();
    match plane {
        GridPlane::Ground | GridPlane::Xz => {
            widen(&mut low.x, &mut high.x, 0.4 * z);
            widen(&mut low.z, &mut high.z, 0.4 * x);
        }
        GridPlane::Wall | GridPlane::Xy => widen(&mut low.x, &mut high.x, 0.4 * y),
        GridPlane::Yz => widen(&mut low.z, &mut high.z, 0.4 * y),
    }
    (low, high)
}

/// The whole numbers from `low` to `high`. A counter is used because far from 0, adding 1 to a number may not change it.
fn marks(low: f64, high: f64) -> impl Iterator<Item = f64> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "what is too large is cut")]
    let last = (high - low).min(MOST_LINES) as u32;
    (0..=last).map(move |number| low + f64::from(number)).filter(move |mark| *mark <= high)
}

/// The color of grid lines: just visible against the background.
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
