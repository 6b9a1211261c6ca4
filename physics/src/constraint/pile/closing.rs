//! How bodies touch that meet within a substep: not as they stand at its start, but as they stand when they meet.
//!
//! A ball that passes another one at an angle turns their common normal on its way. With the normal at the start of the substep, the directions
//! after the impact would have an error of the first order, and balls that just miss each other would rebound.

use glam::{DQuat, DVec3};

use super::super::super::contact::{ClosestPoints, LastingContact, Pose, pose};
use super::super::super::{Model, State};
use super::{Body, Pile};

/// The largest number of steps of the search for the moment at which two bodies are nearest.
const MAX_SEARCH_STEPS: usize = 40;
/// Bodies touch at gaps below this fraction of the smaller body's size.
const TOUCHING_GAP: f64 = 1e-9;

/// Two bodies at a moment within a substep, if no impulses act before.
struct Approach<'a> {
    place: &'a LastingContact,
    bodies: [&'a Body; 2],
    poses: [Pose; 2],
}

/// How two bodies stand at a moment.
#[derive(Clone, Copy)]
struct Moment {
    /// The time from the start of the substep, s.
    time: f64,
    meeting: ClosestPoints,
    /// The locations of the bodies, m.
    locations: [DVec3; 2],
    /// The rate of the gap, m/s.
    rate: f64,
}

impl Pile {
    /// Measures each contact whose gap closes within `part` seconds at the moment when it is closed. Its gap becomes the one that closes at the
    /// rate of that moment. Contacts of bodies that may miss each other are measured when the bodies are nearest, if they do. Gaps below `closed`
    /// times the size of the smaller body are closed already.
    pub(crate) fn foresee(&mut self, (part, closed): (f64, f64), model: &Model, state: &State) {
        let Pile { points, contacts, bodies, .. } = self;
        for point in points {
            let place = &contacts[point.contact].place;
            let closes = point.gap >= closed * place.size && point.gap + part * point.rate(bodies).x < 0.0;
            if closes {
                let of_point = point.bodies.map(|body| &bodies[body as usize]);
                let poses = place.bodies.map(|body| pose(body, model, state));
                let moment = Approach { place, bodies: of_point, poses }.nearest(part);
                if moment.meeting.gap > TOUCHING_GAP * place.size && !place.may_miss {
                    continue;
                }
                let gap = moment.meeting.gap - moment.rate * moment.time;
                point.set(&ClosestPoints { gap, ..moment.meeting }, moment.locations);
                point.respond(bodies);
                point.is_foreseen = true;
            }
        }
        self.respond_to_rolling();
    }
}

impl Approach<'_> {
    fn at(&self, time: f64) -> Moment {
        let [a, b] = [0, 1].map(|side| {
            let (body, pose) = (self.bodies[side], &self.poses[side]);
            let turn = DQuat::from_scaled_axis(time * body.angular_velocity);
            Pose {
                location: pose.location + time * body.velocity,
                orientation: (turn * pose.orientation).normalize(),
            }
        });
        let locations = [a.location, b.location];
        let meeting = self.place.meet([a, b]);
        let velocity = |side: usize| {
            let body = self.bodies[side];
            body.velocity + body.angular_velocity.cross(meeting.on[side] - locations[side])
        };
        let rate = (velocity(1) - velocity(0)).dot(meeting.normal);
        Moment { time, meeting, locations, rate }
    }

    /// Returns the last moment within `part` seconds at which the gap still closes and is not closed.
    fn nearest(&self, part: f64) -> Moment {
        let touching = TOUCHING_GAP * self.place.size;
        let (mut early, mut late) = (self.at(0.0), None);
        for _ in 0..MAX_SEARCH_STEPS {
            if early.rate >= 0.0 || early.meeting.gap <= touching || early.time >= part {
                break;
            }
            // Newton's method, kept within the bounds. Where points touch, rounding errors would hide the normal, so it aims a little before.
            let next = (early.time - (early.meeting.gap - 0.5 * touching) / early.rate).min(part);
            let time = match late {
                Some(late) if next >= late => 0.5 * (early.time + late),
                _ => next,
            };
            if time <= early.time {
                break;
            }
            let then = self.at(time);
            if then.rate < 0.0 && then.meeting.gap >= 0.0 {
                early = then;
            } else {
                late = Some(time);
            }
        }
        early
    }
}
