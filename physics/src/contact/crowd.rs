//! The crowd: the bodies that Moreau's scheme advances, because they have too many contact events in a step.
//!
//! Some bodies hit, grip and release each other so often that it would take too long to follow each event: a chain that falls on a floor, a
//! heap that settles. Moreau's scheme advances such bodies to the end of the step. Bodies to which this happens repeatedly stay in the
//! crowd for some more steps.

mod all;
mod heap;
mod hits;
mod impulses;
mod substep;
mod substep_motion;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use self::heap::is_heap;
use self::substep_motion::SubstepMotion;
use super::super::constraint::{Pile, Solver};
use super::super::{BodyId, ContactSnapshot, Impact, Loads, Model, State};
use super::collider::{Collider, Touching};
use super::lasting_contact::LastingContact;
use super::laws::LawBook;

/// The largest number of further steps for which a body stays in the crowd. Without further steps, a settling heap would collect thousands of
/// events in each step before it joins the crowd again.
const MAX_FURTHER_STEPS: u32 = 16;

/// The set of bodies that Moreau's scheme advances, with their contacts and computed motion.
#[derive(Clone, Default)]
pub(crate) struct Crowd {
    bodies: BTreeSet<usize>,
    /// Finds the impulses of mechanisms and of all that touches them. `pile` finds the others.
    solver: Solver,
    pile: Pile,
    /// Closes the joints after a substep, without contacts.
    joints: Solver,
    /// The motion of the crowd until the end of the step; `None` until it is computed.
    course: Option<SubstepMotion>,
    /// The contacts of the crowd at the end of the last step.
    places: Vec<Arc<LastingContact>>,
    /// The impacts in the last substep of Moreau's scheme.
    impacts: Vec<Impact>,
    /// The pairs of bodies with contact forces between them in the last substep, in ascending order.
    pushing: Vec<[usize; 2]>,
    /// For each body that joined the crowd recently, for how many further steps it stays there.
    again: BTreeMap<usize, Again>,
    /// How well the laws that no contact can break have been kept.
    laws: LawBook,
    /// True if Moreau's scheme handles all contacts. Bodies held at rest are immovable then.
    is_all: bool,
    /// The bodies that Moreau's scheme has advanced as part of a heap, that is, of many touching bodies.
    heaps: BTreeSet<usize>,
}

/// How long a body stays in the crowd.
#[derive(Clone, Copy, Default)]
struct Again {
    /// The remaining number of further steps in the crowd.
    left: u32,
    /// The number of further steps that the body got when it last joined. It doubles if the body has to join again right after these
    /// steps.
    span: u32,
    /// True in the step right after the further steps have ended.
    is_over: bool,
}

impl Crowd {
    /// Returns true if no bodies are in the crowd.
    pub(crate) fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Returns a copy of the crowd without its computed motion.
    pub(super) fn without_course(&self) -> Crowd {
        Crowd { course: None, ..self.clone() }
    }

    pub(super) fn bodies(&self) -> impl Iterator<Item = &usize> {
        self.bodies.iter()
    }

    /// Removes these bodies from the crowd.
    pub(super) fn lose(&mut self, bodies: &[usize]) {
        for body in bodies {
            self.bodies.remove(body);
            self.again.remove(body);
            self.heaps.remove(body);
        }
        self.places.retain(|place| !place.bodies.iter().any(|body| bodies.contains(body)));
        self.pile.lose(bodies);
        self.course = None;
    }

    /// Restricts the crowd to the given bodies, whose indices are in ascending order. Returns the bodies that are set aside.
    pub(super) fn focus(&mut self, bodies: &[usize]) -> BTreeSet<usize> {
        let is_here = |body: &usize| bodies.binary_search(body).is_ok();
        let (here, others) = std::mem::take(&mut self.bodies).into_iter().partition(is_here);
        self.bodies = here;
        self.course = None;
        others
    }

    /// Ends the restriction by `focus`: the bodies that were set aside join the crowd again.
    pub(super) fn unfocus(&mut self, others: BTreeSet<usize>) {
        self.bodies.extend(others);
        self.course = None;
    }

    /// Returns true if Moreau's scheme handles the contacts between two bodies: one is in the crowd, and the other is in the crowd or immovable.
    /// A body held at rest is not immovable: whatever hits it releases it. `is_in` tells whether a body is in the crowd.
    pub(super) fn holds(&self, bodies: [usize; 2], is_in: impl Fn(usize) -> bool, model: &Model) -> bool {
        let is_immovable = |body: usize| {
            if self.is_all { model.inverse_mass()[body] == 0.0 } else { !model.can_move(body) }
        };
        bodies.iter().any(|&body| is_in(body)) && bodies.iter().all(|&body| is_in(body) || is_immovable(body))
    }

    /// Returns true if a body is in the crowd.
    pub(super) fn has(&self, body: usize) -> bool {
        self.bodies.contains(&body)
    }
}

impl Collider {
    /// Returns the indices of the bodies in the crowd.
    pub(crate) fn crowded(&self) -> &BTreeSet<usize> {
        &self.crowd.bodies
    }

    /// Returns true if at least one of two bodies is in the crowd.
    pub(crate) fn is_in_crowd(&self, bodies: [usize; 2]) -> bool {
        bodies.iter().any(|body| self.crowd.bodies.contains(body))
    }

    /// Returns true if all bodies of the crowd remain in it for the next step. `places` are the contacts of the crowd.
    pub(crate) fn crowd_stays(&self, places: &[Arc<LastingContact>]) -> bool {
        let stays = |body: &usize| self.crowd.again.get(body).is_some_and(|again| again.left > 0);
        is_heap(places) || self.crowd.bodies.iter().all(stays)
    }

    /// Returns the contacts of the crowd's bodies at the end of the last step, with the forces that Moreau's scheme found.
    pub(crate) fn crowd_contacts(&self, model: &Model, t: f64, state: &State) -> Vec<ContactSnapshot> {
        let is_here = |place: &&Arc<LastingContact>| place.is_of(&self.crowd.bodies);
        let places: Vec<_> = self.crowd.places.iter().filter(is_here).cloned().collect();
        if model.constraints().is_empty() {
            let of_pile = if self.crowd.is_all { self.places_of_pile(model, state) } else { Vec::new() };
            let all = of_pile.iter().chain(places.iter().map(|place| &**place));
            return self.crowd.pile.last_forces(all, model, state);
        }
        let (free, jointed) = self::impulses::without_joints(owned(&places), model);
        let mut forces = self.crowd.pile.last_forces(&free, model, state);
        forces.extend(self.crowd.solver.last_forces(shared(jointed), model, t, state));
        forces.sort_by_key(|contact| contact.bodies);
        forces
    }

    /// Computes the contact forces between resting bodies. `loads` are all other forces and torques on these bodies.
    pub(crate) fn forces_at_rest(
        &self,
        places: &[Arc<LastingContact>],
        model: &Model,
        (t, state): (f64, &State),
        loads: &Loads,
    ) -> Vec<ContactSnapshot> {
        if model.constraints().is_empty() {
            return self.crowd.pile.forces_at_rest(owned(places), (model, state), loads);
        }
        let (free, jointed) = self::impulses::without_joints(owned(places), model);
        let mut forces = self.crowd.pile.forces_at_rest(free, (model, state), loads);
        forces.extend(self.crowd.solver.forces_at_rest(shared(jointed), model, (t, state), loads));
        forces.sort_by_key(|contact| contact.bodies);
        forces
    }

    /// Returns true if a body is in the crowd, has just left it, or has been in it as part of a heap.
    pub(crate) fn was_in_crowd(&self, body: usize) -> bool {
        self.crowd.again.contains_key(&body) || self.crowd.heaps.contains(&body)
    }

    /// Removes all bodies from the crowd. The number of further steps of each body is kept.
    pub(crate) fn dissolve(&mut self) {
        self.crowd.bodies.clear();
    }

    /// Adds bodies to the crowd for this step and some further steps, with all bodies that touch them or are joined to them. Returns true if the
    /// crowd has grown.
    pub(crate) fn join(&mut self, model: &Model, state: &State, seeds: &[usize]) -> bool {
        let before = self.crowd.bodies.clone();
        let has_grown = self.gather(model, state, seeds);
        self.let_stay(&before);
        has_grown
    }

    /// Sets the number of further steps for the bodies that have joined the crowd since its set of bodies was `before`. All of them get the
    /// largest number among them.
    fn let_stay(&mut self, before: &BTreeSet<usize>) {
        let mut longest = 0;
        for body in self.crowd.bodies.difference(before) {
            let again = self.crowd.again.entry(*body).or_default();
            longest = longest.max(again.left).max((2 * again.span).clamp(1, MAX_FURTHER_STEPS));
        }
        for body in self.crowd.bodies.difference(before) {
            self.crowd.again.insert(*body, Again { left: longest, span: longest, is_over: false });
        }
        if self.crowd.bodies.len() > before.len() {
            self.crowd.course = None;
        }
    }

    /// Adds the bodies `seeds` to the crowd, with all bodies that touch them or are joined to them. Returns true if the crowd has grown.
    pub(crate) fn gather(&mut self, model: &Model, state: &State, seeds: &[usize]) -> bool {
        let can_move = |body: &usize| model.inverse_mass()[*body] != 0.0;
        let mut links: Vec<Vec<usize>> =
            self.touching_all(model, state).iter().map(|pair| pair.bodies.to_vec()).collect();
        links.extend(
            model.constraints().iter().map(|joint| joint.bodies().iter().map(|body| body.index()).collect()),
        );
        let before = self.crowd.bodies.len();
        let mut new: Vec<usize> = seeds.iter().copied().filter(can_move).collect();
        while let Some(body) = new.pop() {
            if self.crowd.bodies.insert(body) {
                let linked = links.iter().filter(|bodies| bodies.contains(&body)).flatten();
                new.extend(linked.copied().filter(can_move));
            }
        }
        let has_grown = self.crowd.bodies.len() > before;
        if has_grown {
            self.crowd.course = None;
        }
        has_grown
    }

    /// Updates the crowd at the beginning of a step of `dt` seconds. Counts down the further steps of the bodies being advanced, drops bodies in
    /// free flight, and adds bodies that touch the remaining ones or may hit them. Returns true if bodies were added to the remaining ones.
    pub(crate) fn stay(&mut self, model: &Model, state: &State, dt: f64) -> bool {
        let Collider { crowd, focus, .. } = self;
        let is_here =
            |body: &usize| focus.as_ref().is_none_or(|focus| focus.bodies.binary_search(body).is_ok());
        crowd.again.retain(|body, again| !is_here(body) || !again.is_over);
        for again in crowd.again.iter_mut().filter(|(body, _)| is_here(body)).map(|(_, again)| again) {
            again.is_over = again.left == 0;
            again.left = again.left.saturating_sub(1);
        }
        if self.crowd.bodies.is_empty() {
            return false;
        }
        let mut held = self.leaning(model, state);
        held.extend(model.constraints().iter().flat_map(|joint| joint.bodies()).map(BodyId::index));
        // Bodies in free flight leave the crowd, so that they rebound from the bodies that they hit.
        let seeds: Vec<usize> = std::mem::take(&mut self.crowd.bodies).intersection(&held).copied().collect();
        let longest = |crowd: &Crowd| {
            seeds.iter().filter_map(|body| crowd.again.get(body)).map(|again| again.left).max()
        };
        let left = longest(&self.crowd).unwrap_or(0);
        self.gather(model, state, &seeds);
        self.expect_hits(model, state, dt);
        for &body in &self.crowd.bodies {
            self.crowd.again.entry(body).or_insert(Again { left, span: left, is_over: false });
        }
        self.crowd.bodies.len() > seeds.len()
    }

    /// Forgets for how many further steps bodies stay in the crowd.
    pub(crate) fn release(&mut self) {
        self.crowd.again.clear();
    }

    /// Returns all contact points of touching bodies, including those in the crowd.
    pub(super) fn touching_all(&mut self, model: &Model, state: &State) -> Vec<Touching> {
        let bodies = std::mem::take(&mut self.crowd.bodies);
        let touching = self.touching(model, state);
        self.crowd.bodies = bodies;
        touching
    }
}

/// Returns copies of contacts.
fn owned(places: &[Arc<LastingContact>]) -> Vec<LastingContact> {
    places.iter().map(|place| (**place).clone()).collect()
}

/// Returns contacts in the form in which the general solver takes them.
fn shared(places: Vec<LastingContact>) -> Vec<Arc<LastingContact>> {
    places.into_iter().map(Arc::new).collect()
}
