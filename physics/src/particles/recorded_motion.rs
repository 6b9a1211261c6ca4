//! The motion of a body between two known times, found by interpolation.

use glam::{DQuat, DVec3};

use super::BodyState;
use crate::{BodySnapshot, Kinematics, Motion};

/// The interpolated motion of a body from one time to a later time. The location is a cubic polynomial that matches the locations and
/// velocities at both times. The rotation starts with the first angular velocity, and ends at the second orientation.
#[derive(Clone, Copy, Debug)]
pub struct RecordedMotion {
    begin: f64,
    end: f64,
    from: BodySnapshot,
    to: BodySnapshot,
    /// The actual rotation of the body, relative to a rotation at the constant angular velocity of `from`. World axes, rotation axis times
    /// angle, rad.
    rest: DVec3,
}

impl RecordedMotion {
    /// Creates the motion from time `begin` to time `end` (s), with the body's snapshots at these times.
    #[must_use]
    pub fn new(begin: f64, from: BodySnapshot, end: f64, to: BodySnapshot) -> RecordedMotion {
        let turned = DQuat::from_scaled_axis(from.angular_velocity * (end - begin)) * from.orientation;
        let mut rest = to.orientation * turned.conjugate();
        if rest.w < 0.0 {
            rest = -rest;
        }
        RecordedMotion { begin, end, from, to, rest: rest.to_scaled_axis() }
    }

    /// Creates the motion of a body whose location and orientation stay those of `body`. Its velocities may differ from zero, and emitted
    /// particles inherit these velocities.
    #[must_use]
    pub fn still(body: BodySnapshot) -> RecordedMotion {
        RecordedMotion { begin: 0.0, end: 0.0, from: body, to: body, rest: DVec3::ZERO }
    }

    /// Sets the velocities to zero if both times are equal. Returns other motions unchanged.
    pub(super) fn at_rest(self) -> RecordedMotion {
        if self.end > self.begin {
            return self;
        }
        let (velocity, angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
        RecordedMotion::still(BodySnapshot { velocity, angular_velocity, ..self.from })
    }

    /// Returns whether the body neither moves nor rotates between the two times.
    pub(super) fn is_still(&self) -> bool {
        let RecordedMotion { from, to, rest, .. } = self;
        let speeds = [from.velocity, to.velocity, from.angular_velocity, to.angular_velocity, *rest];
        from.location == to.location && speeds == [DVec3::ZERO; 5]
    }

    /// Returns an upper bound for the speed of the centre of mass, m/s.
    pub(super) fn largest_speed(&self) -> f64 {
        let (span, ends) = (self.end - self.begin, [self.from.velocity, self.to.velocity].map(DVec3::length));
        ends[0].max(ends[1]) + 0.5 * span * self.largest_acceleration()
    }

    /// Returns the largest acceleration of the centre of mass, m/s².
    pub(super) fn largest_acceleration(&self) -> f64 {
        // The acceleration is linear in time, so its largest magnitude is at an end.
        self.at(self.begin).acceleration.length().max(self.at(self.end).acceleration.length())
    }

    /// Returns an upper bound for the angular speed of the body, rad/s.
    pub(super) fn largest_turning(&self) -> f64 {
        let span = self.end - self.begin;
        let rest = if span > 0.0 { self.rest.length() / span } else { 0.0 };
        (self.from.angular_velocity.length() + rest).max(self.to.angular_velocity.length())
    }

    /// Returns a box around the path of the centre of mass, as its lowest and its highest corner, m.
    pub(super) fn places(&self) -> [DVec3; 2] {
        let RecordedMotion { begin, end, from, to, .. } = self;
        let (span, way) = (end - begin, to.location - from.location);
        // The Hermite polynomials that multiply the velocities are at most 4/27.
        let aside = (span * from.velocity - way).abs() + (span * to.velocity - way).abs();
        let margin = (4.0 / 27.0) * aside;
        [from.location.min(to.location) - margin, from.location.max(to.location) + margin]
    }

    /// Returns the pose, the velocity and the angular velocity of the body at time `t`, s.
    #[must_use]
    pub fn state(&self, t: f64) -> BodyState {
        let Kinematics { location, velocity, orientation, angular_velocity, .. } = self.at(t);
        BodyState { location, velocity, orientation, angular_velocity }
    }
}

impl Motion for RecordedMotion {
    fn at(&self, t: f64) -> Kinematics {
        let RecordedMotion { begin, end, from, to, rest } = self;
        let span = end - begin;
        if span <= 0.0 {
            return Kinematics {
                location: from.location,
                velocity: from.velocity,
                acceleration: DVec3::ZERO,
                orientation: from.orientation,
                angular_velocity: from.angular_velocity,
            };
        }
        let s = (t - begin) / span;
        let (s2, s3) = (s * s, s * s * s);
        // The location is a sum of Hermite polynomials. The velocity and the acceleration are their derivatives.
        let (way, d0, d1) = (to.location - from.location, from.velocity * span, to.velocity * span);
        let location =
            from.location + (3.0 * s2 - 2.0 * s3) * way + (s3 - 2.0 * s2 + s) * d0 + (s3 - s2) * d1;
        let velocity =
            ((6.0 * s - 6.0 * s2) * way + (3.0 * s2 - 4.0 * s + 1.0) * d0 + (3.0 * s2 - 2.0 * s) * d1) / span;
        let acceleration =
            ((6.0 - 12.0 * s) * way + (6.0 * s - 4.0) * d0 + (6.0 * s - 2.0) * d1) / (span * span);
        let turned = DQuat::from_scaled_axis(from.angular_velocity * (t - begin)) * from.orientation;
        Kinematics {
            location,
            velocity,
            acceleration,
            orientation: (DQuat::from_scaled_axis(s * *rest) * turned).normalize(),
            angular_velocity: from.angular_velocity.lerp(to.angular_velocity, s),
        }
    }

    fn angular_acceleration(&self, _: f64) -> DVec3 {
        let span = self.end - self.begin;
        if span <= 0.0 { DVec3::ZERO } else { (self.to.angular_velocity - self.from.angular_velocity) / span }
    }
}
