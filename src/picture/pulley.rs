//! The path of a rope over the wheels of a pulley.

use glam::DVec3;

use super::catenary::hanging;

/// The number of straight pieces of a rope around a wheel.
const PIECES: u32 = 10;

/// The largest distance between a wheel's center and its corner of the rope, in radii of the wheel.
const FARTHEST: f64 = 3.0;

/// The path of a rope from one end over one or two wheels to the other end.
pub(super) struct RopePath {
    ends: [DVec3; 2],
    /// The corners of the rope, as if the wheels had no size, m.
    over: [DVec3; 2],
    /// The arcs around the wheels.
    pub(super) turns: Vec<WheelArc>,
}

/// The arc of a rope around a wheel.
pub(super) struct WheelArc {
    /// The center of the wheel, m.
    pub(super) centre: DVec3,
    /// The axis of the wheel, a unit vector.
    pub(super) axis: DVec3,
    /// The points of the rope on the wheel, m.
    points: Vec<DVec3>,
}

impl RopePath {
    /// Computes the path from the first point over two corners to the last point, m, with wheels of the given radius. Coinciding corners
    /// share one wheel.
    pub(super) fn new([from, first, second, to]: [DVec3; 4], radius: f64) -> RopePath {
        let turns = if first.distance(second) > 1e-9 * first.distance(from) {
            vec![WheelArc::new(from, first, second, radius), WheelArc::new(first, second, to, radius)]
        } else {
            vec![WheelArc::new(from, first, to, radius)]
        };
        RopePath { ends: [from, to], over: [first, second], turns }
    }

    /// The points of the rope, m. Half of the slack hangs in each outer part. The last part counts `ratio` times in `length`, as in a
    /// block and tackle.
    pub(super) fn points(&self, length: f64, ratio: f64, down: Option<DVec3>) -> Vec<DVec3> {
        let [first, last] = [0, 1].map(|i| self.ends[i].distance(self.over[i]));
        let slack = 0.5 * (length - first - ratio * last).max(0.0);
        // A very small slack is a rounding error.
        let slack = if slack > 1e-9 * length { slack } else { 0.0 };
        let part = |from: DVec3, to: DVec3, slack: f64| hanging([from, to], from.distance(to) + slack, down);
        let mut points = vec![self.ends[0]];
        for turn in &self.turns {
            let begin = turn.points[0];
            // The first part of the rope ends at the first wheel.
            let from = points[points.len() - 1];
            let way = if points.len() == 1 { part(from, begin, slack) } else { vec![from, begin] };
            points.extend(&way[1..]);
            points.extend(&turn.points[1..]);
        }
        let way = part(points[points.len() - 1], self.ends[1], slack / ratio);
        points.extend(&way[1..]);
        points
    }
}

impl WheelArc {
    /// Places a wheel into the corner of a rope from `from` over `corner` to `to`, so that it touches both parts of the rope.
    fn new(from: DVec3, corner: DVec3, to: DVec3, radius: f64) -> WheelArc {
        let back = (from - corner).normalize_or(DVec3::NEG_Y);
        let on = (to - corner).normalize_or(DVec3::NEG_Y);
        let across = |way: DVec3| way.cross(DVec3::Y).try_normalize().unwrap_or(DVec3::Z);
        let axis = back.cross(on).try_normalize().unwrap_or_else(|| across(back));
        let middle = (back + on).try_normalize();
        // A straight rope has no corner, so the wheel is placed below the rope.
        let inward = middle.unwrap_or_else(|| {
            let side = axis.cross(back);
            if side.y > 0.0 { -side } else { side }
        });
        let sine = inward.cross(back).length();
        let centre = corner + inward * (radius / sine.max(1.0 / FARTHEST));
        // Angles are measured about the axis from the direction `inward`. The rope touches the wheel first at `begin`, and goes around the
        // far side to `end`.
        let side = axis.cross(inward);
        let angle = |point: DVec3| {
            let way = point - centre;
            let distance = way.length();
            (distance > radius)
                .then(|| (libm::atan2(way.dot(side), way.dot(inward)), libm::acos(radius / distance)))
        };
        let points = match (angle(from), angle(to)) {
            (Some((come, open)), Some((go, shut))) => {
                let begin = come - open;
                let end = go + shut - std::f64::consts::TAU;
                let at = |piece: u32| {
                    let angle = begin + (end - begin).min(0.0) * f64::from(piece) / f64::from(PIECES);
                    centre + radius * (libm::cos(angle) * inward + libm::sin(angle) * side)
                };
                (0..=PIECES).map(at).collect()
            }
            // An end of the rope is inside the wheel.
            _ => vec![corner],
        };
        WheelArc { centre, axis, points }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rope_goes_straight_to_its_wheels_and_around_them() {
        // The rope goes up, across and down again. The wheels are inside its corners.
        let corners = [[-1.0, 0.0], [-1.0, 2.0], [1.0, 2.0], [1.0, -3.0]];
        let course = RopePath::new(corners.map(|[x, y]| DVec3::new(x, y, 0.0)), 0.1);
        let centres: Vec<DVec3> = course.turns.iter().map(|turn| turn.centre).collect();
        assert!(centres[0].abs_diff_eq(DVec3::new(-0.9, 1.9, 0.0), 1e-12), "{centres:?}");
        assert!(centres[1].abs_diff_eq(DVec3::new(0.9, 1.9, 0.0), 1e-12), "{centres:?}");
        let points = course.points(2.0 + 5.0, 1.0, Some(DVec3::NEG_Y));
        for point in &points {
            let is_on = |centre: &DVec3| (point.distance(*centre) - 0.1).abs() < 1e-12;
            assert!(point.x.abs() <= 1.0 + 1e-12 && point.y <= 2.0 + 1e-12);
            assert!(
                point.x.abs() > 1.0 - 1e-12 || (point.y - 2.0).abs() < 1e-12 || centres.iter().any(is_on)
            );
        }
        // Each corner is replaced by a quarter of a circle.
        let length: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let expected = 9.0 - 2.0 * (0.2 - 0.05 * std::f64::consts::PI);
        assert!((length - expected).abs() < 1e-3, "{length} {expected}");
    }

    #[test]
    fn what_there_is_too_much_of_a_rope_hangs() {
        let corners = [[-1.0, 0.0], [0.0, 2.0], [0.0, 2.0], [1.0, 0.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let course = RopePath::new(corners, 0.1);
        assert_eq!(course.turns.len(), 1);
        let length = |slack: f64| {
            let points = course.points(2.0 * 5.0_f64.sqrt() + slack, 1.0, Some(DVec3::NEG_Y));
            points.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>()
        };
        let grown = length(0.5) - length(0.0);
        assert!((0.47..0.5).contains(&grown), "{grown}");
    }
}
