//! Names at the right ends of curves.

use super::PlannedCurve;
use crate::picture::occupancy::Rectangle;

/// A curve that ends farther from the right edge of its plot, as a part of the plot's width, has no name there: nobody would see which name
/// belongs to which curve.
const MAX_DISTANCE_FROM_EDGE: f64 = 0.1;

/// Returns the height at which each curve ends on the right: `None` for a curve without points. The whole result is `None` if a curve ends
/// far from the right edge of the plot, which takes the `area`.
pub(super) fn heights(curves: &[PlannedCurve], area: &Rectangle) -> Option<Vec<Option<f64>>> {
    let nearest = area.right - MAX_DISTANCE_FROM_EDGE * (area.right - area.left);
    let mut heights = Vec::new();
    for curve in curves {
        let points = curve.points.iter().filter_map(|point| point.at);
        let end = points.max_by(|one, other| one[0].total_cmp(&other[0]));
        if end.is_some_and(|[x, _]| x < nearest) {
            return None;
        }
        heights.push(end.map(|[_, y]| y));
    }
    Some(heights)
}

/// Moves heights apart to at least `distance`, as little as possible, within `low` and `high`. `None` if they have no room there.
///
/// Heights that are too near to each other form a group around their mean (pooling adjacent violators; Ayer and others 1955).
#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "there are few names"
)]
pub(super) fn apart(heights: &[f64], distance: f64, [low, high]: [f64; 2]) -> Option<Vec<f64>> {
    let mut order: Vec<usize> = (0..heights.len()).collect();
    order.sort_by(|one, other| heights[*one].total_cmp(&heights[*other]));
    // Without the distances between them, the heights only must not decrease.
    let room = high - low - distance * heights.len().saturating_sub(1) as f64;
    if room < 0.0 {
        return None;
    }
    let mut groups: Vec<(f64, f64)> = Vec::new();
    for (number, index) in order.iter().enumerate() {
        let mut group = (heights[*index] - distance * number as f64, 1.0);
        while let Some(below) = groups.pop_if(|below| below.0 >= group.0) {
            let count = below.1 + group.1;
            group = ((below.0 * below.1 + group.0 * group.1) / count, count);
        }
        groups.push(group);
    }
    let means = groups.into_iter().flat_map(|(mean, count)| std::iter::repeat_n(mean, count as usize));
    let mut moved = vec![0.0; heights.len()];
    for (number, (index, mean)) in order.into_iter().zip(means).enumerate() {
        moved[index] = mean.clamp(low, low + room) + distance * number as f64;
    }
    Some(moved)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_move_apart_as_little_as_they_must() {
        let near = |found: Option<Vec<f64>>, expected: &[f64]| {
            let found = found.unwrap();
            assert!(found.iter().zip(expected).all(|(one, other)| (one - other).abs() < 1e-12), "{found:?}");
        };
        near(apart(&[5.0, 1.0], 1.0, [0.0, 10.0]), &[5.0, 1.0]);
        near(apart(&[5.0, 5.0], 1.0, [0.0, 10.0]), &[4.5, 5.5]);
        near(apart(&[5.2, 5.0, 9.0], 1.0, [0.0, 10.0]), &[5.6, 4.6, 9.0]);
        near(apart(&[0.0, 0.0, 0.5], 1.0, [0.0, 10.0]), &[0.0, 1.0, 2.0]);
        near(apart(&[10.0, 10.0], 1.0, [0.0, 10.0]), &[9.0, 10.0]);
        assert_eq!(apart(&[1.0, 2.0, 3.0], 1.0, [0.0, 1.9]), None);
        assert_eq!(apart(&[], 1.0, [0.0, 1.0]), Some(vec![]));
    }
}
