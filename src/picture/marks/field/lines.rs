//! Field lines. They begin at positive charges and end at negative ones, as many at each as its strength asks for.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{FieldMark, FrameView, LINE_RADIUS, Region, Sketch, Source};
use crate::picture::thing::Line;
use crate::simulate::FieldSampler;

/// The length of a step along a line, relative to half the width of the region.
const STEP_LENGTH: f64 = 0.012;
/// The largest number of steps along a line.
const MAX_STEPS: usize = 1500;
/// The position in the region at which a line ends, relative to the region's half width and height. A line that leaves the region before may
/// come back.
const MAX_POSITION: f64 = 1.6;
/// The distance from its source at which a line begins, in radii of the body.
const BEGIN_DISTANCE: f64 = 1.02;
/// The smallest radius at which a line begins and ends, relative to half the width of the region.
const MIN_RADIUS: f64 = 0.01;
/// The distance from a magnet at which its innermost line crosses the plane across its moment, in radii of the body.
const NEAREST_LINE_OF_MAGNET: f64 = 1.15;
/// The part of a magnet's radius within which lines are not followed.
const HIDDEN_PART_OF_MAGNET: f64 = 0.15;
/// The length of the arrow in the middle of a line, relative to half the width of the region.
const ARROW_LENGTH: f64 = 0.035;

/// A line from its begin to its end, in the direction of the field.
struct Path {
    points: Vec<DVec3>,
    /// The source at which the line ends, by its position in the list. `None` if it leaves the picture.
    end: Option<usize>,
}

impl FieldMark {
    pub(super) fn draw_lines<'a>(
        &'a self,
        sampler: &mut FieldSampler,
        sources: &[Source],
        scale: &FrameView<'_>,
        sketch: &mut Sketch<'a>,
    ) {
        let radius = LINE_RADIUS * scale.stroke;
        let size = self.region.half[0];
        let mut lines = Vec::new();
        for path in self.paths(sampler, sources) {
            lines.extend(
                path.points
                    .windows(2)
                    .filter(|pair| pair.iter().any(|point| self.is_inside(*point)))
                    .map(|pair| Line { from: pair[0], to: pair[1], radius }),
            );
            let visible: Vec<DVec3> =
                path.points.iter().copied().filter(|point| self.is_inside(*point)).collect();
            if let [.., before, here] = visible[..visible.len().div_ceil(2)] {
                let along = (here - before).normalize_or_zero() * (ARROW_LENGTH * size / 2.0);
                sketch.things.push(self.arrow(here - along, here + along, 0.4 * scale.stroke));
            }
        }
        sketch.things.push(self.thing(lines));
    }

    fn is_inside(&self, point: DVec3) -> bool {
        point.y >= self.ground && self.region.position(point).iter().all(|part| part.abs() <= 1.0)
    }

    /// All lines of the field at a moment.
    fn paths(&self, sampler: &mut FieldSampler, sources: &[Source]) -> Vec<Path> {
        let strongest = sources.iter().map(|source| source.strength.abs()).fold(0.0, f64::max);
        if sources.is_empty() {
            return self.across(sampler);
        }
        if strongest == 0.0 {
            return self.around_magnets(sampler, sources);
        }
        let count = |source: &Source| {
            let share = f64::from(self.drawn.count) * source.strength.abs() / strongest;
            libm::round(share)
        };
        // A source that is too weak for a line of its own is passed by.
        let sources: Vec<Source> = sources.iter().copied().filter(|source| count(source) > 0.0).collect();
        let sources = sources.as_slice();
        let mut paths: Vec<Path> = Vec::new();
        for source in sources.iter().filter(|source| source.strength > 0.0) {
            let number = count(source);
            // The first line is not along an axis, so that lines lie symmetrically about it.
            for k in 0..self.drawn.count.min(number_of(number)) {
                let angle = TAU * (f64::from(k) + 0.5) / number;
                paths.extend(self.path(sampler, sources, self.seed(source, angle), 1.0));
            }
        }
        for (place, source) in sources.iter().enumerate().filter(|(_, source)| source.strength < 0.0) {
            let mut angles: Vec<f64> = paths
                .iter()
                .filter(|path| path.end == Some(place))
                .filter_map(|path| self.angle(source, path))
                .collect();
            while angles.len() < number_of(count(source)) as usize {
                let angle = widest_gap(&mut angles);
                angles.push(angle);
                if let Some(mut path) = self.path(sampler, sources, self.seed(source, angle), -1.0) {
                    path.points.reverse();
                    paths.push(path);
                }
            }
        }
        paths
    }

    /// The lines of a field without sources: they begin at equal distances on a line across the field.
    fn across(&self, sampler: &mut FieldSampler) -> Vec<Path> {
        let Region { middle, axes, half } = self.region;
        let along = self.region.within(sampler.at(middle));
        let Some(along) = along.try_normalize() else { return Vec::new() };
        let across = axes[0].cross(axes[1]).cross(along);
        let reach = half[0] * across.dot(axes[0]).abs() + half[1] * across.dot(axes[1]).abs();
        let count = f64::from(self.drawn.count);
        let begin = |k: u32| middle + across * (reach * (2.0 * (f64::from(k) + 0.5) / count - 1.0));
        let mut paths = Vec::new();
        for seed in (0..self.drawn.count).map(begin) {
            paths.extend(self.both_ways(sampler, &[], seed));
        }
        paths
    }

    /// The closed lines of magnets, as many as their moments ask for, half of them on each side. On the line through a magnet across its moment,
    /// the flux outside of a distance r is inverse to r. So lines that cross there at r, r/2, r/3, … have equal fluxes between them.
    fn around_magnets(&self, sampler: &mut FieldSampler, sources: &[Source]) -> Vec<Path> {
        // The body hides what is inside of it.
        let inner = |source: &Source| Source { radius: source.radius * HIDDEN_PART_OF_MAGNET, ..*source };
        let inner: Vec<Source> = sources.iter().map(inner).collect();
        let moments: Vec<DVec3> = sources.iter().map(|source| self.moment(sampler, source)).collect();
        let strongest = moments.iter().map(|moment| moment.length()).fold(0.0, f64::max);
        let mut paths = Vec::new();
        for (source, moment) in sources.iter().zip(moments) {
            let Some(along) = moment.try_normalize() else { continue };
            let across = self.region.axes[0].cross(self.region.axes[1]).cross(along);
            let count = libm::round(f64::from(self.drawn.count) / 2.0 * moment.length() / strongest);
            let nearest = NEAREST_LINE_OF_MAGNET * self.reach(source);
            for k in 1..=number_of(count) {
                let way = across * (nearest * count / f64::from(k));
                for seed in [source.at + way, source.at - way] {
                    paths.extend(self.both_ways(sampler, &inner, seed));
                }
            }
        }
        paths
    }

    /// The part of a magnet's moment in the plane, in units of the field times m³. Near a dipole with the moment m, the field at d = r n is
    /// (3 (m·n) n − m)/r³, so its part along n is 2 (m·n)/r³.
    fn moment(&self, sampler: &mut FieldSampler, source: &Source) -> DVec3 {
        let distance = HIDDEN_PART_OF_MAGNET * self.reach(source);
        let part = |axis: DVec3| axis * sampler.at(source.at + axis * distance).dot(axis);
        self.region.axes.map(part).into_iter().sum::<DVec3>() * (distance * distance * distance / 2.0)
    }

    /// The line through a point, followed in both directions.
    fn both_ways(&self, sampler: &mut FieldSampler, sources: &[Source], seed: DVec3) -> Option<Path> {
        let [before, after] = [-1.0, 1.0].map(|sign| self.path(sampler, sources, seed, sign));
        let (mut before, after) = (before?, after?);
        before.points.reverse();
        before.points.extend_from_slice(&after.points[1..]);
        Some(Path { points: before.points, end: after.end })
    }

    /// The point at which a line of a source begins, at an angle in the plane.
    fn seed(&self, source: &Source, angle: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(angle);
        let [across, up] = self.region.axes;
        source.at + (across * cos + up * sin) * (BEGIN_DISTANCE * self.reach(source))
    }

    /// The distance from a source at which lines begin and end.
    fn reach(&self, source: &Source) -> f64 {
        source.radius.max(MIN_RADIUS * self.region.half[0])
    }

    /// The angle at which a line arrives at a source.
    fn angle(&self, source: &Source, path: &Path) -> Option<f64> {
        let way = *path.points.last()? - source.at;
        let angle = libm::atan2(way.dot(self.region.axes[1]), way.dot(self.region.axes[0]));
        Some(if angle < 0.0 { angle + TAU } else { angle })
    }

    /// Follows the field from a point, or against it if `sign` is −1, until the line ends at a source or leaves the region. Steps have equal
    /// lengths, by the classical Runge–Kutta method.
    fn path(&self, sampler: &mut FieldSampler, sources: &[Source], from: DVec3, sign: f64) -> Option<Path> {
        let step = STEP_LENGTH * self.region.half[0];
        let region = self.region;
        let mut direction = |point: DVec3| (region.within(sampler.at(point)) * sign).try_normalize();
        let mut points = vec![from];
        let mut here = from;
        for _ in 0..MAX_STEPS {
            let Some(k1) = direction(here) else { break };
            let Some(k2) = direction(here + k1 * (step / 2.0)) else { break };
            let Some(k3) = direction(here + k2 * (step / 2.0)) else { break };
            let Some(k4) = direction(here + k3 * step) else { break };
            here += (k1 + 2.0 * (k2 + k3) + k4) * (step / 6.0);
            let reached = sources.iter().position(|source| here.distance(source.at) < self.reach(source));
            points.push(here);
            if reached.is_some() {
                return Some(Path { points, end: reached });
            }
            if self.region.position(here).iter().any(|part| part.abs() > MAX_POSITION) {
                break;
            }
        }
        (points.len() > 2).then_some(Path { points, end: None })
    }
}

/// The number of lines, from a whole number.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the number of lines is limited")]
fn number_of(count: f64) -> u32 {
    count as u32
}

/// Returns the angle in the middle of the widest gap between angles from 0 to 2π. Without angles, it is 0.
fn widest_gap(angles: &mut [f64]) -> f64 {
    angles.sort_by(f64::total_cmp);
    let Some((first, last)) = angles.first().zip(angles.last()) else { return 0.0 };
    let around = (last + (first + TAU - last) / 2.0, first + TAU - last);
    let between = angles.windows(2).map(|pair| (f64::midpoint(pair[0], pair[1]), pair[1] - pair[0]));
    let (angle, _) = between.fold(around, |widest, gap| if gap.1 > widest.1 { gap } else { widest });
    if angle >= TAU { angle - TAU } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn new_lines_stand_in_the_widest_gap() {
        assert_eq!(widest_gap(&mut []), 0.0);
        assert_eq!(widest_gap(&mut [0.0]), TAU / 2.0);
        assert_eq!(widest_gap(&mut [2.0, 1.0, 6.0]), 4.0);
    }
}
