//! Steps in which separate groups of bodies are advanced one after another.
//!
//! An event ends a piece of a step for all bodies that are advanced together. With many separate contacts, each event would start a new
//! piece for all of these bodies. Bodies without contacts therefore make the step in one piece, and each group with events makes the step
//! in its own pieces.

use super::World;
use crate::constraint::Solver;
use crate::contact::{Collider, Parting};
use crate::{Snapshot, State};

/// All bodies are advanced together if there are fewer groups than this.
const MIN_GROUPS: usize = 4;

/// The largest number of attempts at a step. Each new attempt has larger groups, because bodies of different groups have met in the last
/// attempt.
const MAX_ATTEMPTS: u32 = 8;

/// After a step with too few groups, all bodies are advanced together for this many steps before the world looks for groups again.
const STEPS_TOGETHER: u32 = 8;

impl World {
    /// Tries to make a step in separate groups. Returns false, and leaves the state unchanged, if there are too few groups.
    pub(super) fn step_apart(
        &mut self,
        t: f64,
        dt: f64,
        moments: &[f64],
        see: &mut dyn FnMut(Snapshot),
    ) -> bool {
        self.together = self.together.saturating_sub(1);
        let has_enough =
            || (0..self.model.len()).filter(|&i| self.model.can_move(i)).nth(MIN_GROUPS - 1).is_some();
        if self.together > 0 || self.collider.is_none() || !self.model.is_local() || !has_enough() {
            return false;
        }
        let start = self.state.clone();
        let whole = std::mem::take(&mut self.solver);
        self.solver = whole.part(Vec::new());
        self.integrator.discontinuity();
        self.fly(t, dt);
        let flown = self.state.clone();
        // Pairs of bodies from different groups that have met. In the next attempt, both bodies of a pair are in the same group.
        let mut met = Vec::new();
        for attempt in 0..MAX_ATTEMPTS {
            let Some(collider) = &mut self.collider else { break };
            let ends = (&start, &flown);
            let parting = collider.part(&self.model, ends, dt, whole.contacts(), self.rest.held(), &met);
            let is_busy = parting.groups.iter().any(|group| group.is_busy);
            if is_busy && parting.groups.len() < MIN_GROUPS {
                break;
            }
            if attempt == 0 && !moments.is_empty() {
                let mut copy = self.clone();
                copy.state.clone_from(&start);
                copy.solver = whole.clone();
                copy.integrator.discontinuity();
                copy.decide_all(t);
                copy.follow_events(t, dt, moments, see);
            }
            if !is_busy {
                return true;
            }
            match self.advance_groups(t, dt, (&start, &flown), (&whole, parting)) {
                Ok(()) => return true,
                Err(new) => met.extend(new),
            }
        }
        self.state = start;
        self.solver = whole;
        self.integrator.discontinuity();
        self.together = STEPS_TOGETHER;
        false
    }

    /// Advances the groups with events, after all bodies have made the step without contacts.
    ///
    /// # Errors
    ///
    /// If a strong impact may have thrown a body into another group. The state is then restored, and the error lists the pairs of bodies
    /// that may have met, as far as they are known.
    fn advance_groups(
        &mut self,
        t: f64,
        dt: f64,
        (start, flown): (&State, &State),
        (whole, mut parting): (&Solver, Parting),
    ) -> Result<(), Vec<[usize; 2]>> {
        let mut end = flown.clone();
        let (held, is_decided) = (self.rest.clone(), self.is_decided);
        let mut parts = Vec::new();
        let (groups, ways) = parting.busy();
        for group in groups {
            self.state.clone_from(start);
            self.before.clone_from(start);
            self.integrator.discontinuity();
            let is_own = |body: &usize| group.bodies.binary_search(body).is_ok();
            let own = whole.contacts().iter().filter(|contact| contact.bodies.iter().any(is_own));
            let own: Vec<_> = own.cloned().collect();
            let known = self.parts.iter().position(|part| part.has(&own));
            self.solver = known.map_or_else(|| whole.part(own), |known| self.parts[known].clone());
            let Some(collider) = &mut self.collider else { return Ok(()) };
            collider.focus(group);
            self.model.focus(Some(group.bodies.clone()));
            if known.is_none() {
                self.decide_contacts(t);
            }
            self.follow_events(t, dt, &[], &mut |_| {});
            self.model.focus(None);
            let Some(collider) = &mut self.collider else { return Ok(()) };
            collider.unfocus(group, ways);
            for &i in &group.bodies {
                end.location[i] = self.state.location[i];
                end.velocity[i] = self.state.velocity[i];
                end.orientation[i] = self.state.orientation[i];
                end.angular_momentum[i] = self.state.angular_momentum[i];
            }
            end.accounts.add(1.0, self.state.accounts);
            end.accounts.add(-1.0, start.accounts);
            parts.push(std::mem::take(&mut self.solver));
        }
        let Some(collider) = &mut self.collider else { return Ok(()) };
        let have_failed = parts.iter().any(Solver::has_failed);
        let apart = collider.unite(&self.model, &end, parting);
        if let (Err(met), false) = (apart, have_failed) {
            self.state.clone_from(start);
            self.hold_again(held);
            self.is_decided = is_decided;
            return Err(met);
        }
        self.state = end;
        self.solver = whole.clone();
        self.solver.unite(&parts);
        self.solver.leave(collider.crowded());
        self.parts = parts;
        self.is_decided = self.solver.contacts().is_empty();
        self.integrator.discontinuity();
        Ok(())
    }

    /// Returns a copy of the world in which the modes of all contacts are decided, for snapshots. `None` if they are already decided in
    /// this world.
    pub(super) fn decided(&self) -> Option<World> {
        if self.is_stepped() {
            return Some(self.seen_by_moreau(self.time, &self.state));
        }
        let is_crowded = self.collider.as_ref().is_some_and(Collider::is_crowded);
        if self.is_decided && !is_crowded {
            return None;
        }
        let mut copy = self.clone();
        if let Some(collider) = copy.collider.as_mut().filter(|_| is_crowded) {
            if self.model.constraints().is_empty() {
                copy.crowd = collider.crowd_contacts(&self.model, self.time, &self.state);
            } else {
                collider.release();
                copy.disperse(self.time);
            }
        }
        copy.decide_all(self.time);
        copy.state.clone_from(&self.state);
        Some(copy)
    }

    /// Decides the modes of all contacts, unless they are already decided.
    pub(super) fn decide_all(&mut self, t: f64) {
        if !self.is_decided {
            self.decide_contacts(t);
        }
    }
}
