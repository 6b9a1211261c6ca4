//! Cuts curves at the edges of a plot, and leaves out the points that nobody could see.

use crate::simulate::CurvePoint;

/// Returns the visible parts of a curve. `place` gives the position of a point from 0 to 1 across and up, `to_panel` the position in the
/// panel. What lies outside becomes a gap.
pub(super) fn clipped(
    points: &[CurvePoint],
    place: impl Fn([f64; 2]) -> [f64; 2],
    to_panel: impl Fn([f64; 2]) -> [f64; 2],
) -> Vec<CurvePoint> {
    let mut drawn: Vec<CurvePoint> = Vec::new();
    let mut put = |time: f64, at: Option<[f64; 2]>| {
        let point = CurvePoint { time, at: at.map(&to_panel) };
        let is_known = match drawn.last() {
            None => point.at.is_none(),
            Some(last) => last.at == point.at,
        };
        if !is_known {
            drawn.push(point);
        }
    };
    let mut before: Option<[f64; 2]> = None;
    for point in points {
        // A point that is too far away to compute with is drawn as one that is just far away.
        let here = point.at.map(&place).filter(|at| at.iter().all(|part| !part.is_nan()));
        let here = here.map(|at| at.map(|part| part.clamp(-MAX_DISTANCE, MAX_DISTANCE)));
        match (before, here) {
            (Some(from), Some(to)) => match visible(from, to) {
                Some([first, last]) => {
                    if first > 0.0 {
                        put(point.time, None);
                    }
                    for part in [first, last] {
                        put(point.time, Some(between(from, to, part)));
                    }
                    if last < 1.0 {
                        put(point.time, None);
                    }
                }
                None => put(point.time, None),
            },
            (None, Some(to)) if is_inside(to) => put(point.time, Some(to)),
            _ => put(point.time, None),
        }
        before = here;
    }
    drawn
}

/// The largest distance between a curve and its drawn line, in the image plane, where the picture has a width of 2: 0.3 pixels of a picture
/// 4000 pixels wide.
const MAX_DEVIATION: f64 = 1.5e-4;

/// Leaves out points that lie on the line between their neighbors (Ramer 1972, Douglas and Peucker 1973). Ends and gaps are kept.
pub(super) fn simplified(points: Vec<CurvePoint>) -> Vec<CurvePoint> {
    let mut is_kept = vec![false; points.len()];
    let mut begin = 0;
    for part in points.split(|point| point.at.is_none()) {
        let end = begin + part.len();
        if begin < end {
            keep(&points, (begin, end - 1), &mut is_kept);
        }
        if let Some(gap) = is_kept.get_mut(end) {
            *gap = true;
        }
        begin = end + 1;
    }
    points.into_iter().zip(is_kept).filter_map(|(point, is_kept)| is_kept.then_some(point)).collect()
}

/// Marks the points of a part of a curve that are needed, from its first to its last point.
fn keep(points: &[CurvePoint], part: (usize, usize), is_kept: &mut [bool]) {
    let mut parts = vec![part];
    while let Some((first, last)) = parts.pop() {
        (is_kept[first], is_kept[last]) = (true, true);
        let (Some(from), Some(to)) = (points[first].at, points[last].at) else { continue };
        if let Some(turn) = turn(points, (first, last)) {
            parts.extend([(first, turn), (turn, last)]);
            continue;
        }
        let distance = |number: &usize| points[*number].at.map_or(0.0, |at| away(at, from, to));
        let farthest = (first + 1..last).max_by(|one, other| distance(one).total_cmp(&distance(other)));
        if let Some(middle) = farthest.filter(|number| distance(number) > MAX_DEVIATION) {
            parts.extend([(first, middle), (middle, last)]);
        }
    }
}

/// Returns the point of a part of a curve at which it turns back along the line between the part's ends. A frame at an earlier time draws
/// the way there and not the way back, so this point is needed.
fn turn(points: &[CurvePoint], (first, last): (usize, usize)) -> Option<usize> {
    let [from, to] = [first, last].map(|end| points[end].at.map(glam::DVec2::from_array));
    let along = (to? - from?).normalize_or_zero();
    let (mut farthest, mut most) = (first, 0.0);
    for (number, point) in points.iter().enumerate().take(last + 1).skip(first + 1) {
        let way = (glam::DVec2::from_array(point.at?) - from?).dot(along);
        if way < most - 2.0 * MAX_DEVIATION {
            return (farthest > first).then_some(farthest).or((number < last).then_some(number));
        }
        if way > most {
            (farthest, most) = (number, way);
        }
    }
    None
}

/// The distance of a point from the line between two others.
fn away(at: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let [at, from, to] = [at, from, to].map(glam::DVec2::from_array);
    let way = to - from;
    let part = ((at - from).dot(way) / way.length_squared()).clamp(0.0, 1.0);
    at.distance(if part.is_nan() { from } else { from + part * way })
}

/// The largest distance of a point from the plot, relative to the size of the plot. Points farther away are moved to this distance.
const MAX_DISTANCE: f64 = 1e6;

/// The largest distance of a point outside of the plot that counts as a rounding error, relative to the size of the plot.
const MAX_ROUNDING: f64 = 1e-9;

fn is_inside(at: [f64; 2]) -> bool {
    at.iter().all(|part| (-MAX_ROUNDING..=1.0 + MAX_ROUNDING).contains(part))
}

fn between(from: [f64; 2], to: [f64; 2], part: f64) -> [f64; 2] {
    match part {
        0.0 => from,
        1.0 => to,
        part => std::array::from_fn(|k| (from[k] + part * (to[k] - from[k])).clamp(0.0, 1.0)),
    }
}

/// The part of a line inside the square from 0 to 1, as fractions of the line (Liang and Barsky 1984). `None` if it is outside.
fn visible(from: [f64; 2], to: [f64; 2]) -> Option<[f64; 2]> {
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for k in 0..2 {
        let way = to[k] - from[k];
        for (way, room) in [(-way, from[k] + MAX_ROUNDING), (way, 1.0 + MAX_ROUNDING - from[k])] {
            if way == 0.0 && room < 0.0 {
                return None;
            }
            if way < 0.0 {
                first = first.max(room / way);
            } else if way > 0.0 {
                last = last.min(room / way);
            }
        }
    }
    (first <= last).then_some([first, last])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(points: &[Option<[f64; 2]>]) -> Vec<Option<[f64; 2]>> {
        let points: Vec<CurvePoint> = points.iter().map(|at| CurvePoint { time: 0.0, at: *at }).collect();
        let rounded = |at: [f64; 2]| at.map(|part| (part * 1e6).round() / 1e6);
        clipped(&points, |at| at, |at| at).into_iter().map(|point| point.at.map(rounded)).collect()
    }

    #[test]
    fn a_curve_ends_at_the_edge_and_begins_again_where_it_returns() {
        let curve = [Some([0.0, 0.5]), Some([0.2, 1.5]), Some([0.4, 0.5])];
        let expected = [Some([0.0, 0.5]), Some([0.1, 1.0]), None, Some([0.3, 1.0]), Some([0.4, 0.5])];
        assert_eq!(drawn(&curve), expected);
    }

    #[test]
    fn a_simplified_curve_is_as_good_as_the_whole_one() {
        let point = |number: u32| {
            let x = f64::from(number) / 1000.0;
            CurvePoint { time: x, at: (number != 500).then_some([x, 0.2 * libm::sin(20.0 * x)]) }
        };
        let whole: Vec<CurvePoint> = (0..=1000).map(point).collect();
        let drawn = simplified(whole.clone());
        assert!(drawn.len() < 250, "{}", drawn.len());
        assert_eq!(drawn.iter().filter(|point| point.at.is_none()).count(), 1);
        assert_eq!((drawn[0], drawn[drawn.len() - 1]), (whole[0], whole[1000]));
        for point in &whole {
            let near = drawn.windows(2).filter(|pair| (pair[0].time..=pair[1].time).contains(&point.time));
            let distance =
                near.filter_map(|pair| Some(away(point.at?, pair[0].at?, pair[1].at?))).fold(0.0, f64::max);
            assert!(distance <= MAX_DEVIATION, "{point:?}: {distance}");
        }
    }

    /// A spring without damping: its force against its length goes to and fro on a line. Each turn must be kept.
    #[test]
    fn a_curve_that_turns_back_on_itself_keeps_its_turns() {
        let point = |number: u32| {
            let x = 0.5 + 0.4 * libm::cos(f64::from(number) * 0.05);
            CurvePoint { time: f64::from(number), at: Some([x, 1.0 - x]) }
        };
        let drawn = simplified((0..=190).map(point).collect());
        let turns: Vec<f64> = drawn.iter().map(|point| point.time).collect();
        assert!(turns.len() < 10, "{turns:?}");
        for turn in [63.0, 126.0, 188.0] {
            assert!(turns.iter().any(|time| (time - turn).abs() < 2.0), "{turn}: {turns:?}");
        }
    }

    #[test]
    fn points_far_outside_and_undefined_ones_do_not_spoil_the_others() {
        let curve = [Some([0.0, 0.5]), Some([0.5, 1e300]), Some([0.6, f64::NAN]), Some([1.0, 0.5])];
        let parts = drawn(&curve);
        assert_eq!((parts[0], parts[parts.len() - 1]), (curve[0], curve[3]));
        assert!(
            parts.iter().flatten().all(|at| at.iter().all(|part| (0.0..=1.0).contains(part))),
            "{parts:?}"
        );
    }

    #[test]
    fn a_curve_without_points_stays_without_points() {
        assert_eq!(simplified(Vec::new()), []);
        let gap = vec![CurvePoint { time: 0.0, at: None }];
        assert_eq!(simplified(gap.clone()), gap);
    }

    #[test]
    fn a_curve_inside_keeps_its_points_and_gaps() {
        let curve = [Some([0.0, 0.0]), Some([1.0, 1.0]), None, Some([0.5, 0.5])];
        assert_eq!(drawn(&curve), curve);
        assert_eq!(drawn(&[Some([0.2, 3.0]), Some([0.4, 2.0])]), [], "all of it is outside");
        let across = [Some([-1.0, 0.5]), Some([2.0, 0.5])];
        assert_eq!(drawn(&across), [Some([0.0, 0.5]), Some([1.0, 0.5]), None]);
    }
}
