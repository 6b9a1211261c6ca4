//! The rates of a contact point and of its normal, as the contact moves over two bodies.

use glam::{DQuat, DVec3};

use super::super::constraint::Member;
use super::closest_points::ClosestPoints;
use super::patch::{Patch, meet};
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

    /// Returns the component perpendicular to a unit direction, with its rate.
    fn across(self, unit: Rated) -> Rated {
        let along = self.value.dot(unit.value);
        let along_rate = self.rate.dot(unit.value) + self.value.dot(unit.rate);
        Rated {
            value: self.value - along * unit.value,
            rate: self.rate - along_rate * unit.value - along * unit.rate,
        }
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
    /// Computes the rates of the contact between two patches. `size` is a typical length of the smaller body, m.
    pub(super) fn of(patches: [&Patch; 2], members: [&Member; 2], size: f64) -> ContactRates {
        ContactRates::exact(patches, members)
            .or_else(|| {
                let [a, b] = patches;
                let swapped = ContactRates::exact([b, a], [members[1], members[0]])?;
                Some(ContactRates { normal: -swapped.normal, ..swapped })
            })
            .unwrap_or_else(|| ContactRates::numeric(patches, members, size))
    }

    /// Computes the rates in closed form. `None` if there is no formula for these two patches in this order.
    fn exact([a, b]: [&Patch; 2], [first, second]: [&Member; 2]) -> Option<ContactRates> {
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
                let centre = Rated::point(second, *y);
                let normal = centre.minus(Rated::point(first, *x)).across(along).normalized()?;
                Some(ContactRates { normal: normal.rate, place: centre.rate - *radius * normal.rate })
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

/// Returns the pose of a body after `time` seconds at its current velocities.
fn advanced(member: &Member, time: f64) -> Pose {
    let turn = DQuat::from_scaled_axis(time * member.angular_velocity);
    Pose {
        location: member.location + time * member.velocity,
        orientation: (turn * member.orientation).normalize(),
    }
}
