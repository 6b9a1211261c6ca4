//! Constraint equations that several kinds of joints share.

use glam::DVec3;

use super::super::{Anchor, BodyId};
use super::member::End;
use super::{Equations, Row, Scale};

/// Returns the bodies of a list of ends, each once, in the order that [`End::all`] expects.
pub(super) fn bodies(ends: &[Anchor]) -> Vec<BodyId> {
    let mut bodies = Vec::new();
    for body in ends.iter().filter_map(|end| end.body()) {
        if !bodies.contains(&body) {
            bodies.push(body);
        }
    }
    bodies
}

/// The vector d from one end to the other, with its length and derivatives. With u = d / |d|, the second derivative of the length is u·d''
/// + (|d'|² − (u·d')²) / |d|.
pub(super) struct EndToEndVector<'a> {
    /// The distance |d| between the two ends of the constraint, m.
    pub(super) length: f64,
    /// The part of |d|'' that does not depend on the accelerations of the bodies, m/s².
    pub(super) bias: f64,
    /// The scale of |d|: the size of the bodies at its ends and its length, and the coordinates whose difference is d.
    pub(super) scale: Scale,
    u: DVec3,
    ends: &'a [End<'a>; 2],
}

impl<'a> EndToEndVector<'a> {
    /// Computes the vector between two ends. `typical` is a typical distance between the ends, m. 1/|d| is bounded as if |d| were at least
    /// a thousandth of this distance.
    #[inline(always)]
    pub(super) fn new(ends: &'a [End<'a>; 2], typical: f64) -> EndToEndVector<'a> {
        let [a, b] = ends;
        let [from, to] = [a.location(), b.location()];
        let apart = to - from;
        let length = apart.length();
        let shortest = 1e-3 * typical;
        let (u, inverse) = if length > shortest {
            EndToEndVector::along(apart, length)
        } else {
            EndToEndVector::short(apart, length, shortest)
        };
        let mut rate = b.member.velocity - a.member.velocity;
        let mut bias = 0.0;
        for (end, sign) in [(a, -1.0), (b, 1.0)] {
            if end.is_off_centre {
                let (turning, bend) = end.turning();
                rate += sign * turning;
                bias += sign * u.dot(bend);
            }
        }
        let along = u.dot(rate);
        bias += (rate.length_squared() - along * along) * inverse;
        let scale = scale([a, b], from, to).at_least(length);
        EndToEndVector { length, bias, scale, u, ends }
    }

    /// Returns the unit vector u from the first end to the second.
    pub(super) fn direction(&self) -> DVec3 {
        self.u
    }

    /// Returns the unit vector u along the vector d between two ends, and 1/|d|.
    #[inline(always)]
    fn along(apart: DVec3, length: f64) -> (DVec3, f64) {
        let inverse = length.recip();
        (apart * inverse, inverse)
    }

    /// Returns the unit vector u along a very short vector d between two ends, and a bounded 1/|d|.
    #[cold]
    fn short(apart: DVec3, length: f64, shortest: f64) -> (DVec3, f64) {
        // If both ends are at the same point, the direction is arbitrary.
        let u = if length > 0.0 { apart * length.recip() } else { DVec3::Y };
        (u, shortest.recip())
    }

    /// Adds `factor` times the derivative of the distance to the Jacobian of a row.
    pub(super) fn write(&self, factor: f64, row: usize, equations: &mut Equations<'_>) {
        for (body, linear, angular) in self.directions(factor) {
            equations.direction(row, body, linear, angular);
        }
    }

    /// Writes the single constraint row of a rod or a rope: c = `sign` (|d| − `length`).
    #[inline(always)]
    pub(super) fn write_only(&self, sign: f64, length: f64, equations: &mut Equations<'_>) {
        let scale = self.scale.at_least(length);
        let (violation, bias) = (sign * (self.length - length), sign * self.bias);
        equations.only_row(Row { violation, rate: 0.0, bias, scale }, self.directions(sign));
    }

    #[inline(always)]
    fn directions(&self, factor: f64) -> [(Option<usize>, DVec3, DVec3); 2] {
        [(0, -factor), (1, factor)].map(|(i, factor): (usize, f64)| {
            let (end, linear) = (&self.ends[i], factor * self.u);
            let angular = if end.is_off_centre { end.arm.cross(linear) } else { DVec3::ZERO };
            (end.body, linear, angular)
        })
    }
}

/// Returns the scale of an equation between the locations of two ends, m.
#[inline(always)]
pub(super) fn scale([a, b]: [&End<'_>; 2], from: DVec3, to: DVec3) -> Scale {
    let terms = from.abs().max(to.abs()).max(a.arm.abs()).max(b.arm.abs()).max_element();
    Scale::length(a.size().max(b.size()), terms)
}

/// Writes three constraint rows that keep two points at the same place.
pub(super) fn same_point([a, b]: &[End<'_>; 2], first: usize, equations: &mut Equations<'_>) {
    let [from, to] = [a.location(), b.location()];
    let (apart, bias) = (to - from, b.motion().1 - a.motion().1);
    let scale = scale([a, b], from, to);
    for (i, axis) in DVec3::AXES.into_iter().enumerate() {
        equations.row(first + i, apart[i], bias[i], scale);
        equations.direction(first + i, a.body, -axis, -a.arm.cross(axis));
        equations.direction(first + i, b.body, axis, b.arm.cross(axis));
    }
}

/// Writes one constraint row that keeps the vectors `u` and `w` perpendicular. `u` rotates with the first end, `w` with the second. Both
/// are unit vectors in world axes.
pub(super) fn perpendicular(
    [a, b]: &[End<'_>; 2],
    u: DVec3,
    w: DVec3,
    row: usize,
    equations: &mut Equations<'_>,
) {
    let [first, second] = [a.angular_velocity(), b.angular_velocity()];
    let (u_rate, w_rate) = (first.cross(u), second.cross(w));
    let bias = first.cross(u_rate).dot(w) + 2.0 * u_rate.dot(w_rate) + u.dot(second.cross(w_rate));
    equations.row(row, u.dot(w), bias, Scale::ANGLE);
    equations.direction(row, a.body, DVec3::ZERO, u.cross(w));
    equations.direction(row, b.body, DVec3::ZERO, w.cross(u));
}

/// Writes three constraint rows that keep the second end from rotating relative to the first. `turned` is the rotation from the body axes
/// of the first end to those of the second.
pub(super) fn same_turn(
    ends: &[End<'_>; 2],
    turned: glam::DQuat,
    first: usize,
    equations: &mut Equations<'_>,
) {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let of_first = axes.map(|axis| ends[0].orientation() * axis);
    let of_second = axes.map(|axis| ends[1].orientation() * (turned * axis));
    for i in 0..3 {
        perpendicular(ends, of_first[i], of_second[(i + 1) % 3], first + i, equations);
    }
}

/// Writes one constraint row that keeps the vector from the first end to the second perpendicular to `u`, a unit vector in world axes that
/// rotates with the first end.
pub(super) fn beside([a, b]: &[End<'_>; 2], u: DVec3, row: usize, equations: &mut Equations<'_>) {
    let [from, to] = [a.location(), b.location()];
    let [(from_rate, from_bend), (to_rate, to_bend)] = [a.motion(), b.motion()];
    let apart = to - from;
    let omega = a.angular_velocity();
    let u_rate = omega.cross(u);
    let bias =
        u.dot(to_bend - from_bend) + 2.0 * u_rate.dot(to_rate - from_rate) + omega.cross(u_rate).dot(apart);
    let scale = scale([a, b], from, to).at_least(apart.abs().max_element());
    equations.row(row, u.dot(apart), bias, scale);
    equations.direction(row, a.body, -u, u.cross(apart + a.arm));
    equations.direction(row, b.body, u, b.arm.cross(u));
}

/// Returns two unit vectors that are perpendicular to the unit vector `axis` and to each other.
pub(super) fn across(axis: DVec3) -> [DVec3; 2] {
    let (u, w) = axis.any_orthonormal_pair();
    [u, w]
}
