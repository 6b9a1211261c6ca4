//! Bodies at rest on each other, which are held in place until something disturbs them.
//!
//! As long as the contacts of a heap at rest are followed, it takes as much computing time as a falling heap. Once all bodies of a group
//! have rested for some steps, they are held in place like fixed bodies. Snapshots still show their contact forces. A touch or a change of
//! forces releases them.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::World;
use crate::contact::{Collider, LastingContact, kinetic};
use crate::{ContactSnapshot, Loads, System};

/// The number of consecutive steps at rest after which bodies are held in place.
const STEPS_BEFORE_HOLDING: u32 = 8;

/// A body is at rest if its speed is below this fraction of the largest closing speed so far, or of the typical change of velocity by
/// forces within a step, whichever is larger.
const MAX_RESTING_SPEED: f64 = 1e-8;

/// For a body that Moreau's scheme has advanced, [`MAX_RESTING_SPEED`] is higher by this factor.
const MOREAU_SPEED_FACTOR: f64 = 100.0;

/// Bodies are held only if the forces on each balance to within this fraction of the forces of its contacts. The forces together may lie
/// outside their cones of friction by the same fraction.
const BALANCE_TOLERANCE: f64 = 0.01;

/// Loads count as unchanged if their relative change is at most this.
const LOAD_TOLERANCE: f64 = 1e-9;

/// The groups of bodies held at rest, and how long each body has rested.
#[derive(Clone, Default)]
pub(super) struct Rest {
    /// For each body, the number of consecutive steps at rest.
    calm: Vec<u32>,
    islands: Vec<Island>,
}

/// A group of bodies held at rest, connected by contacts.
#[derive(Clone)]
struct Island {
    bodies: BTreeSet<usize>,
    contacts: Vec<Arc<LastingContact>>,
    /// The contacts of the group with their forces, as snapshots show them.
    seen: Vec<ContactSnapshot>,
    /// The force (N) and the torque (N m) on each body of the group, without contact forces. A change of these releases the group.
    loads: Vec<(DVec3, DVec3)>,
}

impl Rest {
    /// Returns the contacts of all bodies held at rest, for snapshots.
    pub(super) fn contacts(&self) -> impl Iterator<Item = ContactSnapshot> {
        self.islands.iter().flat_map(|island| island.seen.iter().copied())
    }

    /// Returns the sets of bodies that are held at rest together.
    pub(super) fn held(&self) -> impl Iterator<Item = &BTreeSet<usize>> {
        self.islands.iter().map(|island| &island.bodies)
    }

    /// Returns true if all of these bodies can be held at the end of this step, provided that they are still at rest.
    pub(super) fn are_due(&self, bodies: &BTreeSet<usize>) -> bool {
        let calm = |body: &usize| self.calm.get(*body).copied().unwrap_or(0);
        bodies
            .iter()
            .map(calm)
            .min()
            .is_some_and(|least| least % STEPS_BEFORE_HOLDING == STEPS_BEFORE_HOLDING - 1)
    }

    /// Returns true if a body was at rest at the end of the last step.
    pub(super) fn is_calm(&self, body: usize) -> bool {
        self.calm.get(body).is_some_and(|calm| *calm > 0)
    }

    fn holds(&self, body: usize) -> bool {
        self.islands.iter().any(|island| island.bodies.contains(&body))
    }
}

impl World {
    /// Holds in place the bodies that have rested long enough. Must be called at the end of each step; `dt` is its length,
    /// s.
    pub(super) fn hold_still(&mut self, t: f64, dt: f64) {
        let Some(collider) = self.collider.as_ref() else { return };
        let swing = self.solver.usual_change(dt);
        let slow = MAX_RESTING_SPEED * collider.fastest().max(self.solver.usual_change(self.step));
        self.rest.calm.resize(self.model.len(), 0);
        let is_stepped = self.is_stepped();
        for (i, calm) in self.rest.calm.iter_mut().enumerate() {
            let mut speed = self.state.velocity[i].length() + collider.spin(i, &self.model, &self.state);
            // The velocities at the ends of substeps swing a little about those in the middle, which move the bodies.
            if is_stepped && speed <= swing {
                let way = self.state.location[i] - self.before.location[i];
                let turn = angle(self.before.orientation[i], self.state.orientation[i]);
                speed = (way.length() + turn * collider.reach(i)) / dt;
            }
            let slow = if is_stepped || collider.was_in_crowd(i) { MOREAU_SPEED_FACTOR * slow } else { slow };
            *calm = if speed <= slow { *calm + 1 } else { 0 };
        }
        // If a group cannot be held yet, the next attempt is some steps later.
        let is_due = |(i, calm): (usize, &u32)| {
            *calm > 0 && *calm % STEPS_BEFORE_HOLDING == 0 && self.model.inverse_mass()[i] != 0.0
        };
        let is_due = self.rest.calm.iter().enumerate().any(is_due);
        if is_due && is_stepped {
            let places = collider.last_places(&self.model, &self.state);
            self.solver.take_contacts(places);
        }
        let new = if is_due { self.calm_islands() } else { Vec::new() };
        let Some(collider) = self.collider.as_ref().filter(|_| !new.is_empty()) else {
            self.leave_contacts();
            return;
        };
        let was_in_crowd =
            |bodies: &BTreeSet<usize>| is_stepped || bodies.iter().any(|&body| collider.was_in_crowd(body));
        let (heaps, others): (Vec<_>, Vec<_>) = new.into_iter().partition(was_in_crowd);
        let mut held = self.seen_by_sweeps(t, heaps);
        held.extend(self.seen_as_decided(t, others));
        for &body in held.iter().flat_map(|island| &island.bodies) {
            // Moreau's scheme leaves a little motion, which contacts end.
            self.state.accounts.impacts -= kinetic(body, &self.model, &self.state);
            self.model.freeze(body, &mut self.state);
        }
        self.rest.islands.extend(held);
        self.solver.forget();
        self.integrator.discontinuity();
        self.leave_contacts();
        self.meet_at_rest(t);
    }

    /// Takes all contacts from the solver if Moreau's scheme handles them.
    fn leave_contacts(&mut self) {
        if self.is_stepped() {
            self.solver.take_contacts(Vec::new());
        }
    }

    /// Creates the held groups of bodies that Moreau's scheme brought to rest. Their contact forces are found by sweeps over the contacts,
    /// as in Moreau's scheme. The event-driven solver would have to decide which of a heap's many contacts push. This would take long, and
    /// would often fail.
    fn seen_by_sweeps(&mut self, t: f64, islands: Vec<BTreeSet<usize>>) -> Vec<Island> {
        self.is_decided &= islands.is_empty();
        let make = |bodies: BTreeSet<usize>| {
            let contacts = self.take_out(&bodies);
            self.model.sum(t, &self.state, &mut self.loads);
            let forces = |collider: &Collider| {
                collider.forces_at_rest(&contacts, &self.model, (t, &self.state), &self.loads)
            };
            let seen = self.collider.as_ref().map(forces).unwrap_or_default();
            self.island(bodies, contacts, seen)
        };
        islands.into_iter().filter_map(make).collect()
    }

    /// Creates the held groups of bodies whose contacts are handled by events. Their contact forces follow from the decided modes of the
    /// contacts.
    fn seen_as_decided(&mut self, t: f64, islands: Vec<BTreeSet<usize>>) -> Vec<Island> {
        if islands.is_empty() {
            return Vec::new();
        }
        self.decide_all(t);
        let mut system = System::new(&self.model, &mut self.solver);
        system.begin(t, &self.state);
        system.evaluate(t, &self.state, &mut self.loads);
        let all = system.contacts(t, &self.state);
        self.model.sum(t, &self.state, &mut self.loads);
        let make = |bodies: BTreeSet<usize>| {
            let is_of = |contact: &ContactSnapshot| contact.bodies.iter().any(|body| bodies.contains(body));
            let seen = all.iter().copied().filter(is_of).collect();
            let contacts = self.take_out(&bodies);
            self.island(bodies, contacts, seen)
        };
        islands.into_iter().filter_map(make).collect()
    }

    /// Removes the contacts of these bodies from the solver, and returns them.
    fn take_out(&mut self, bodies: &BTreeSet<usize>) -> Vec<Arc<LastingContact>> {
        let (taken, left) = self.solver.contacts().iter().cloned().partition(|contact| contact.is_of(bodies));
        self.solver.take_contacts(left);
        taken
    }

    /// Creates a group of bodies held at rest, with its contacts, their snapshots, and the present loads. If these are not in balance, the
    /// solver gets the contacts back, and the result is `None`.
    fn island(
        &mut self,
        bodies: BTreeSet<usize>,
        contacts: Vec<Arc<LastingContact>>,
        seen: Vec<ContactSnapshot>,
    ) -> Option<Island> {
        if !bodies.iter().all(|&body| self.is_balanced(body, &contacts, &seen)) {
            self.give_back(contacts);
            return None;
        }
        let loads = bodies.iter().map(|&i| (self.loads.force[i], self.loads.torque[i])).collect();
        Some(Island { bodies, contacts, seen, loads })
    }

    /// Returns true if the loads on a body and the forces of its contacts balance, and if these forces lie in the cones of friction.
    fn is_balanced(&self, body: usize, contacts: &[Arc<LastingContact>], seen: &[ContactSnapshot]) -> bool {
        let (mut force, mut torque) = (self.loads.force[body], self.loads.torque[body]);
        let (mut carried, mut moments, mut outside) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut rolls = false;
        for contact in seen.iter().filter(|contact| contact.bodies.contains(&body)) {
            let law = contacts.iter().find(|other| other.bodies == contact.bodies).map(|other| other.law);
            let Some(law) = law else { return false };
            let sign = if contact.bodies[1] == body { 1.0 } else { -1.0 };
            let push = sign * (contact.force + contact.friction);
            let moment = (contact.place - self.state.location[body]).cross(push);
            (force, torque) = (force + push, torque + moment);
            (carried, moments) = (carried + push.length(), moments + moment.length());
            let normal = contact.force.dot(contact.normal);
            outside += (contact.friction.length() - law.friction * normal).max(-normal).max(0.0);
            rolls |= law.rolling_friction > 0.0;
        }
        // The torques of rolling friction do not show in snapshots.
        let turns = !rolls && torque.length() > BALANCE_TOLERANCE * moments;
        force.length() <= BALANCE_TOLERANCE * carried && outside <= BALANCE_TOLERANCE * carried && !turns
    }

    /// Gives contacts to the solver, in addition to those that it has.
    fn give_back(&mut self, mut contacts: Vec<Arc<LastingContact>>) {
        contacts.extend(self.solver.contacts().iter().cloned());
        contacts.sort_by_key(|contact| contact.bodies);
        self.solver.take_contacts(contacts);
        self.solver.forget();
    }

    /// Returns the groups of bodies that are connected by contacts and have all rested long enough. Bodies with joints are excluded.
    fn calm_islands(&self) -> Vec<BTreeSet<usize>> {
        let can_move = |body: &usize| self.model.inverse_mass()[*body] != 0.0;
        let is_calm = |body: &usize| self.rest.calm[*body] >= STEPS_BEFORE_HOLDING;
        let mut islands: Vec<(BTreeSet<usize>, bool)> = Vec::new();
        for contact in self.solver.contacts() {
            let bodies: BTreeSet<usize> = contact.bodies.into_iter().filter(can_move).collect();
            // A body that lies on a body with a given motion moves with it, so it cannot be held.
            let is_still = contact.bodies.iter().all(|body| self.model.motion(*body).is_none())
                && bodies.iter().all(is_calm);
            let (same, others) = islands
                .into_iter()
                .partition(|(island, _): &(BTreeSet<usize>, bool)| !island.is_disjoint(&bodies));
            islands = others;
            let mut joined = (bodies, is_still);
            for (island, was_still) in same {
                joined.0.extend(island);
                joined.1 &= was_still;
            }
            islands.push(joined);
        }
        let is_free = |bodies: &BTreeSet<usize>| {
            let mut joints = self.model.constraints().iter().flat_map(|joint| joint.bodies());
            !joints.any(|body| bodies.contains(&body.index()))
        };
        let calm = islands.into_iter().filter(|(bodies, is_still)| *is_still && is_free(bodies));
        calm.map(|(bodies, _)| bodies).collect()
    }

    /// Releases groups whose loads have changed. Must be called at the start of each step.
    pub(super) fn check_rest(&mut self, t: f64) {
        if self.rest.islands.is_empty() {
            return;
        }
        let mut loads = Loads::default();
        self.model.sum(t, &self.state, &mut loads);
        let differs = |a: DVec3, b: DVec3| (a - b).length() > LOAD_TOLERANCE * a.length();
        let is_disturbed = |island: &Island| {
            let mut all = island.bodies.iter().zip(&island.loads);
            all.any(|(&i, load)| differs(load.0, loads.force[i]) || differs(load.1, loads.torque[i]))
        };
        let disturbed: Vec<usize> = self
            .rest
            .islands
            .iter()
            .filter(|island| is_disturbed(island))
            .filter_map(|island| island.bodies.first().copied())
            .collect();
        if self.let_go(&disturbed) {
            self.meet(t, false);
        }
    }

    /// Releases the held groups that contain any of these bodies. Returns true if there were any.
    pub(super) fn let_go(&mut self, bodies: &[usize]) -> bool {
        if !bodies.iter().any(|&body| self.rest.holds(body)) {
            return false;
        }
        let islands = std::mem::take(&mut self.rest.islands);
        let is_meant = |island: &Island| bodies.iter().any(|body| island.bodies.contains(body));
        let (free, held) = islands.into_iter().partition(is_meant);
        self.rest.islands = held;
        let mut contacts = Vec::new();
        for island in free {
            for &body in &island.bodies {
                self.model.thaw(body);
                self.rest.calm[body] = 0;
            }
            contacts.extend(island.contacts);
        }
        self.give_back(contacts);
        self.leave_contacts();
        self.integrator.discontinuity();
        true
    }

    /// Restores an earlier set of held groups, in which more bodies were held.
    pub(super) fn hold_again(&mut self, held: Rest) {
        let freed = held.islands.iter().flat_map(|island| &island.bodies);
        for &body in freed.filter(|body| !self.rest.holds(**body)) {
            self.model.freeze(body, &mut self.state);
        }
        self.rest = held;
    }

    /// Lets groups of bodies that are held at rest move again if they contain one of `bodies` or touch one.
    pub(super) fn let_held_by_go(&mut self, bodies: &[usize]) {
        let is_held_by =
            |contact: &Arc<LastingContact>| contact.bodies.iter().any(|body| bodies.contains(body));
        let islands = self.rest.islands.iter().filter(|island| island.contacts.iter().any(is_held_by));
        let held: Vec<usize> = islands.filter_map(|island| island.bodies.first().copied()).collect();
        self.let_go(&held);
    }

    /// Releases all bodies that are held at rest.
    pub(super) fn let_all_go(&mut self) {
        let all: Vec<usize> =
            self.rest.islands.iter().flat_map(|island| island.bodies.iter().copied()).collect();
        self.let_go(&all);
    }

    /// Releases the held groups that touch a moving body. Returns true if there were any.
    pub(super) fn let_touched_go(&mut self) -> bool {
        let Some(collider) = self.collider.as_mut().filter(|_| !self.rest.islands.is_empty()) else {
            return false;
        };
        let touched = collider.touched_at_rest(&self.model, &self.state);
        self.let_go(&touched)
    }
}

/// Returns the angle between two orientations, rad, if it is small.
fn angle(before: DQuat, after: DQuat) -> f64 {
    2.0 * (after - before).length().min((after + before).length())
}

#[cfg(test)]
mod tests {
    use super::super::super::{Contacts, Dynamics, RigidBody, Shape, Surface, UniformGravity};
    use super::*;

    /// A box stands on a floor and is pushed by half of the largest friction. Forces that are missing, turned round, at other places, or
    /// outside the cone of friction do not hold it.
    #[test]
    fn only_forces_in_balance_and_within_the_cones_hold_a_body() {
        let mut world = World::new();
        let [floor, block] = [Shape::Plane { normal: DVec3::Y }, Shape::Box { size: DVec3::ONE }];
        world.add(RigidBody { fixed: true, ..RigidBody::new(&floor, 1.0) });
        let id = world.add(RigidBody::new(&block, 2.0).with_location(DVec3::Y * 0.5));
        world.add_shapes([floor, block]);
        world.add_force(UniformGravity { acceleration: DVec3::Y * -10.0 });
        world.apply_force(id, DVec3::X * 5.0);
        let surface = Surface { friction: Some(0.5), ..Surface::default() };
        world.collide(Contacts { surfaces: vec![Some(surface); 2], ..Contacts::default() });
        let snapshot = world.snapshot().unwrap();
        let contacts = world.solver.contacts().to_vec();
        world.model.sum(0.0, &world.state, &mut world.loads);
        let is_balanced = |change: fn(&mut ContactSnapshot)| {
            let mut seen = snapshot.contacts.clone();
            seen.iter_mut().for_each(change);
            world.is_balanced(1, &contacts, &seen)
        };
        assert!(is_balanced(|_| {}));
        assert!(is_balanced(|contact| contact.force *= 1.005));
        assert!(!is_balanced(|contact| contact.force *= 1.02));
        assert!(!is_balanced(|contact| contact.friction = -contact.friction));
        assert!(!is_balanced(|contact| contact.place.x += 0.02));
        let mut slippery = contacts.clone();
        slippery.iter_mut().for_each(|contact| Arc::make_mut(contact).law.friction = 0.23);
        assert!(!world.is_balanced(1, &slippery, &snapshot.contacts));
        assert!(!world.is_balanced(1, &contacts, &[]));
    }
}
