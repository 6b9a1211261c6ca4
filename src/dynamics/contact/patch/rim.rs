//! Where the rim of a cylinder or a cone is nearest to other curves. There is no closed form, so angles are found by Newton's
//! method, to rounding.

use std::f64::consts::TAU;

use glam::DVec3;

use super::super::nearest::Nearest;
use super::{PARALLEL, Spine, balls};

/// Newton's method starts at the best of so many angles.
const STARTS: u32 = 24;
/// More steps than Newton's method ever needs from there.
const STEPS: u32 = 30;

/// The rim of a flat end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rim {
    pub(super) centre: DVec3,
    /// Out of the body.
    pub(super) axis: DVec3,
    pub(super) radius: f64,
}

impl Rim {
    /// The unit direction from the axis at an angle.
    fn radial(&self, angle: f64) -> DVec3 {
        let x = self.axis.any_orthonormal_vector();
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        cos * x + sin * self.axis.cross(x)
    }

    /// The unit direction from the axis to a place; any where the place is on the axis.
    fn towards(&self, place: DVec3) -> DVec3 {
        let from = place - self.centre;
        let across = from - from.dot(self.axis) * self.axis;
        across.try_normalize().unwrap_or_else(|| self.axis.any_orthonormal_vector())
    }
}

/// Where a rim is nearest to an envelope of balls.
pub(super) fn rim_and_spine(rim: Rim, spine: &Spine) -> Nearest {
    if spine.is_point() {
        let radial = rim.towards(spine.at);
        return balls(rim.centre + rim.radius * radial, 0.0, spine.at, spine.radius, rim.axis);
    }
    let v = spine.along;
    let slope = (1.0 - spine.taper * spine.taper).max(0.0).sqrt();
    // The gap of a place of the rim, but for constants, and its derivatives by the angle.
    let across = |p: DVec3| p - p.dot(v) * v;
    let value = |radial: DVec3| {
        let from = rim.centre + rim.radius * radial - spine.at;
        slope * across(from).length() - spine.taper * from.dot(v)
    };
    let mut angle = start(|angle| value(rim.radial(angle)));
    for _ in 0..STEPS {
        let radial = rim.radial(angle);
        let tangent = rim.radius * rim.axis.cross(radial);
        let (from, bend) = (rim.centre + rim.radius * radial - spine.at, -rim.radius * radial);
        let (d, dt, db) = (across(from), across(tangent), across(bend));
        // Of half the square of the distance, which is smooth also where it is 0.
        let (first, second) = (d.dot(dt), dt.length_squared() + d.dot(db));
        let (first, second) = if spine.taper == 0.0 {
            (first, second)
        } else {
            let h = d.length().max(f64::MIN_POSITIVE);
            (
                slope * first / h - spine.taper * tangent.dot(v),
                slope * (second / h - first * first / (h * h * h)) - spine.taper * bend.dot(v),
            )
        };
        let step = if second > 0.0 { first / second } else { first.signum() * 0.1 };
        let step = step.clamp(-0.3, 0.3);
        angle -= step;
        if step.abs() < 1e-16 {
            break;
        }
    }
    let radial = rim.radial(angle);
    let place = rim.centre + rim.radius * radial;
    let from = place - spine.at;
    let s0 = from.dot(v);
    let h = across(from).length();
    let s = s0 + spine.taper * h / slope;
    let foot = spine.at + s * v;
    if spine.outward == DVec3::ZERO {
        return balls(place, 0.0, foot, spine.radius + spine.taper * s, -radial);
    }
    crossing(place, rim.axis.cross(radial), rim.axis + radial, foot, v, spine.outward, spine.radius)
}

/// Where two rims are nearest.
pub(super) fn rims(a: Rim, b: Rim) -> Nearest {
    let on_b = |place: DVec3| b.centre + b.radius * b.towards(place);
    let mut angle = start(|angle| {
        let place = a.centre + a.radius * a.radial(angle);
        (on_b(place) - place).length()
    });
    let first = b.towards(a.centre + a.radius * a.radial(angle));
    let (x, y) = (first, b.axis.cross(first));
    let radial_b = |other: f64| libm::cos(other) * x + libm::sin(other) * y;
    let mut other = 0.0;
    for _ in 0..STEPS {
        let (ra, rb) = (a.radial(angle), radial_b(other));
        let d = b.centre + b.radius * rb - a.centre - a.radius * ra;
        let (ta, tb) = (a.radius * a.axis.cross(ra), b.radius * b.axis.cross(rb));
        let gradient = [-d.dot(ta), d.dot(tb)];
        let [p, q, r] = [
            ta.length_squared() + a.radius * d.dot(ra),
            -ta.dot(tb),
            tb.length_squared() - b.radius * d.dot(rb),
        ];
        let determinant = p * r - q * q;
        let (da, db) = if p > 0.0 && determinant > 1e-12 * p * r.abs() {
            (
                (r * gradient[0] - q * gradient[1]) / determinant,
                (p * gradient[1] - q * gradient[0]) / determinant,
            )
        } else {
            // Downhill, where Newton's method would go up.
            (0.5 * gradient[0] / ta.length_squared(), 0.5 * gradient[1] / tb.length_squared())
        };
        let (da, db) = (da.clamp(-0.3, 0.3), db.clamp(-0.3, 0.3));
        angle -= da;
        other -= db;
        if da.abs() + db.abs() < 1e-16 {
            break;
        }
    }
    let (ra, rb) = (a.radial(angle), radial_b(other));
    let places = [a.centre + a.radius * ra, b.centre + b.radius * rb];
    crossing(places[0], a.axis.cross(ra), a.axis + ra, places[1], b.axis.cross(rb), b.axis + rb, 0.0)
}

/// Where two edges cross, of which places, directions, and the sides out of their bodies are known. The second edge may
/// be round.
fn crossing(p: DVec3, u: DVec3, out_p: DVec3, q: DVec3, v: DVec3, out_q: DVec3, radius: f64) -> Nearest {
    let cross = u.cross(v);
    let sine = cross.length();
    if sine < PARALLEL.sqrt() {
        return balls(p, 0.0, q, radius, out_p);
    }
    let normal = cross / sine * (cross.dot(out_p - out_q)).signum();
    let gap = (q - p).dot(normal) - radius;
    Nearest { gap, normal, on: [p, q - radius * normal] }
}

/// The angle at which a function is smallest among those at which Newton's method may start.
fn start(value: impl Fn(f64) -> f64) -> f64 {
    let mut best = (f64::INFINITY, 0.0);
    for step in 0..STARTS {
        let angle = TAU * f64::from(step) / f64::from(STARTS);
        let here = value(angle);
        if here < best.0 {
            best = (here, angle);
        }
    }
    best.1
}
