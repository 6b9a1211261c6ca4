//! Steps by Moreau's scheme alone: no event is located, and all contacts of a part of a step are solved together.

use super::World;
use super::picture::picture;
use crate::dynamics::contact::Collider;
use crate::dynamics::{ContactSnapshot, Contacts, Model, Snapshot, State, System};

impl World {
    /// Makes a step of `dt` seconds by Moreau's scheme. Calls `see` with a snapshot at each of `moments`.
    pub(super) fn step_by_moreau(&mut self, t: f64, dt: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) {
        self.begin_crowd();
        self.wake_hit(dt);
        self.before.clone_from(&self.state);
        self.note_accelerations(t);
        let Self { model, state, before, solver, collider: Some(collider), loads, .. } = self else { return };
        if let Some(breakdown) = collider.advance_all(model, (t, dt), state, loads) {
            solver.fail(breakdown);
        }
        model.place(t + dt, state);
        collider.note_rebounds(t + dt);
        collider.follow_step(model, (before, state), dt);
        self.steps += 1;
        for &moment in moments {
            see(self.picture_within(moment));
        }
        let Self { model, state, solver, collider: Some(collider), .. } = self else { return };
        if let Err(breakdown) = collider.end_course(model, t + dt, state) {
            solver.fail(breakdown);
        }
    }

    /// Makes all bodies that can move the crowd (the bodies that Moreau's scheme advances), except those held at rest.
    fn begin_crowd(&mut self) {
        let collider = self.collider.get_or_insert_with(|| Collider::new(Contacts::default()));
        collider.crowd_all(&self.model);
    }

    /// Releases the bodies held at rest that a moving body touches, or may hit within `dt` seconds.
    fn wake_hit(&mut self, dt: f64) {
        if self.rest.held().next().is_none() {
            return;
        }
        while let Some(collider) = &self.collider {
            let moves = |body: usize| !self.rest.is_calm(body);
            let hit = collider.may_be_hit(&self.model, &self.state, dt, moves);
            if !self.let_go(&hit) {
                return;
            }
            self.begin_crowd();
        }
    }

    /// Records the largest acceleration that the loads give to a body. Speeds far below its product with the step count as rest.
    fn note_accelerations(&mut self, t: f64) {
        let Self { model, state, loads, solver, .. } = self;
        model.sum(t, state, loads);
        let of = |(force, inverse_mass): (&glam::DVec3, &f64)| inverse_mass * force.length();
        let largest = loads.force.iter().zip(model.inverse_mass()).map(of).fold(0.0, f64::max);
        solver.note_acceleration(largest);
    }

    /// Returns a snapshot of a moment within the last step.
    fn picture_within(&mut self, time: f64) -> Snapshot {
        let mut within = self.before.clone();
        if let Some(mut collider) = self.collider.clone() {
            collider.crowd_at(time, &self.model, &mut within, &mut self.loads);
        }
        self.model.place(time, &mut within);
        let balance = self.ledger.peek(&self.model, time, &within);
        let mut copy = self.seen_by_moreau(time, &within);
        let World { model, solver, rest, crowd, collider, loads, .. } = &mut copy;
        let laws = super::laws_of(collider.as_ref());
        picture(&mut System::new(model, solver), time, &within, (balance, rest, crowd, laws), loads)
    }

    /// Returns a copy of the world for a snapshot of `state`. It holds the contacts of the crowd with their last forces.
    pub(super) fn seen_by_moreau(&self, time: f64, state: &State) -> World {
        let mut copy = self.clone();
        if let Some(collider) = &copy.collider {
            copy.crowd = collider.crowd_contacts(&copy.model, time, state);
            if !copy.model.constraints().is_empty() {
                copy.solver.give_joint_forces(&copy.model, collider.joint_forces());
                load_with(&copy.crowd, &mut copy.model, state);
            }
        }
        copy
    }
}

/// Adds the contact forces to the constant loads of the bodies, so that joints bear them.
fn load_with(contacts: &[ContactSnapshot], model: &mut Model, state: &State) {
    for contact in contacts {
        let force = contact.force + contact.friction;
        for (body, force) in contact.bodies.into_iter().zip([-force, force]) {
            if model.inverse_mass()[body] != 0.0 {
                let torque = (contact.place - state.location[body]).cross(force);
                model.set_constant_force(body, model.constant_force(body) + force);
                model.set_constant_torque(body, model.constant_torque(body) + torque);
            }
        }
    }
}
