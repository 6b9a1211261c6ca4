//! A bound of the time at which a rim can touch: the lowest point of a nearly flat rim runs around the rim faster than any point of the body
//! moves.

use glam::DVec2;

use super::approach::{Approach, are_convex};
use super::closest_points::ClosestPoints;
use super::patch::Patch;
use super::path::Moving;
use super::solid::ConvexPart;

/// The search for a root ends when the root is known to within this fraction of its value.
const ROOT_TOLERANCE: f64 = 1e-3;

/// The largest number of steps in the search for a root.
const ROOT_STEPS: usize = 50;

impl Approach<'_> {
    /// Computes a lower bound of the time after which any rim of a body can reach the other body, s; at least `most` if none can until then.
    ///
    /// A convex body lies below the plane through its closest point. The height of a point of a rim above this plane, and the rate of this
    /// height, are sines of the angle around the rim. So the least height of all points is known for bodies that move at constant
    /// velocities; `bend` bounds the accelerations, m/s².
    pub(super) fn until_rims(&self, near: &ClosestPoints, moving: &[Moving; 2], bend: f64, most: f64) -> f64 {
        let mut safe = f64::INFINITY;
        for (i, own) in moving.iter().enumerate() {
            let other = 1 - i;
            let solid = self.solids[other];
            let is_below = solid.parts().iter().all(ConvexPart::is_ground) || are_convex(self.solids);
            if solid.is_ball() || !is_below {
                continue;
            }
            let (up, theirs) = (if i == 1 { near.normal } else { -near.normal }, &moving[other]);
            let turning = own.turning - theirs.turning;
            for feature in self.solids[i].parts().iter().flat_map(|part| &part.features) {
                let Patch::Circle { centre, axis, radius } = feature.patch else { continue };
                let centre = own.pose.point(centre);
                let velocity = own.velocity + own.turning.cross(centre - own.pose.location)
                    - theirs.velocity
                    - theirs.turning.cross(centre - theirs.pose.location);
                let (height, rate) = (up.dot(centre - near.on[other]), up.dot(velocity));
                let axis = own.pose.orientation * axis;
                let x = axis.any_orthonormal_vector();
                let y = axis.cross(x);
                let lean = radius * DVec2::new(up.dot(x), up.dot(y));
                let leaning = radius * DVec2::new(up.dot(turning.cross(x)), up.dot(turning.cross(y)));
                let lowest = |t: f64| height + rate * t - (lean + t * leaning).length() - 0.5 * bend * t * t;
                let slope = |t: f64| {
                    let falling = (lean + t * leaning).normalize_or(leaning.normalize_or_zero()).dot(leaning);
                    rate - falling - bend * t
                };
                safe = safe.min(until_root(lowest, slope, self.touch, most));
            }
        }
        safe
    }
}

/// Returns a lower bound of the last time at which a concave function is zero, s; `most` if it is positive until then. If the function
/// begins at zero, to within the gap of touching bodies, it has to rise first. `slope` is its derivative.
fn until_root(value: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64, touch: f64, most: f64) -> f64 {
    let (mut low, mut high) = (0.0, most);
    if value(low) <= touch {
        if slope(high) >= 0.0 {
            return most;
        }
        // The largest value of the function.
        for _ in 0..ROOT_STEPS {
            let middle = 0.5 * (low + high);
            *(if slope(middle) > 0.0 { &mut low } else { &mut high }) = middle;
        }
        high = most;
        if value(low) <= touch {
            return low;
        }
    }
    if value(high) > 0.0 {
        return most;
    }
    for _ in 0..ROOT_STEPS {
        // A chord lies below a concave function, and a tangent above.
        let (start, end) = (value(low), value(high));
        let next = high - end / slope(high);
        low += (high - low) * start / (start - end);
        high = next;
        if high - low <= ROOT_TOLERANCE * low {
            break;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::super::tests::Random;
    use super::*;

    /// Compares the bound with the time at which the lowest of many points of a rim comes down first, for rims at all heights that fall,
    /// rise and tilt.
    #[test]
    fn the_bound_is_just_below_the_time_at_which_the_first_point_comes_down() {
        /// The end of the search, s.
        const MAX_TIME: f64 = 1.0;
        let mut random = Random::new(31);
        let mut landed = 0;
        for _ in 0..300 {
            let [lean, leaning] = [0.01, 1.0].map(|size| size * DVec2::new(random.number(), random.number()));
            let (height, rate) = (lean.length() + 0.1 + 0.1 * random.number(), random.number());
            let bend = 1.0 + random.number();
            let lowest = |t: f64| height + rate * t - (lean + t * leaning).length() - 0.5 * bend * t * t;
            let slope = |t: f64| rate - (lean + t * leaning).normalize().dot(leaning) - bend * t;
            let bound = until_root(lowest, slope, 0.0, MAX_TIME);
            let around = |t: f64| {
                let points = (0..3_600).map(|i| f64::from(i) * std::f64::consts::TAU / 3_600.0);
                let heights = points.map(|angle| {
                    let (sin, cos) = libm::sincos(angle);
                    height + rate * t + DVec2::new(cos, sin).dot(lean + t * leaning) - 0.5 * bend * t * t
                });
                heights.fold(f64::INFINITY, f64::min)
            };
            let is_down = |t: f64| around(t) <= 0.0;
            assert!(!is_down(0.999 * bound), "{bound}");
            if bound < MAX_TIME {
                assert!(is_down(1.002 * bound + 1e-6), "{bound}");
                landed += 1;
            }
        }
        assert!((100..300).contains(&landed), "{landed}");
    }

    /// A rim that touches and rises first comes down again at a known time.
    #[test]
    fn a_rim_that_rises_from_the_ground_comes_down_later() {
        let (value, slope) = (|t: f64| t - t * t, |t: f64| 1.0 - 2.0 * t);
        let bound = until_root(value, slope, 1e-12, 3.0);
        assert!((0.999..=1.0).contains(&bound), "{bound}");
        assert!(until_root(value, slope, 1e-12, 0.5) >= 0.5);
        assert!(until_root(|t: f64| -t, |_| -1.0, 1e-12, 3.0) < 1e-12);
    }
}
