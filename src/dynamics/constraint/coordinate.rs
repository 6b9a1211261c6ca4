//! The free coordinate of a hinge or a slider: an angle or a displacement.

use glam::DVec3;

use super::super::{Anchor, BodyId, BodySnapshot};
use super::member::{End, Member};
use super::{Equations, Members};

/// The angle of a hinge or the displacement of a slider: that of the second end relative to the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinate {
    /// The two points.
    pub between: [Anchor; 2],
    /// The axis, a unit vector, in the axes of the first end.
    pub axis: DVec3,
    /// For an angle: two directions perpendicular to the axis, one in the axes of each end. They coincide where the angle is 0.
    /// `None` for a displacement.
    pub zero: Option<[DVec3; 2]>,
}

/// A coordinate at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Free {
    /// Its value, rad (from −π to π) or m.
    pub(super) value: f64,
    /// The part of its second derivative that does not depend on the accelerations of the bodies.
    bias: f64,
    /// The size of the terms whose difference is the value, for rounding errors.
    pub(super) scale: f64,
    /// For each end: its body, and the derivatives of the value by the body's position and rotation.
    parts: [(Option<usize>, DVec3, DVec3); 2],
}

impl Coordinate {
    /// Whether it is an angle.
    #[must_use]
    pub fn is_angle(&self) -> bool {
        self.zero.is_some()
    }

    /// The coordinate and its rate: rad (from −π to π) and rad/s, or m and m/s. The closure returns the snapshot of a body. `None` while
    /// a body is absent.
    pub fn seen(&self, body: impl Fn(BodyId) -> Option<BodySnapshot>) -> Option<[f64; 2]> {
        let mut all = [Member::default(); 2];
        let ids = super::parts::bodies(&self.between);
        for (member, id) in all.iter_mut().zip(ids) {
            let BodySnapshot { location, orientation, velocity, angular_velocity, .. } = body(id)?;
            *member = Member { location, velocity, orientation, angular_velocity, ..Member::default() };
        }
        let members =
            Members { all: &all, of: &[0, 1], time: 0.0, origin: &all, begun: 0.0, is_aiming: false };
        let ends = End::all(&self.between, &members);
        let free = self.measure(&ends);
        Some([free.value, Coordinate::rate(&ends, &free)])
    }

    /// The coordinate for the current ends.
    pub(super) fn measure(&self, [a, b]: &[End<'_>; 2]) -> Free {
        let axis = a.orientation() * self.axis;
        match self.zero {
            Some(zero) => {
                let (u, w) = (a.orientation() * zero[0], b.orientation() * zero[1]);
                let parts = [(a.body, DVec3::ZERO, -axis), (b.body, DVec3::ZERO, axis)];
                let relative = b.angular_velocity() - a.angular_velocity();
                Free {
                    value: libm::atan2(axis.dot(u.cross(w)), u.dot(w)),
                    bias: a.angular_velocity().cross(axis).dot(relative),
                    scale: 1.0,
                    parts,
                }
            }
            None => {
                let [from, to] = [a.location(), b.location()];
                let [(from_rate, from_bend), (to_rate, to_bend)] = [a.motion(), b.motion()];
                let apart = to - from;
                let omega = a.angular_velocity();
                let axis_rate = omega.cross(axis);
                Free {
                    value: axis.dot(apart),
                    bias: axis.dot(to_bend - from_bend)
                        + 2.0 * axis_rate.dot(to_rate - from_rate)
                        + omega.cross(axis_rate).dot(apart),
                    scale: from.abs().max(to.abs()).max_element(),
                    parts: [(a.body, -axis, axis.cross(apart + a.arm)), (b.body, axis, b.arm.cross(axis))],
                }
            }
        }
    }

    /// The coordinate now, and at the start of the step.
    pub(super) fn measure_both(&self, members: &Members<'_>) -> [Free; 2] {
        [*members, members.at_origin()].map(|members| self.measure(&End::all(&self.between, &members)))
    }

    /// The difference of two values; for angles, in the shorter direction.
    pub(super) fn difference(&self, to: f64, from: f64) -> f64 {
        if self.is_angle() { libm::remainder(to - from, std::f64::consts::TAU) } else { to - from }
    }

    /// The rate of the coordinate, rad/s or m/s.
    pub(super) fn rate([a, b]: &[End<'_>; 2], free: &Free) -> f64 {
        let rate = |end: &End<'_>, (_, linear, angular): (Option<usize>, DVec3, DVec3)| {
            linear.dot(end.member.velocity) + angular.dot(end.angular_velocity())
        };
        rate(a, free.parts[0]) + rate(b, free.parts[1])
    }

    /// For each end, its body, and the force and torque on it under a generalised force of 1.
    pub(super) fn directions(free: &Free) -> [(Option<usize>, DVec3, DVec3); 2] {
        free.parts
    }
}

/// One equation between coordinates.
pub(super) struct CoordinateRow<'a> {
    /// Its number among the rows of the constraint.
    pub(super) row: usize,
    /// The factor of each coordinate.
    pub(super) terms: &'a [(f64, Free)],
    /// c.
    pub(super) violation: f64,
    /// ∂c/∂t.
    pub(super) rate: f64,
    /// ∂²c/∂t².
    pub(super) curvature: f64,
}

impl CoordinateRow<'_> {
    /// Writes the equation.
    pub(super) fn write(self, equations: &mut Equations<'_>) {
        let (mut bias, mut scale) = (self.curvature, f64::MIN_POSITIVE);
        for (factor, free) in self.terms {
            bias += factor * free.bias;
            scale = scale.max(factor.abs() * free.scale);
        }
        equations.row(self.row, self.violation, bias, scale);
        equations.moving(self.row, self.rate);
        for (factor, free) in self.terms {
            for (body, linear, angular) in free.parts {
                equations.direction(self.row, body, *factor * linear, *factor * angular);
            }
        }
    }
}
