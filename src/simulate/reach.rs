//! The region that the arrows of a run reach, as a function of their scale. The scale is chosen after the run.

use glam::DVec3;

use super::Bounds;

/// The largest number of lines in an envelope. Beyond this number, every second line is dropped, which lowers the envelope by less than a
/// thousandth.
const MOST_LINES: usize = 128;

/// The region that all arrows of one quantity reach. An arrow ends at `root + scale · vector`, where the scale is not known yet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reach {
    /// The length of the longest vector, in the unit of its quantity.
    pub largest: f64,
    /// The largest coordinates of arrow tips along +x, +y, +z, −x, −y and −z, as functions of the scale.
    envelopes: [Envelope; 6],
}

impl Reach {
    /// Adds an arrow that begins at `root` (m) and shows `vector`. Ignores non-finite arrows.
    pub(super) fn add(&mut self, root: DVec3, vector: DVec3) {
        if !root.is_finite() || !vector.is_finite() {
            return;
        }
        self.largest = self.largest.max(vector.length());
        let (root, vector) = (root.to_array(), vector.to_array());
        for axis in 0..3 {
            self.envelopes[axis].add(Line { slope: vector[axis], start: root[axis] });
            self.envelopes[axis + 3].add(Line { slope: -vector[axis], start: -root[axis] });
        }
    }

    /// The box around the tips of all arrows, m, if one unit of the quantity is drawn `scale` meters long. `None` if there are no arrows.
    pub fn tips(&self, scale: f64) -> Option<Bounds> {
        let at = |direction: usize| self.envelopes[direction].at(scale);
        let max = DVec3::new(at(0)?, at(1)?, at(2)?);
        let min = -DVec3::new(at(3)?, at(4)?, at(5)?);
        (max.is_finite() && min.is_finite()).then_some(Bounds { min, max })
    }
}

/// The coordinate of an arrow's tip as a linear function of the scale s: `start + slope · s`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    slope: f64,
    start: f64,
}

impl Line {
    /// The scale at which a steeper line becomes larger than this line.
    fn overtaken_by(self, steeper: Line) -> f64 {
        (self.start - steeper.start) / (steeper.slope - self.slope)
    }
}

/// The upper envelope of many lines: their maximum at each scale s ≥ 0, a convex polyline.
#[derive(Clone, Debug, Default, PartialEq)]
struct Envelope {
    /// The lines of the envelope by increasing slope. Each is the maximum at some scale.
    lines: Vec<Line>,
}

impl Envelope {
    fn add(&mut self, line: Line) {
        let place = self.lines.partition_point(|other| other.slope < line.slope);
        if let Some(&after) = self.lines.get(place) {
            if after.start >= line.start {
                return;
            }
            if after.slope > line.slope && place > 0 {
                let before = self.lines[place - 1];
                if before.overtaken_by(line) >= before.overtaken_by(after) {
                    return;
                }
            }
        }
        // Remove the lines that the new line hides: those that start lower with a smaller slope, and those that are no longer the maximum
        // anywhere.
        let mut from = place;
        while from > 0 {
            let before = self.lines[from - 1];
            let hidden = before.start <= line.start
                || (from > 1
                    && self.lines[from - 2].overtaken_by(line) <= self.lines[from - 2].overtaken_by(before));
            if !hidden {
                break;
            }
            from -= 1;
        }
        let mut to = place;
        while let Some(&after) = self.lines.get(to) {
            let hidden = after.slope <= line.slope
                || self
                    .lines
                    .get(to + 1)
                    .is_some_and(|next| line.overtaken_by(*next) <= line.overtaken_by(after));
            if !hidden {
                break;
            }
            to += 1;
        }
        self.lines.splice(from..to, [line]);
        if self.lines.len() > MOST_LINES {
            let last = self.lines.len() - 1;
            let mut number = 0;
            self.lines.retain(|_| {
                number += 1;
                number % 2 == 1 || number == last + 1
            });
        }
    }

    /// The maximum of all lines at a scale. `None` without lines.
    fn at(&self, scale: f64) -> Option<f64> {
        self.lines.iter().map(|line| line.start + line.slope * scale).reduce(f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tips_are_where_the_farthest_arrows_end_at_any_scale() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1u32 << 24) - 0.5
        };
        let mut reach = Reach::default();
        let mut arrows = Vec::new();
        for round in 0..3000 {
            // Half of the arrows lie on an ellipse, so that each reaches farthest at some scale.
            let angle = random() * 7.0;
            let (a, b) = (
                DVec3::new(libm::cos(angle), libm::sin(angle), 0.0),
                DVec3::new(-libm::sin(angle), libm::cos(angle), 0.0),
            );
            let scatter = DVec3::new(random(), random(), random());
            let (root, vector) = if round % 2 == 0 {
                (a, 3.0 * b)
            } else {
                (scatter, 4.0 * DVec3::new(scatter.y, scatter.z, scatter.x))
            };
            arrows.push((root, vector));
            reach.add(root, vector);
        }
        for scale in [0.0, 1e-3, 0.03, 0.2, 1.0, 40.0] {
            let tips = reach.tips(scale).unwrap();
            let exact = arrows.iter().map(|(root, vector)| root + scale * vector);
            let max = exact.clone().reduce(DVec3::max).unwrap();
            let min = exact.reduce(DVec3::min).unwrap();
            let near = |a: DVec3, b: DVec3| a.abs_diff_eq(b, 2e-3 * (1.0 + 3.0 * scale));
            assert!(near(tips.max, max) && near(tips.min, min), "{scale}: {tips:?} {min} {max}");
        }
        assert!(reach.envelopes.iter().all(|envelope| envelope.lines.len() <= MOST_LINES));
        let largest = arrows.iter().map(|(_, vector)| vector.length()).fold(0.0, f64::max);
        assert_eq!(reach.largest, largest);
    }

    #[test]
    fn no_arrows_reach_nowhere() {
        assert_eq!(Reach::default().tips(1.0), None);
        let mut reach = Reach::default();
        reach.add(DVec3::splat(f64::NAN), DVec3::X);
        assert_eq!(reach.tips(1.0), None);
    }
}
