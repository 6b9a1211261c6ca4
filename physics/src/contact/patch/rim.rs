//! The closest points of the rim of a cylinder or cone and an edge or another rim. There is no closed form: Newton's method finds the
//! angle on the rim, to within rounding errors.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use glam::DVec3;

use super::super::closest_points::{ClosestPoints, DEEP_OVERLAP, FEATURE_TOLERANCE};
use super::{PARALLEL_SINE, Spine, balls, radial};

/// The number of equally spaced angles on the rim. Newton's method starts at the best of them.
const START_ANGLES: usize = 24;
/// The largest number of Newton steps or halvings. So many halvings shrink an interval to rounding errors.
const MAX_STEPS: u32 = 60;

/// The circular rim of a flat end of a cylinder or cone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rim {
    pub(super) centre: DVec3,
    /// The unit normal of the flat end, out of the body.
    pub(super) axis: DVec3,
    pub(super) radius: f64,
}

impl Rim {
    /// Returns the radial unit vectors of the rim at the angles 0 and 90°.
    fn radials(&self) -> [DVec3; 2] {
        let x = self.axis.any_orthonormal_vector();
        [x, self.axis.cross(x)]
    }

    /// Returns the edge at the end of a radial unit vector.
    fn edge(&self, radial: DVec3) -> Edge {
        let place = self.centre + self.radius * radial;
        Edge { place, along: self.axis.cross(radial), outward: self.axis + radial }
    }

    /// Returns the radial unit vector that points from the rim's axis to a given point. For a point on the axis, any radial direction will
    /// do.
    fn towards(&self, place: DVec3) -> DVec3 {
        radial(place - self.centre, self.axis).unwrap_or_else(|| self.axis.any_orthonormal_vector())
    }
}

/// An angle on a rim, with its sine and cosine.
#[derive(Clone, Copy)]
struct Angle {
    radians: f64,
    sin: f64,
    cos: f64,
}

impl Angle {
    fn of(radians: f64) -> Angle {
        Angle { radians, sin: libm::sin(radians), cos: libm::cos(radians) }
    }

    /// Returns the radial unit vector at this angle, from those at the angles 0 and 90°.
    fn radial(self, [x, y]: [DVec3; 2]) -> DVec3 {
        self.cos * x + self.sin * y
    }
}

/// Equally spaced angles on a rim.
static STARTS: LazyLock<[Angle; START_ANGLES]> =
    LazyLock::new(|| std::array::from_fn(|step| Angle::of(START_SPACING * step as f64)));

/// The distance of two neighboring start angles, rad.
const START_SPACING: f64 = TAU / START_ANGLES as f64;

/// Computes the closest points of a rim and an envelope of balls (an edge, a round side, or a ball).
pub(super) fn rim_and_spine(rim: Rim, spine: &Spine) -> ClosestPoints {
    if spine.is_point() {
        let radial = rim.towards(spine.at);
        return balls(rim.centre + rim.radius * radial, 0.0, spine.at, spine.radius, rim.axis);
    }
    let v = spine.along;
    let slope = (1.0 - spine.taper * spine.taper).max(0.0).sqrt();
    // The gap at a point of the rim, without its constant part.
    let across = |p: DVec3| p - p.dot(v) * v;
    let value = |radial: DVec3| {
        let from = rim.centre + rim.radius * radial - spine.at;
        slope * across(from).length() - spine.taper * from.dot(v)
    };
    // A point beyond the end of the edge counts as farther away, so the search starts near the edge.
    let beyond = |radial: DVec3| {
        let from = rim.centre + rim.radius * radial - spine.at;
        (from.dot(v).abs() - spine.half).max(0.0)
    };
    let radials = rim.radials();
    let gap = |angle: Angle| {
        let radial = angle.radial(radials);
        let (gap, beyond) = (value(radial) - spine.radius, beyond(radial));
        if beyond > 0.0 { libm::hypot(gap.max(0.0), beyond) } else { gap }
    };
    let angle = lowest(gap, |angle| {
        let radial = angle.radial(radials);
        let tangent = rim.radius * rim.axis.cross(radial);
        let (from, bend) = (rim.centre + rim.radius * radial - spine.at, -rim.radius * radial);
        let (d, dt, db) = (across(from), across(tangent), across(bend));
        // The derivatives of half the squared distance, which is smooth even where the distance is 0.
        let (first, second) = (d.dot(dt), dt.length_squared() + d.dot(db));
        if spine.taper == 0.0 {
            return [first, second];
        }
        let h = d.length().max(f64::MIN_POSITIVE);
        [
            slope * first / h - spine.taper * tangent.dot(v),
            slope * (second / h - first * first / (h * h * h)) - spine.taper * bend.dot(v),
        ]
    });
    let radial = angle.radial(radials);
    let place = rim.centre + rim.radius * radial;
    let from = place - spine.at;
    let s0 = from.dot(v);
    let h = across(from).length();
    let s = s0 + spine.taper * h / slope;
    let foot = spine.at + s * v;
    if spine.outward == DVec3::ZERO {
        return balls(place, 0.0, foot, spine.radius + spine.taper * s, -radial);
    }
    let edge = Edge { place: foot, along: v, outward: spine.outward };
    crossing(&rim.edge(radial), &edge, spine.radius, rim.radius.min(spine.half))
}

/// Computes the closest points of two rims.
pub(super) fn rims(a: Rim, b: Rim) -> ClosestPoints {
    let radials = a.radials();
    let place_a = |angle: Angle| a.centre + a.radius * angle.radial(radials);
    let gap = |angle: Angle| {
        let place = place_a(angle);
        (b.centre + b.radius * b.towards(place) - place).length()
    };
    // The derivatives of half the squared distance to the closest point of the other rim.
    let angle = lowest(gap, |angle| {
        let place = place_a(angle);
        let (ra, rb) = (angle.radial(radials), b.towards(place));
        let d = b.centre + b.radius * rb - place;
        let (ta, tb) = (a.radius * a.axis.cross(ra), b.radius * b.axis.cross(rb));
        let own = ta.length_squared() + a.radius * d.dot(ra);
        let other = tb.length_squared() - b.radius * d.dot(rb);
        let both = ta.dot(tb);
        [-d.dot(ta), own - both * both / other]
    });
    let (ra, rb) = (angle.radial(radials), b.towards(place_a(angle)));
    crossing(&a.edge(ra), &b.edge(rb), 0.0, a.radius.min(b.radius))
}

/// An edge at one of its points.
struct Edge {
    place: DVec3,
    /// The unit direction of the edge.
    along: DVec3,
    /// A vector out of the body.
    outward: DVec3,
}

/// Computes the contact of two crossing edges, of which the second may be round, with a radius. `size` is a typical length of the bodies, m.
fn crossing(a: &Edge, b: &Edge, radius: f64, size: f64) -> ClosestPoints {
    let (between, outward) = (b.place - a.place, a.outward - b.outward);
    let cross = a.along.cross(b.along);
    let sine = cross.length();
    let normal = if sine > PARALLEL_SINE.sqrt() {
        cross / sine * cross.dot(outward).signum()
    } else {
        // The nearest points of the rims of two cones side by side have the same tangent. If the rims touch, both points are the same, so the
        // vector between them gives no normal.
        let normal = radial(outward, a.along).unwrap_or(a.outward.normalize());
        let is_far = between.length() > DEEP_OVERLAP * size || between.dot(normal) > FEATURE_TOLERANCE * size;
        if radius > 0.0 || is_far {
            return balls(a.place, 0.0, b.place, radius, a.outward);
        }
        normal
    };
    let gap = between.dot(normal) - radius;
    ClosestPoints { gap, normal, on: [a.place, b.place - radius * normal] }
}

/// Returns the angle of the smallest minimum of a periodic function, rad, to within rounding errors. `derivatives` returns its first and
/// second derivative.
///
/// The search is Newton's method within an interval. A step that would leave the interval is replaced by a halving.
fn lowest(value: impl Fn(Angle) -> f64, derivatives: impl Fn(Angle) -> [f64; 2]) -> Angle {
    let mut best = (f64::INFINITY, STARTS[0]);
    for &angle in STARTS.iter() {
        let here = value(angle);
        if here < best.0 {
            best = (here, angle);
        }
    }
    let mut angle = best.1;
    let (mut low, mut high) = (angle.radians - START_SPACING, angle.radians + START_SPACING);
    // The coarse search takes the ends of an edge into account, but the derivatives do not. The minimum may therefore lie outside of the
    // interval.
    for _ in 0..START_ANGLES {
        if derivatives(Angle::of(low))[0] > 0.0 {
            low -= START_SPACING;
        } else if derivatives(Angle::of(high))[0] < 0.0 {
            high += START_SPACING;
        } else {
            break;
        }
    }
    for _ in 0..MAX_STEPS {
        let [first, second] = derivatives(angle);
        if first > 0.0 {
            high = angle.radians;
        } else {
            low = angle.radians;
        }
        let next = angle.radians - first / second;
        let next = if second > 0.0 && next >= low && next <= high { next } else { 0.5 * (low + high) };
        let step = next - angle.radians;
        angle = Angle::of(next);
        // Newton's method can go to and fro between two numbers that are neighbors.
        if step.abs() <= f64::EPSILON * next.abs().max(1.0) || first == 0.0 {
            break;
        }
    }
    angle
}
