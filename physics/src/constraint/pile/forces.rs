//! The forces of a pile: their impulses in a substep, and how snapshots show them.

use glam::{DVec2, DVec3};

use super::super::super::contact::{LastingContact, pose};
use super::super::super::{ContactSnapshot, Loads, Model, State};
use super::super::sweep::{FORCE_SWEEP_TOLERANCE, IMPACT_SWEEP_TOLERANCE, Purpose};
use super::island::Limits;
use super::{Contact, Island, Pile};

/// The number of times that sweeps solve for the forces between resting bodies. Each time, the sweeps start from the forces found the time
/// before.
const FORCE_PASSES: usize = 10;

impl Pile {
    /// Sets the rates that contacts aim at: the gap of none may close before the end of a substep of `part` seconds. Gaps below `closed`
    /// times the size of the smaller body count as zero.
    pub(crate) fn aim(&mut self, part: f64, closed: f64) {
        for point in &mut self.points {
            let size = self.contacts[point.contact].place.size;
            let gap = if point.gap < closed * size { 0.0 } else { point.gap };
            point.goal = DVec3::X * (-gap / part);
        }
        self.rolls.iter_mut().for_each(|roll| roll.goal = DVec2::ZERO);
    }

    /// Sets the rates that contacts aim at in the middle of a substep: the mean of the present rates and of the goals at its end. Bodies can
    /// stop within a substep, so each goal can be reached. A contact that already closes faster than its goal slows down to the goal at
    /// once.
    pub(crate) fn aim_at_middle(&mut self) {
        for point in &mut self.points {
            let goal = point.goal;
            point.rate_before = point.rate(&self.bodies);
            point.goal = 0.5 * (goal + point.rate_before);
            point.goal.x = point.goal.x.max(goal.x);
        }
        for roll in &mut self.rolls {
            let rate = roll.rate(&self.points[roll.point], &self.bodies, |body| body.angular_velocity);
            roll.goal = 0.5 * (roll.goal + rate);
        }
    }

    /// Applies the impulses of all contacts to the bodies, and books their work. [`measure`](Self::measure) must have run at these positions.
    pub(crate) fn push_all(&mut self, model: &Model, time: f64, state: &mut State) {
        self.take_velocities(model, state);
        let limits = self.limits(Purpose::Forces(time));
        self.for_each_island(|pile, island| {
            pile.find(island, Purpose::Forces(time), limits);
            pile.apply(island, Purpose::Forces(time), model, state);
        });
        for (point, &[push, along, across]) in self.points.iter().zip(&self.impulses) {
            let contact = &mut self.contacts[point.contact];
            contact.push = push / time;
            contact.friction = point.vector(DVec3::new(0.0, along, across)) / time;
        }
        for roll in &self.rolls {
            let point = &self.points[roll.point];
            self.contacts[point.contact].rolling = roll.moment(roll.impulse, point) / time;
        }
    }

    /// Calls `act` for each island.
    pub(super) fn for_each_island(&mut self, mut act: impl FnMut(&mut Pile, &Island)) {
        let islands = std::mem::take(&mut self.islands);
        islands.iter().for_each(|island| act(self, island));
        self.islands = islands;
    }

    /// Returns the limits of the search for impulses, from the rates at the present velocities.
    pub(super) fn limits(&mut self, purpose: Purpose) -> Limits {
        let mut largest = self.points.iter().map(|point| point.rate(&self.bodies).abs().max_element());
        let mut fastest = largest.by_ref().fold(0.0, f64::max);
        for island in &self.islands {
            for roll in &self.rolls[island.rolls.clone()] {
                let rate = roll.rate(&self.points[roll.point], &self.bodies, |body| body.angular_velocity);
                fastest = fastest.max(rate.abs().max_element() * island.length);
            }
        }
        if purpose != Purpose::Impact {
            self.fastest = fastest;
        }
        // Rates need no accuracy far below their change by forces in a substep.
        let part = if purpose == Purpose::Impact { IMPACT_SWEEP_TOLERANCE } else { FORCE_SWEEP_TOLERANCE };
        let largest = fastest.max(self.fastest);
        Limits { largest, tolerance: part * largest }
    }

    /// Applies the impulses of an island to the state of the bodies, and books their work.
    pub(super) fn apply(&self, island: &Island, purpose: Purpose, model: &Model, state: &mut State) {
        let share = |before: DVec3, after: DVec3| match purpose {
            Purpose::Impact => 0.5 * (before + after),
            Purpose::Forces(_) => after,
        };
        let (mut normal, mut friction) = (0.0, 0.0);
        for (point, impulse) in self.pushed(island) {
            let works = impulse * share(point.free_rate(&self.bodies), point.rate(&self.bodies));
            normal += works.x;
            friction += works.y + works.z;
            let push = point.vector(impulse);
            for (side, push) in [-push, push].into_iter().enumerate() {
                let body = self.bodies[point.bodies[side] as usize].index;
                give(body, push, point.arms()[side].cross(push), model, state);
            }
        }
        for roll in &self.rolls[island.rolls.clone()] {
            let point = &self.points[roll.point];
            let before = roll.rate(point, &self.bodies, |body| body.free[1]);
            let after = roll.rate(point, &self.bodies, |body| body.angular_velocity);
            friction += roll.impulse.dot(share(before.extend(0.0), after.extend(0.0)).truncate());
            let moment = roll.moment(roll.impulse, point);
            for (side, moment) in [-moment, moment].into_iter().enumerate() {
                let body = self.bodies[point.bodies[side] as usize].index;
                give(body, DVec3::ZERO, moment, model, state);
            }
        }
        if purpose == Purpose::Impact {
            state.accounts.impacts += normal + friction;
        } else {
            state.accounts.impacts += normal;
            state.accounts.friction += friction;
        }
    }

    /// Returns the two bodies of the contact with the largest normal impulse in the last solution, and the sum of all normal impulses, N s.
    /// `None` if no contact pushes.
    pub(crate) fn hardest_contact(&self) -> Option<([usize; 2], f64)> {
        let sum = self.impulses.iter().map(|[push, ..]| push).sum();
        let pushing = self.points.iter().zip(&self.impulses).filter(|(_, [push, ..])| *push > 0.0);
        let (hardest, _) = pushing.max_by(|(_, [a, ..]), (_, [b, ..])| a.total_cmp(b))?;
        Some((self.contacts[hardest.contact].place.bodies, sum))
    }

    /// Returns the pairs of bodies whose contacts pushed in the last substep.
    pub(crate) fn pushing(&self) -> impl Iterator<Item = [usize; 2]> {
        self.contacts.iter().filter(|contact| contact.push > 0.0).map(|contact| contact.place.bodies)
    }

    /// Forgets the forces, from which the next sweeps would start.
    pub(crate) fn start_cold(&mut self) {
        self.contacts.clear();
        self.others.clear();
    }

    /// Returns these contacts with the forces that the last substep has found.
    pub(crate) fn last_forces<'a>(
        &self,
        places: impl IntoIterator<Item = &'a LastingContact>,
        model: &Model,
        state: &State,
    ) -> Vec<ContactSnapshot> {
        let known =
            |place: &LastingContact| find(&self.contacts, place).or_else(|| find(&self.others, place));
        let seen = |place: &'a LastingContact| {
            let (push, friction) =
                known(place).map_or((0.0, DVec3::ZERO), |known| (known.push, known.friction));
            let meeting = place.meet(place.bodies.map(|body| pose(body, model, state)));
            let normal = meeting.normal;
            ContactSnapshot {
                bodies: place.bodies,
                place: 0.5 * (meeting.on[0] + meeting.on[1]),
                normal,
                force: push * normal,
                friction: friction.reject_from_normalized(normal),
            }
        };
        places.into_iter().map(seen).collect()
    }

    /// Computes the contact forces between resting bodies. `loads` are all other forces and torques on these bodies.
    pub(crate) fn forces_at_rest(
        &self,
        places: Vec<LastingContact>,
        (model, state): (&Model, &State),
        loads: &Loads,
    ) -> Vec<ContactSnapshot> {
        // The given velocities are those that the loads cause in one second from rest. The impulses that stop the bodies, in newton
        // seconds, then equal the contact forces in newtons.
        let mut given = state.clone();
        for &i in places.iter().flat_map(|place| &place.bodies) {
            given.velocity[i] = model.inverse_mass()[i] * loads.force[i];
            given.angular_momentum[i] =
                if model.inverse_mass()[i] == 0.0 { DVec3::ZERO } else { loads.torque[i] };
        }
        let mut pile = Pile { contacts: self.contacts.clone(), ..Pile::default() };
        let shown = places.clone();
        pile.take_contacts(places, model, &given);
        pile.measure(model, &given);
        for _ in 0..FORCE_PASSES {
            for point in &mut pile.points {
                point.goal = DVec3::ZERO;
            }
            pile.push_all(model, 1.0, &mut given.clone());
        }
        pile.last_forces(&shown, model, state)
    }
}

/// Returns the same contact among known ones, which are in the order of their bodies.
fn find<'a>(known: &'a [Contact], place: &LastingContact) -> Option<&'a Contact> {
    let first = known.partition_point(|contact| contact.place.bodies < place.bodies);
    let mut same = known[first..].iter().take_while(|contact| contact.place.bodies == place.bodies);
    same.find(|contact| contact.place.is(place))
}

/// Gives an impulse and its moment about the center to a body. A body with a given motion keeps its velocity: its guide, whatever makes it
/// follow the motion, absorbs the impulse. The work of the guide is booked.
fn give(body: usize, push: DVec3, moment: DVec3, model: &Model, state: &mut State) {
    let inverse_mass = model.inverse_mass()[body];
    if inverse_mass != 0.0 {
        state.velocity[body] += inverse_mass * push;
        state.angular_momentum[body] += moment;
    } else {
        let turning = moment.dot(model.angular_velocity(body, state));
        state.accounts.work -= push.dot(state.velocity[body]) + turning;
    }
}
