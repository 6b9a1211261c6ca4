//! The rates of a contact point and of its normal, as the contact moves over two bodies.

use glam::{DQuat, DVec3};

use super::super::constraint::Member;
use super::closest_points::ClosestPoints;
use super::patch::{PARALLEL_SINE, Patch, meet};
use super::solid::Pose;

/// The step of numerical differentiation, for contacts without a formula. The bodies rotate by about this angle (rad), or move by this
/// fraction of their size.
const DIFFERENTIATION_STEP: f64 = 1e-4;

/// The rates at which the point and the normal of a contact change, for given velocities of the bodies.
pub(super) struct ContactRates {
    /// The time derivative of the unit contact normal, 1/s.
    pub(super) normal: DVec3,
    /// The velocity of the contact point, m/s. The contact point moves over the surfaces; it is no material point of a body.
    pub(super) place: DVec3,
}

/// A vector (a point of a body, or a direction) and its time derivative.
#[derive(Clone, Copy)]
struct Rated {
    value: DVec3,
    rate: DVec3,
}

impl Rated {
    fn point(member: &Member, at: DVec3) -> Rated {
        let arm = member.orientation * at;
        Rated { value: member.location + arm, rate: member.velocity + member.angular_velocity.cross(arm) }
    }

    fn direction(member: &Member, along: DVec3) -> Rated {
        let value = member.orientation * along;
        Rated { value, rate: member.angular_velocity.cross(value) }
    }

    fn minus(self, other: Rated) -> Rated {
        Rated { value: self.value - other.value, rate: self.rate - other.rate }
    }

    fn plus(self, other: Rated) -> Rated {
        Rated { value: self.value + other.value, rate: self.rate + other.rate }
    }

    fn cross(self, other: Rated) -> Rated {
        let rate = self.rate.cross(other.value) + self.value.cross(other.rate);
        Rated { value: self.value.cross(other.value), rate }
    }

    /// Returns the dot product of two vectors, and its rate.
    fn dot(self, other: Rated) -> [f64; 2] {
        [self.value.dot(other.value), self.rate.dot(other.value) + self.value.dot(other.rate)]
    }

    /// Returns the vector times a number that is given with its rate.
    fn times(self, [number, rate]: [f64; 2]) -> Rated {
        Rated { value: number * self.value, rate: number * self.rate + rate * self.value }
    }

    /// Returns the component perpendicular to a unit direction, with its rate.
    fn across(self, unit: Rated) -> Rated {
        self.minus(unit.times(self.dot(unit)))
    }

    fn normalized(self) -> Option<Rated> {
        let length = self.value.length();
        if length == 0.0 {
            return None;
        }
        let unit = self.value / length;
        Some(Rated { value: unit, rate: (self.rate - self.rate.dot(unit) * unit) / length })
    }
}

impl ContactRates {
    /// Computes the rates of the contact between two patches, whose closest points are `meeting`. `size` is a typical length of the smaller
    /// body, m.
    pub(super) fn of(
        patches: [&Patch; 2],
        members: [&Member; 2],
        meeting: &ClosestPoints,
        size: f64,
    ) -> ContactRates {
        ContactRates::exact(patches, members, meeting)
            .or_else(|| {
                let [a, b] = patches;
                let swapped = ContactRates::exact([b, a], [members[1], members[0]], &meeting.flipped())?;
                Some(ContactRates { normal: -swapped.normal, ..swapped })
            })
            .unwrap_or_else(|| ContactRates::numeric(patches, members, size))
    }

    /// Computes the rates in closed form. `None` if there is no formula for these two patches in this order.
    fn exact(
        [a, b]: [&Patch; 2],
        [first, second]: [&Member; 2],
        meeting: &ClosestPoints,
    ) -> Option<ContactRates> {
        match (a, b) {
            (Patch::Plane { normal, .. }, Patch::Point { at, radius }) => {
                let normal = Rated::direction(first, *normal);
                let centre = Rated::point(second, *at);
                Some(ContactRates { normal: normal.rate, place: centre.rate - *radius * normal.rate })
            }
            (Patch::Plane { normal, .. }, Patch::Circle { centre, axis, radius }) => {
                let normal = Rated::direction(first, *normal);
                let axis = Rated::direction(second, *axis);
                // The lowest point of the rim is opposite to the normal's component across the axis.
                let up = normal.across(axis).normalized()?;
                let centre = Rated::point(second, *centre);
                Some(ContactRates { normal: normal.rate, place: centre.rate - *radius * up.rate })
            }
            (Patch::Point { at: x, radius }, Patch::Point { at: y, .. }) => {
                let centre = Rated::point(first, *x);
                let normal = Rated::point(second, *y).minus(centre).normalized()?;
                Some(ContactRates { normal: normal.rate, place: centre.rate + *radius * normal.rate })
            }
            (Patch::Line { at: x, along, .. }, Patch::Point { at: y, radius }) => {
                let along = Rated::direction(first, *along);
                on_side(Rated::point(first, *x), along, Rated::point(second, *y), *radius)
            }
            (
                Patch::Line { at: x, along: u, radius: thick, .. },
                Patch::Line { at, along: v, radius, .. },
            ) => {
                let x = Rated::point(first, *x);
                let (u, v) = (Rated::direction(first, *u), Rated::direction(second, *v));
                let cross = u.cross(v);
                if cross.value.length() < PARALLEL_SINE {
                    // The lines are nearest all along. The contact counts as that of one point of the second line.
                    let place = meeting.on[1] + *radius * meeting.normal - second.location;
                    let place = second.orientation.conjugate() * place;
                    return on_side(x, u, Rated::point(second, place), *radius);
                }
                // The distance along the first line to the place where it is nearest to the second is (w × v)·(u × v)/|u × v|².
                let [along, along_rate] = Rated::point(second, *at).minus(x).cross(v).dot(cross);
                let [square, square_rate] = cross.dot(cross);
                let distance = along / square;
                let distance = [distance, (along_rate - distance * square_rate) / square];
                let sign = 1.0_f64.copysign(cross.value.dot(meeting.normal));
                let normal = cross.normalized()?.times([sign, 0.0]);
                let place = x.plus(u.times(distance)).plus(normal.times([*thick, 0.0]));
                Some(ContactRates { normal: normal.rate, place: place.rate })
            }
            _ => None,
        }
    }

    /// Computes the rates by central differences along the current motion of the bodies.
    fn numeric([a, b]: [&Patch; 2], members: [&Member; 2], size: f64) -> ContactRates {
        let fastest = members.iter().fold(0.0_f64, |most, member| {
            most.max(member.velocity.length() / size).max(member.angular_velocity.length())
        });
        if fastest == 0.0 {
            return ContactRates { normal: DVec3::ZERO, place: DVec3::ZERO };
        }
        let step = DIFFERENTIATION_STEP / fastest;
        let moved = |time: f64| {
            let [p, q] = members.map(|member| advanced(member, time));
            meet(a, &p, b, &q)
        };
        let (before, after) = (moved(-step), moved(step));
        let middle = |meeting: &ClosestPoints| 0.5 * (meeting.on[0] + meeting.on[1]);
        ContactRates {
            normal: (after.normal - before.normal) / (2.0 * step),
            place: (middle(&after) - middle(&before)) / (2.0 * step),
        }
    }
}

/// Computes the rates of the contact between a round side about a line through `at` and a ball. `None` if the ball is on the line.
fn on_side(at: Rated, along: Rated, centre: Rated, radius: f64) -> Option<ContactRates> {
    let normal = centre.minus(at).across(along).normalized()?;
    Some(ContactRates { normal: normal.rate, place: centre.rate - radius * normal.rate })
}

/// Returns the pose of a body after `time` seconds at its current velocities.
fn advanced(member: &Member, time: f64) -> Pose {
    let turn = DQuat::from_scaled_axis(time * member.angular_velocity);
    Pose {
        location: member.location + time * member.velocity,
        orientation: (turn * member.orientation).normalize(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::constraint::Member;
    use super::super::tests::Random;
    use super::*;

    /// The closed form for two lines agrees with the difference of two moments, whose error grows as the angle between the lines shrinks. The
    /// rates of parallel lines are finite.
    #[test]
    fn the_rates_of_crossing_lines_are_their_derivatives() {
        let mut random = Random::new(5);
        let line = |radius: f64| Patch::Line {
            at: DVec3::new(0.1, 0.0, 0.2),
            along: DVec3::Y,
            half: 0.5,
            radius,
            outward: DVec3::ZERO,
        };
        for _ in 0..200 {
            let mut moving = || {
                let (pose, mut member) = (random.pose(1.0), Member::default());
                (member.location, member.orientation) = (pose.location, pose.orientation);
                (member.velocity, member.angular_velocity) = (random.vector(), random.vector());
                member
            };
            let (first, second) = (moving(), moving());
            let (a, b) = (line(0.1), line(0.2));
            let [pa, pb] = [&first, &second].map(|member| advanced(member, 0.0));
            let meeting = meet(&a, &pa, &b, &pb);
            let exact = ContactRates::exact([&a, &b], [&first, &second], &meeting).unwrap();
            let step = 1e-5;
            let [before, after] =
                [-step, step].map(|time| meet(&a, &advanced(&first, time), &b, &advanced(&second, time)));
            let normal = (after.normal - before.normal) / (2.0 * step);
            let place = (after.on[0] - before.on[0]) / (2.0 * step);
            let [u, v] = [&first, &second].map(|member| member.orientation * DVec3::Y);
            let sine = u.cross(v).length();
            let slack = 1e-7 / (sine * sine * sine);
            assert!((exact.normal - normal).length() < slack, "{} {normal}", exact.normal);
            assert!((exact.place - place).length() < slack, "{} {place}", exact.place);
            let mut along = second;
            along.orientation = first.orientation;
            let meeting = meet(&a, &pa, &b, &advanced(&along, 0.0));
            let mut first = first;
            (first.angular_velocity, along.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
            let exact = ContactRates::exact([&a, &b], [&first, &along], &meeting).unwrap();
            let [before, after] =
                [-step, step].map(|time| meet(&a, &advanced(&first, time), &b, &advanced(&along, time)));
            let normal = (after.normal - before.normal) / (2.0 * step);
            let place = (after.on[1] - before.on[1]) / (2.0 * step);
            let distance = meeting.gap + 0.3;
            let slack = 1e-8 / (distance * distance * distance);
            assert!((exact.normal - normal).length() < slack, "{} {normal}", exact.normal);
            // Along the lines, any place will do.
            let across = (exact.place - place).reject_from_normalized(first.orientation * DVec3::Y);
            assert!(across.length() < slack, "{} {place}", exact.place);
        }
    }
}
