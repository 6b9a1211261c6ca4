//! When bodies are advanced by time-stepping: where their events do not end within a step, or no forces are found that fit.

use super::World;
use super::event::Event;
use crate::dynamics::energy::mechanical;

impl World {
    /// Whether a touch concerns what is advanced by time-stepping.
    pub(super) fn is_in_crowd(&self, event: Event) -> bool {
        let Event::Touch(bodies) = event else { return false };
        self.collider.as_ref().is_some_and(|collider| collider.is_in_crowd(bodies))
    }

    /// From now on until the end of the step, these bodies and all that touches them are advanced by time-stepping.
    pub(super) fn crowd(&mut self, t: f64, bodies: &[usize]) {
        while self.let_touched_go() {}
        let Some(collider) = &mut self.collider else { return };
        if collider.join(&self.model, &self.state, bodies) {
            self.meet(t, false);
        }
    }

    /// Whether an event is one of a heap, whose events are not followed one by one. Gives its bodies.
    pub(super) fn heap_of(&mut self, event: Event, bodies: &[usize]) -> Vec<usize> {
        match (event, &mut self.collider) {
            (Event::Row(_), Some(collider)) => collider.heap_of(bodies, self.solver.contacts(), &self.model),
            _ => Vec::new(),
        }
    }

    /// The bodies that an event is about.
    pub(super) fn bodies_of(&self, event: Event) -> Vec<usize> {
        match event {
            Event::Touch(bodies) => bodies.to_vec(),
            Event::Row(row) => self.solver.bodies_of(row),
        }
    }

    /// Whether bodies hit, grip or release each other so often that these events are followed no longer one by one.
    pub(super) fn happens_too_often(&self, event: Event, bodies: &[usize]) -> bool {
        let Some(collider) = &self.collider else { return false };
        match event {
            Event::Touch(bodies) => collider.hits_too_often(bodies),
            Event::Row(_) => bodies.try_into().is_ok_and(|bodies| self.solver.changes_too_often(bodies)),
        }
    }

    /// Whether no forces were found for the piece that has just been made, at whose end the time is `t`, s.
    pub(super) fn is_unsolved(&self, t: f64) -> bool {
        let is_finite = || self.state.location.iter().all(|location| location.is_finite());
        !self.solver.contacts().is_empty()
            && (self.solver.is_unsolved() || self.solver.has_failed() || !is_finite() || t.is_nan())
    }

    /// Goes back to the beginning of the piece that has just been made, at time `t`, s. What is in touch is advanced by time-stepping from
    /// there. Returns whether something was.
    pub(super) fn go_back(&mut self, t: f64) -> bool {
        let mut bodies: Vec<usize> =
            self.solver.contacts().iter().flat_map(|contact| contact.bodies).collect();
        bodies.dedup();
        let Some(collider) = &mut self.collider else { return false };
        let is_new = collider.join(&self.model, &self.before, &bodies);
        if is_new {
            self.state.clone_from(&self.before);
            self.solver.take_failure();
            self.integrator.discontinuity();
            self.meet(t, false);
        }
        is_new
    }

    /// The end of a step: nothing is advanced by time-stepping any more, unless it is to be for some steps.
    pub(super) fn disperse(&mut self, t: f64) {
        let Some(collider) = self.collider.as_mut().filter(|collider| collider.is_crowded()) else { return };
        let places = match collider.end_course(&self.model, t, &mut self.state) {
            Ok(places) => places,
            Err(breakdown) => {
                self.solver.fail(breakdown);
                return;
            }
        };
        let stays = collider.crowd_stays(&places);
        let mut contacts = self.solver.contacts().to_vec();
        contacts.extend(places);
        contacts.sort_by_key(|contact| contact.bodies);
        self.integrator.discontinuity();
        let is_due = self.rest.are_due(collider.crowded());
        if stays && !is_due {
            return;
        }
        collider.dissolve();
        self.solver.take_contacts(contacts);
        let before = mechanical(&self.model, t, &self.state);
        self.solver.close_all(&self.model, t, &mut self.state);
        self.state.accounts.impacts += mechanical(&self.model, t, &self.state) - before;
        if is_due {
            // They are held now.
            self.is_decided = false;
        } else {
            self.meet_at_rest(t);
        }
    }
}
