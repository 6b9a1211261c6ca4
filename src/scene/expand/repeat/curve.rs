//! Places copies of a body at equal distances along a curve.

use glam::{DQuat, DVec3};

use super::CopyPose;
use super::pattern::fraction;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::expand::Expander;
use crate::scene::expression::{Formula, Program, Scope};
use crate::scene::grammar::repeat::curve;
use crate::scene::source::{Node, Value};
use crate::scene::view::View;

/// The offsets and rotations of copies that are placed along a curve at equal arc lengths.
pub(super) struct Curve {
    places: Vec<CopyPose>,
}

/// The shape of the curve along which copies are placed.
enum Path {
    /// The coordinates x, y and z as formulas of the parameter `u`, which runs from 0 to 1.
    Formulas(Box<[Program; 3]>),
    /// The points of a Catmull–Rom spline, a smooth curve through all of them.
    Points { points: Vec<DVec3>, closed: bool },
}

impl Expander<'_> {
    /// Reads the curve of a `repeat` and places its copies. `at` is the list of three coordinate formulas, or `None` for a curve given by
    /// points.
    pub(super) fn curve(&mut self, view: &View<'_>, at: Option<&Node>) -> Option<Curve> {
        let count = usize::try_from(view.get(&curve::COUNT)?).ok()?;
        let closed = view.get(&curve::CLOSED);
        let turned = view.get(&curve::TURNED);
        let (path, span) = match at {
            Some(node) if !view.has(&curve::POINTS) => (self.formulas(node)?, node.span),
            Some(_) => return None,
            None => {
                let points = view.get_as::<Vec<DVec3>>(&curve::POINTS)?;
                (Path::Points { points, closed }, view.span(&curve::POINTS)?)
            }
        };
        let samples = self.samples(&path, at, count)?;
        let length = samples.last().map_or(0.0, |sample| sample.length);
        if !(length.is_finite() && length > 0.0) {
            let message = "a curve needs a length";
            let error =
                Diagnostic::error(Code::CurveWithoutLength, message).at(span, "all of it is one point");
            self.diagnostics.push(error);
            return None;
        }
        let last = if closed { count } else { count.saturating_sub(1) };
        let place = |n: usize| {
            let u = parameter_at(&samples, length * fraction(n, last));
            let turn = if turned { along(path.tangent(u)) } else { DQuat::IDENTITY };
            CopyPose { offset: path.at(u), turn }
        };
        Some(Curve { places: (0..count).map(place).collect() })
    }

    /// Compiles the three coordinate formulas of a curve, which depend on the parameter `u`.
    fn formulas(&mut self, node: &Node) -> Option<Path> {
        let Value::Array(items) = &node.value else { return None };
        let mut scope = self.scope.clone();
        scope.slot("u");
        let mut programs = Vec::new();
        for (number, item) in items.iter().enumerate() {
            let text = match &item.value {
                Value::String(text) => text.to_string(),
                _ => item.as_number().filter(|number| number.is_finite())?.to_string(),
            };
            let place = format!("curve.at[{number}]");
            programs.push(self.with_key(&place, |this| this.program(&text, item.span, &scope)));
        }
        let programs: Option<Vec<Program>> = programs.into_iter().collect();
        let programs: [Program; 3] = programs?.try_into().ok()?;
        Some(Path::Formulas(Box::new(programs)))
    }

    fn program(&mut self, text: &str, span: Span, scope: &Scope) -> Option<Program> {
        let formula = self.ok_or_report(Formula::parse(text), text, span)?;
        if formula.names().any(|(name, _)| self.broken.contains(name)) {
            return None;
        }
        let resolved = self.ok_or_report(formula.resolve(scope), text, span)?;
        let drawn = self.drawn(&resolved);
        let compiled = resolved.with_draws(&drawn).compile().map_err(|error| vec![error]);
        self.ok_or_report(compiled, text, span)
    }

    /// Samples the curve densely enough to measure its length. Reports an error and returns `None` if a point of the curve is not finite.
    fn samples(&mut self, path: &Path, at: Option<&Node>, count: usize) -> Option<Vec<Sample>> {
        /// The number of chords per copy that approximate the arc length of the curve.
        const PER_COPY: usize = 32;
        let number = (PER_COPY * count).clamp(4096, 1 << 20);
        let mut samples: Vec<Sample> = Vec::with_capacity(number + 1);
        let mut last = None;
        for n in 0..=number {
            let u = fraction(n, number);
            let point = path.at(u);
            if let (false, Path::Formulas(programs), Some(Value::Array(items))) =
                (point.is_finite(), path, at.map(|node| &node.value))
            {
                for (program, item) in programs.iter().zip(items) {
                    let Some(mut error) = program.explain_non_finite(&[u]) else { continue };
                    error.message = format!("{} at u = {u}", error.message);
                    let text = item.as_str().unwrap_or_default();
                    self.ok_or_report::<()>(Err(vec![error]), text, item.span);
                }
                return None;
            }
            let step = last.map_or(0.0, |last: DVec3| last.distance(point));
            let length = samples.last().map_or(0.0, |sample| sample.length) + step;
            samples.push(Sample { u, length });
            last = Some(point);
        }
        Some(samples)
    }
}

impl Curve {
    pub(super) fn count(&self) -> usize {
        self.places.len()
    }

    pub(super) fn place(&self, n: usize) -> CopyPose {
        let CopyPose { offset, turn } = self.places.get(n).unwrap_or(&UNMOVED);
        CopyPose { offset: *offset, turn: *turn }
    }
}

/// The place of a copy that is neither moved nor rotated.
const UNMOVED: CopyPose = CopyPose { offset: DVec3::ZERO, turn: DQuat::IDENTITY };

/// A sample of the curve: the parameter `u`, and the arc length from the beginning of the curve to the point at `u`, m.
struct Sample {
    u: f64,
    length: f64,
}

/// Returns the parameter `u` of the point at a given arc length, by linear interpolation between two samples.
fn parameter_at(samples: &[Sample], length: f64) -> f64 {
    let next = samples.partition_point(|sample| sample.length < length);
    let (Some(b), Some(a)) = (samples.get(next), next.checked_sub(1).and_then(|last| samples.get(last)))
    else {
        // The arc length is at the first sample or, because of rounding, beyond the last.
        return if next == 0 { 0.0 } else { 1.0 };
    };
    a.u + (b.u - a.u) * (length - a.length) / (b.length - a.length)
}

impl Path {
    fn at(&self, u: f64) -> DVec3 {
        match self {
            Path::Formulas(programs) => {
                let [x, y, z] = &**programs;
                DVec3::new(x.eval(&[u]), y.eval(&[u]), z.eval(&[u]))
            }
            Path::Points { points, closed } => spline(points, *closed, u),
        }
    }

    /// Returns the direction of the curve at `u` as a central difference. Its length is arbitrary.
    fn tangent(&self, u: f64) -> DVec3 {
        /// The distance of the two points from `u`, in units of the parameter.
        const DIFFERENCE_STEP: f64 = 1e-6;
        self.at((u + DIFFERENCE_STEP).min(1.0)) - self.at((u - DIFFERENCE_STEP).max(0.0))
    }
}

/// Returns the point at parameter `u` (0 to 1) of the Catmull–Rom spline through all `points`. At each end of an open spline, the missing
/// neighbor is the reflection of the next-to-last point through the end point.
fn spline(points: &[DVec3], closed: bool, u: f64) -> DVec3 {
    let count = points.len();
    let pieces = if closed { count } else { count - 1 };
    #[allow(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is a number of points"
    )]
    let (piece, v) = {
        let way = u * pieces as f64;
        let piece = (way.floor() as usize).min(pieces - 1);
        (piece, way - piece as f64)
    };
    let point = |n: usize| points[n % count];
    let (b, c) = (point(piece), point(piece + 1));
    let a = match piece {
        0 if !closed => 2.0 * b - c,
        piece => point(piece + count - 1),
    };
    let d = if !closed && piece + 2 >= count { 2.0 * c - b } else { point(piece + 2) };
    b + 0.5 * v * (c - a + v * (2.0 * a - 5.0 * b + 4.0 * c - d + v * (3.0 * (b - c) + d - a)))
}

/// Returns the rotation that turns the x axis into `direction` and keeps the y axis as upright as possible.
fn along(direction: DVec3) -> DQuat {
    let Some(direction) = direction.try_normalize() else { return DQuat::IDENTITY };
    let yaw = libm::atan2(-direction.z, direction.x);
    let pitch = libm::asin(direction.y.clamp(-1.0, 1.0));
    DQuat::from_axis_angle(DVec3::Y, yaw) * DQuat::from_axis_angle(DVec3::Z, pitch)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spline_goes_through_its_points_and_along_a_straight_line_if_they_do() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::new(2.0, 1.0, 0.0), DVec3::new(2.0, 3.0, -1.0)];
        for (n, point) in points.iter().enumerate() {
            assert!(spline(&points, false, fraction(n, 3)).distance(*point) < 1e-14);
            assert!(spline(&points, true, fraction(n, 4)).distance(*point) < 1e-14);
        }
        assert!(spline(&points, true, 1.0).distance(points[0]) < 1e-14);
        let straight = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
        assert!(spline(&straight, false, 0.3).distance(0.6 * DVec3::X) < 1e-14);
        assert!(spline(&straight[..2], false, 0.3).distance(0.3 * DVec3::X) < 1e-14);
    }

    #[test]
    fn what_is_turned_along_a_direction_has_its_x_axis_there_and_its_y_axis_up() {
        for direction in [DVec3::X, -DVec3::X, DVec3::Z, DVec3::new(1.0, 2.0, -3.0), DVec3::Y] {
            let turn = along(2.0 * direction);
            assert!((turn * DVec3::X).distance(direction.normalize()) < 1e-15);
            let level = direction.cross(DVec3::Y).normalize_or_zero();
            assert!((turn * DVec3::Y).dot(level).abs() < 1e-15 && (turn * DVec3::Y).y > -1e-15);
        }
    }
}
