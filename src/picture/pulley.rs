//! The path of a rope over the wheels of a pulley.

use glam::DVec3;

use super::catenary::hanging;

/// The number of straight pieces of a rope around a wheel.
const PIECES_PER_WHEEL: u32 = 10;

/// The largest distance between a wheel's center and its corner of the rope, in radii of the wheel.
const MAX_CORNER_DISTANCE: f64 = 3.0;

/// The largest distance between the center of a wheel on a body and its corner of the rope, in radii of the wheel. The wheel touches the
/// point of the body, so that it does not seem to float.
const FARTHEST_ON_BODY: f64 = 1.0;

/// The path of a rope from one end over wheels to the other end.
pub(super) struct RopePath {
    /// The ends of the rope, m.
    ends: [DVec3; 2],
    /// The length of the rope if the wheels had no size, in which the last part counts as often as in the rope's length, m.
    taut: f64,
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

/// A point of a rope: an end or a corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct RopePoint {
    /// The position of the point, m.
    pub(super) place: DVec3,
    /// Whether the point is on a body.
    pub(super) is_on_body: bool,
}

impl RopePath {
    /// Computes the path from the first point over corners to the last point, with wheels of the given radius, m. Neighboring corners at
    /// the same place share one wheel. The last part counts `ratio` times in the length of the rope.
    pub(super) fn new(path: &[RopePoint], radius: f64, ratio: f64) -> RopePath {
        let ways: Vec<f64> = path.windows(2).map(|ends| ends[0].place.distance(ends[1].place)).collect();
        let taut = ways.iter().sum::<f64>() + (ratio - 1.0) * ways.last().unwrap_or(&0.0);
        let mut corners = path.to_vec();
        corners.dedup_by(|next, before| next.place.distance(before.place) <= 1e-9 * taut);
        let turn = |way: &[RopePoint]| {
            let farthest = if way[1].is_on_body { FARTHEST_ON_BODY } else { MAX_CORNER_DISTANCE };
            WheelArc::new([0, 1, 2].map(|i| way[i].place), radius, farthest)
        };
        let turns = corners.windows(3).map(turn).collect();
        let end = |end: Option<&RopePoint>| end.map_or(DVec3::ZERO, |end| end.place);
        RopePath { ends: [end(path.first()), end(path.last())], taut, turns }
    }

    /// The points of the rope, m. Half of the slack hangs in each outer part. The last part counts `ratio` times in `length`, as in a
    /// block and tackle.
    pub(super) fn points(&self, length: f64, ratio: f64, down: Option<DVec3>) -> Vec<DVec3> {
        let slack = 0.5 * (length - self.taut).max(0.0);
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
    /// Places a wheel into the corner of a rope from `from` over `corner` to `to`, so that it touches both parts of the rope, at most
    /// `farthest` radii from the corner.
    fn new([from, corner, to]: [DVec3; 3], radius: f64, farthest: f64) -> WheelArc {
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
        let centre = corner + inward * (radius / sine.max(1.0 / farthest));
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
                    let angle =
                        begin + (end - begin).min(0.0) * f64::from(piece) / f64::from(PIECES_PER_WHEEL);
                    centre + radius * (libm::cos(angle) * inward + libm::sin(angle) * side)
                };
                (0..=PIECES_PER_WHEEL).map(at).collect()
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

    fn fixed(place: DVec3) -> RopePoint {
        RopePoint { place, is_on_body: false }
    }

    #[test]
    fn a_rope_goes_straight_to_its_wheels_and_around_them() {
        // The rope goes up, across and down again. The wheels are inside its corners.
        let corners = [[-1.0, 0.0], [-1.0, 2.0], [1.0, 2.0], [1.0, -3.0]];
        let course = RopePath::new(&corners.map(|[x, y]| fixed(DVec3::new(x, y, 0.0))), 0.1, 1.0);
        let centres: Vec<DVec3> = course.turns.iter().map(|turn| turn.centre).collect();
        assert!(centres[0].abs_diff_eq(DVec3::new(-0.9, 1.9, 0.0), 1e-12), "{centres:?}");
        assert!(centres[1].abs_diff_eq(DVec3::new(0.9, 1.9, 0.0), 1e-12), "{centres:?}");
        let points = course.points(2.0 + 2.0 + 5.0, 1.0, Some(DVec3::NEG_Y));
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
        let corners =
            [[-1.0, 0.0], [0.0, 2.0], [0.0, 2.0], [1.0, 0.0]].map(|[x, y]| fixed(DVec3::new(x, y, 0.0)));
        let course = RopePath::new(&corners, 0.1, 1.0);
        assert_eq!(course.turns.len(), 1);
        let length = |slack: f64| {
            let points = course.points(2.0 * 5.0_f64.sqrt() + slack, 1.0, Some(DVec3::NEG_Y));
            points.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>()
        };
        let grown = length(0.5) - length(0.0);
        assert!((0.47..0.5).contains(&grown), "{grown}");
    }

    /// The rope of a block and tackle runs down to a wheel and up again. Its pieces are as long as the rope, apart from the wheels.
    #[test]
    fn a_rope_goes_over_any_number_of_wheels() {
        let path = [[-1.0, 3.0], [-0.8, 0.0], [-0.4, 3.0], [0.0, 0.0], [0.4, 3.0], [1.0, 1.0]];
        let path = path.map(|[x, y]| DVec3::new(x, y, 0.0));
        let points = path.map(|place| RopePoint { place, is_on_body: place.y == 0.0 });
        let course = RopePath::new(&points, 0.05, 1.0);
        assert_eq!(course.turns.len(), 4);
        let length = |path: &[DVec3]| path.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>();
        let points = course.points(length(&path), 1.0, Some(DVec3::NEG_Y));
        for (turn, corner) in course.turns.iter().zip(&path[1..]) {
            let farthest = if corner.y == 0.0 { FARTHEST_ON_BODY } else { MAX_CORNER_DISTANCE };
            assert!(turn.centre.distance(*corner) <= 0.05 * farthest + 1e-12, "{}", turn.centre);
        }
        let missing = length(&path) - length(&points);
        assert!((0.0..1.5).contains(&missing), "{missing}");
    }
}
