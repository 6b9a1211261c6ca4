//! The equations that joints are made of.

use glam::DVec3;

use super::super::{Anchor, BodyId};
use super::Equations;
use super::member::End;

/// The bodies of some ends, each once, in the order in which [`End::all`] takes them.
pub(super) fn bodies(ends: &[Anchor]) -> Vec<BodyId> {
    let mut bodies = Vec::new();
    for body in ends.iter().filter_map(|end| end.body()) {
        if !bodies.contains(&body) {
            bodies.push(body);
        }
    }
    bodies
}

/// The way from one end to another: its length |d|, whose second derivative is u·d'' + (|d'|² − (u·d')²) / |d|, u = d / |d|.
pub(super) struct Way {
    /// |d|, m.
    pub(super) length: f64,
    /// The part of |d|'' that does not come from accelerations of the bodies, m/s².
    pub(super) bias: f64,
    /// The size of the coordinates that it is a difference of, m.
    pub(super) scale: f64,
    u: DVec3,
    arms: [(Option<usize>, DVec3); 2],
}

impl Way {
    /// The way between two ends; `typical` is what its length is about, m.
    pub(super) fn new([a, b]: &[End; 2], typical: f64) -> Way {
        let apart = b.location - a.location;
        let length = apart.length();
        // Two ends at the same point have no direction; any one leads them apart.
        let u = if length > 0.0 { apart * length.recip() } else { DVec3::Y };
        let rate = b.velocity - a.velocity;
        let across = rate - rate.dot(u) * u;
        let bias =
            u.dot(b.centripetal - a.centripetal) + across.length_squared() / length.max(1e-3 * typical);
        let scale = a.location.abs().max(b.location.abs()).max_element();
        Way { length, bias, scale, u, arms: [(a.body, a.arm), (b.body, b.arm)] }
    }

    /// Adds `factor` times the directions of its length to a row.
    pub(super) fn write(&self, factor: f64, row: usize, equations: &mut Equations<'_>) {
        for ((body, arm), sign) in self.arms.into_iter().zip([-factor, factor]) {
            let linear = sign * self.u;
            equations.direction(row, body, linear, arm.cross(linear));
        }
    }
}

/// Three rows: two points are the same.
pub(super) fn same_point([a, b]: &[End; 2], first: usize, equations: &mut Equations<'_>) {
    let apart = b.location - a.location;
    let bias = b.centripetal - a.centripetal;
    let scale = a.location.abs().max(b.location.abs()).max(a.arm.abs()).max(b.arm.abs());
    for (i, axis) in DVec3::AXES.into_iter().enumerate() {
        equations.row(first + i, apart[i], bias[i], scale.max_element());
        equations.direction(first + i, a.body, -axis, -a.arm.cross(axis));
        equations.direction(first + i, b.body, axis, b.arm.cross(axis));
    }
}

/// One row: `u`, which turns with the first end, is perpendicular to `w`, which turns with the second. Both are unit
/// vectors in world axes.
pub(super) fn perpendicular(
    [a, b]: &[End; 2],
    u: DVec3,
    w: DVec3,
    row: usize,
    equations: &mut Equations<'_>,
) {
    let (u_rate, w_rate) = (a.angular_velocity.cross(u), b.angular_velocity.cross(w));
    let bias = a.angular_velocity.cross(u_rate).dot(w)
        + 2.0 * u_rate.dot(w_rate)
        + u.dot(b.angular_velocity.cross(w_rate));
    equations.row(row, u.dot(w), bias, 1.0);
    equations.direction(row, a.body, DVec3::ZERO, u.cross(w));
    equations.direction(row, b.body, DVec3::ZERO, w.cross(u));
}

/// Three rows: the second end is not turned against the first. `turned` are the axes of the first end's frame as they stand
/// in that of the second where the rows hold.
pub(super) fn same_turn(ends: &[End; 2], turned: glam::DQuat, first: usize, equations: &mut Equations<'_>) {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let of_first = axes.map(|axis| ends[0].orientation * axis);
    let of_second = axes.map(|axis| ends[1].orientation * (turned * axis));
    for i in 0..3 {
        perpendicular(ends, of_first[i], of_second[(i + 1) % 3], first + i, equations);
    }
}

/// One row: the way from the first end to the second is perpendicular to `u`, which turns with the first.
pub(super) fn beside([a, b]: &[End; 2], u: DVec3, row: usize, equations: &mut Equations<'_>) {
    let apart = b.location - a.location;
    let rate = b.velocity - a.velocity;
    let u_rate = a.angular_velocity.cross(u);
    let bias = u.dot(b.centripetal - a.centripetal)
        + 2.0 * u_rate.dot(rate)
        + a.angular_velocity.cross(u_rate).dot(apart);
    let scale = a.location.abs().max(b.location.abs()).max_element();
    equations.row(row, u.dot(apart), bias, scale);
    equations.direction(row, a.body, -u, u.cross(apart + a.arm));
    equations.direction(row, b.body, u, b.arm.cross(u));
}

/// Two unit vectors that are perpendicular to a unit vector and to each other.
pub(super) fn across(axis: DVec3) -> [DVec3; 2] {
    let (u, w) = axis.any_orthonormal_pair();
    [u, w]
}
