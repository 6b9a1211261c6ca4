//! The free coordinate of a hinge or a slider: its angle or its displacement.

use glam::DVec3;

use super::super::{Anchor, BodyId, BodySnapshot};
use super::member::{End, Member};
use super::{Equations, Members, Scale};

/// The free coordinate of a joint: the angle of a hinge, or the displacement of a slider. It is measured at the second end, relative to
/// the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinate {
    /// The two ends of the joint.
    pub between: [Anchor; 2],
    /// The axis of the joint, a unit vector, in the body axes of the first end.
    pub axis: DVec3,
    /// For an angle: two directions perpendicular to the axis, one in the body axes of each end. The directions coincide at angle 0.
    /// `None` for a displacement.
    pub zero: Option<[DVec3; 2]>,
}

/// The value and derivatives of a joint's free coordinate at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Free {
    /// The value of the coordinate: rad, from −π to π, or m.
    pub(super) value: f64,
    /// The part of the coordinate's second time derivative that does not depend on the accelerations of the bodies.
    bias: f64,
    /// The scale of the coordinate.
    pub(super) scale: Scale,
    /// For each end: its body, and the derivatives of the coordinate with respect to the body's position and rotation.
    parts: [(Option<usize>, DVec3, DVec3); 2],
}

impl Coordinate {
    /// Returns true if the coordinate is an angle, and false if it is a displacement.
    #[must_use]
    pub fn is_angle(&self) -> bool {
        self.zero.is_some()
    }

    /// Returns the coordinate and its rate: rad (from −π to π) and rad/s, or m and m/s. The closure `body` returns the snapshot of a body.
    /// Returns `None` while a body of the joint is absent.
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

    /// Returns the axis of the joint, a unit vector in world axes. The closure `body` returns the snapshot of a body. Returns `None` while
    /// the body of the first end is absent.
    pub fn axis_seen(&self, body: impl Fn(BodyId) -> Option<BodySnapshot>) -> Option<DVec3> {
        Some(match self.between[0].body() {
            Some(id) => body(id)?.orientation * self.axis,
            None => self.axis,
        })
    }

    /// Computes the coordinate and its derivatives from the current state of the two ends.
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
                    scale: Scale::ANGLE,
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
                    scale: super::parts::scale([a, b], from, to).at_least(apart.abs().max_element()),
                    parts: [(a.body, -axis, axis.cross(apart + a.arm)), (b.body, axis, b.arm.cross(axis))],
                }
            }
        }
    }

    /// Computes the coordinate twice: now, and at the start of the step.
    pub(super) fn measure_both(&self, members: &Members<'_>) -> [Free; 2] {
        [*members, members.at_origin()].map(|members| self.measure(&End::all(&self.between, &members)))
    }

    /// Returns the difference `to` − `from` of two values of the coordinate. For angles, the result is between −π and π.
    pub(super) fn difference(&self, to: f64, from: f64) -> f64 {
        if self.is_angle() { libm::remainder(to - from, std::f64::consts::TAU) } else { to - from }
    }

    /// Computes the time derivative of the coordinate, rad/s or m/s.
    pub(super) fn rate([a, b]: &[End<'_>; 2], free: &Free) -> f64 {
        let rate = |end: &End<'_>, (_, linear, angular): (Option<usize>, DVec3, DVec3)| {
            linear.dot(end.member.velocity) + angular.dot(end.angular_velocity())
        };
        rate(a, free.parts[0]) + rate(b, free.parts[1])
    }

    /// Returns the body of each end, and the force and torque on this body under a unit generalized force along the coordinate.
    pub(super) fn directions(free: &Free) -> [(Option<usize>, DVec3, DVec3); 2] {
        free.parts
    }
}

/// A constraint equation c = 0 between the free coordinates of joints.
pub(super) struct CoordinateRow<'a> {
    /// The index of the equation among the rows of its constraint.
    pub(super) row: usize,
    /// The coordinates in the equation, each with its factor.
    pub(super) terms: &'a [(f64, Free)],
    /// The value of c, the left-hand side; 0 if the equation holds.
    pub(super) violation: f64,
    /// ∂c/∂t, the partial derivative of the equation with respect to time.
    pub(super) rate: f64,
    /// ∂²c/∂t², the second partial derivative of the equation with respect to time.
    pub(super) curvature: f64,
}

impl CoordinateRow<'_> {
    /// Writes the equation and its Jacobian into the rows of its constraint.
    pub(super) fn write(self, equations: &mut Equations<'_>) {
        let (mut bias, mut scale) = (self.curvature, Scale::default());
        for (factor, free) in self.terms {
            bias += factor * free.bias;
            let Scale { size, terms, is_length } = free.scale;
            let (size, terms) = (factor.abs() * size, factor.abs() * terms);
            // The last coordinate has no factor but a sign, so the equation has its unit.
            scale = Scale { is_length, ..scale.max(Scale { size, terms, is_length }) };
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
