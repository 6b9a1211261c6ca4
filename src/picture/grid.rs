//! The grid: lines with numbers, to read lengths from.

use glam::DVec3;

use super::length::{prefixed, value};
use super::screen::Screen;
use super::stage::Scenery;
use super::text::{Text, Vertical};
use crate::scene::{self, Color, GridPlane, Preset, Scene};

/// The height of the numbers of rulers, as part of the picture's height.
pub(super) const SIZE: f64 = 0.045;
/// The most numbers along an edge of the grid.
const MOST_NUMBERS: f64 = 15.0;
/// The most lines of the grid, each way.
const MOST_LINES: f64 = 400.0;

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

/// A grid with its numbers.
#[derive(Clone, Debug)]
pub(super) struct Ruled {
    grid: Grid,
    /// Its numbers, each with the point that it belongs to and the side of it on which it stands.
    numbers: Vec<(String, DVec3, Beside)>,
    /// The height of a line of text on the screen.
    height: f64,
    ink: Color,
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

impl Ruled {
    /// The grid of a scene, unless it has too many lines to be of use.
    pub(super) fn new(scene: &Scene, grid: scene::Grid, scenery: &Scenery, ink: Color) -> Option<Ruled> {
        let aspect = f64::from(scene.output.height) / f64::from(scene.output.width);
        let mut ruled = Ruled {
            grid: Grid { lines: Vec::new(), color: line_color(scene) },
            numbers: Vec::new(),
            height: SIZE * 2.0 * aspect,
            ink,
        };
        let spacing = grid.spacing.unwrap_or(scenery.tile);
        ruled.rule(grid.plane, spacing, scenery).then_some(ruled)
    }

    /// The lines.
    pub(super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Makes lines and numbers; not, if there were too many.
    fn rule(&mut self, plane: GridPlane, spacing: f64, scenery: &Scenery) -> bool {
        let (min, max) = (scenery.bounds.min / spacing, scenery.bounds.max / spacing);
        // Bodies may reach out a little; and where 0 is near, it is there.
        let (low, high) = ((min + 0.3).floor(), (max - 0.3).ceil());
        let low = DVec3::select(low.cmpgt(DVec3::ZERO) & low.cmple(0.3 * high), DVec3::ZERO, low);
        let mut high = high.max(low + 1.0);
        let mut low = low;
        if plane == GridPlane::Ground {
            // Motion in a plane needs a ground to stand on, too.
            let lacking = (0.4 * (high.x - low.x) - (high.z - low.z)).max(0.0);
            low.z -= (lacking / 2.0).ceil();
            high.z += (lacking / 2.0).ceil();
        }
        let lines = (high - low).max_element();
        if lines.is_nan() || lines > MOST_LINES {
            return false;
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
        // The lines through 0 are the axes.
        let width = |number: f64| if number == 0.0 { 2.2 * radius } else { radius };
        let mut put = |from: DVec3, to: DVec3, radius: f64| self.grid.lines.push(Line { from, to, radius });
        for a in marks(a0, a1, 1.0) {
            put(corner(a, b0), corner(a, b1), width(a));
        }
        for b in marks(b0, b1, 1.0) {
            put(corner(a0, b), corner(a1, b), width(b));
        }
        let (front, top, name) = match plane {
            GridPlane::Ground => (b1, b0, "z"),
            GridPlane::Wall => (b0, b1, "y"),
        };
        self.numbers_along((a0, a1), spacing, Beside::Below, |a| corner(a, front));
        self.numbers_along((b0, b1), spacing, Beside::Left, |b| corner(a0, b));
        let (_, symbol) = prefixed(spacing);
        self.numbers.push((format!("{name} ({symbol})"), corner(a0, top), Beside::Above));
        self.numbers.push((format!("x ({symbol})"), corner(a1, front), Beside::End));
        true
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
        for number in marks((low / every).ceil() * every, high, every) {
            self.numbers.push((value(number * spacing / unit), at(number), beside));
        }
    }

    /// The numbers as they stand on the plane before a camera.
    pub(super) fn numbers(&self, screen: &Screen) -> Vec<Text<'_>> {
        // The names of the axes come first; what would stand on another is left out.
        let mut placed: Vec<(f64, f64, f64)> = Vec::new();
        let mut texts = Vec::new();
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
            texts.push(Text {
                name: "grid",
                says: said.as_str().into(),
                x,
                y: Vertical::Middle(y),
                height,
                align,
                color: self.ink,
            });
        }
        texts
    }
}

/// The marks from `low` to `high`. They are counted: far from 0, the sum of a number and 1 is that number.
fn marks(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "what is too large is cut")]
    let last = ((high - low) / step).min(MOST_LINES) as u32;
    (0..=last).map(move |number| low + f64::from(number) * step).filter(move |mark| *mark <= high)
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
        assert_eq!(marks(-1.0, 2.0, 1.0).collect::<Vec<_>>(), [-1.0, 0.0, 1.0, 2.0]);
        assert_eq!(marks(0.0, 5.0, 2.0).collect::<Vec<_>>(), [0.0, 2.0, 4.0]);
        assert!(marks(1e16, 1e16 + 2.0, 1.0).count() <= 3);
        assert!(marks(1e300, 2e300, 1.0).count() <= 402);
        assert_eq!(marks(f64::NAN, 1.0, 1.0).count(), 0);
    }
}
