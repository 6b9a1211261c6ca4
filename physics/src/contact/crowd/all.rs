//! Steps in which Moreau's scheme advances all bodies, without a search for events.

use std::sync::Arc;

use glam::DVec3;

use super::super::super::{Accounts, Breakdown, Loads, Model, State};
use super::super::closest_points::nearest;
use super::super::collider::Collider;
use super::super::lasting_contact::{LastingContact, spoke};
use super::super::path::pose;
use super::Crowd;
use super::substep::separate;
use super::substep_motion::{JAMMED_OVERLAP, MAX_CROWD_GAP, MAX_SEPARATION_ATTEMPTS};

impl Collider {
    /// Makes all present bodies that forces move the crowd.
    pub(crate) fn crowd_all(&mut self, model: &Model) {
        self.meet_bodies(model);
        let moves = |body: &usize| model.inverse_mass()[*body] != 0.0;
        self.crowd.bodies = (0..model.len()).filter(moves).collect();
        self.crowd.is_all = true;
        self.crowd.solver.count_soft_impacts();
        self.crowd.pile.hold_all();
    }

    /// Advances the crowd from time `t` by `dt` seconds. Returns a breakdown if this fails.
    pub(crate) fn advance_all(
        &mut self,
        model: &Model,
        (t, dt): (f64, f64),
        state: &mut State,
        loads: &mut Loads,
    ) -> Option<Breakdown> {
        let course = self.course(model, (t, dt), (state, state), loads);
        let failure = course.failure();
        self.crowd.put(course.last(), state);
        self.fastest = self.fastest.max(self.crowd.solver.fastest()).max(self.crowd.pile.fastest());
        self.crowd.course = Some(course);
        failure
    }

    /// Records how far all bodies have moved in a step of `dt` seconds. The list of near pairs is made anew if necessary.
    pub(crate) fn follow_step(&mut self, model: &Model, ends: (&State, &State), dt: f64) {
        self.follow(model, ends, dt);
    }

    /// Puts the crowd where it was at `time`, s, within the last step.
    pub(crate) fn crowd_at(&mut self, time: f64, model: &Model, state: &mut State, loads: &mut Loads) {
        let Some(mut course) = self.crowd.course.take() else { return };
        let now = self.moment(&mut course, time, model, loads);
        self.crowd.put(&now, state);
    }

    /// Returns the largest overlap of two bodies at the contacts of the crowd, m; 0 if none overlap.
    pub(crate) fn penetration(&self, model: &Model, state: &State) -> f64 {
        let overlap = |place: &LastingContact| -place.gap(place.bodies.map(|body| pose(body, model, state)));
        let of_pile = self.crowd.pile.contacts().map(overlap);
        of_pile.chain(self.crowd.places.iter().map(|place| overlap(place))).fold(0.0, f64::max)
    }

    /// Returns the contacts of the crowd at the end of the last step.
    pub(crate) fn last_places(&self, model: &Model, state: &State) -> Vec<Arc<LastingContact>> {
        let mut all = self.crowd.places.clone();
        if self.crowd.is_all && model.constraints().is_empty() {
            all.extend(self.places_of_pile(model, state).into_iter().map(Arc::new));
        }
        all
    }

    /// Returns the contacts of the pile at which bodies touch.
    pub(super) fn places_of_pile(&self, model: &Model, state: &State) -> Vec<LastingContact> {
        let touching = |place: &LastingContact| {
            let poses = place.bodies.map(|body| pose(body, model, state));
            let meeting = place.meet(poses);
            (meeting.gap <= self.touching_gap(place.bodies, model, state)).then(|| LastingContact {
                spoke: spoke(&place.touch.patches, [&poses[0], &poses[1]], &meeting),
                touch: place.touch.with(meeting),
                ..place.clone()
            })
        };
        self.crowd.pile.contacts().filter_map(touching).collect()
    }

    /// Ends a step of the pile: separates bodies that overlap too deeply.
    pub(crate) fn end_pile(&mut self, model: &Model, time: f64, state: &mut State) {
        for _ in 0..MAX_SEPARATION_ATTEMPTS {
            let is_deep = |place: &LastingContact| {
                place.gap(place.bodies.map(|body| pose(body, model, state))) < -JAMMED_OVERLAP * place.size
            };
            if !self.crowd.pile.contacts().any(is_deep) {
                break;
            }
            // What is moved apart must not be moved into its neighbors. Bodies that stay jammed overlap by what those around them allow,
            // which the report of the run says.
            let (all, _) = self.touching_in_crowd(model, state, MAX_CROWD_GAP);
            self.crowd.pile.take_contacts(all, model, state);
            separate(&mut self.crowd.pile, model, time, state);
        }
        self.crowd.course = None;
    }

    /// Stores the contacts of the crowd at the end of a step, and returns them.
    pub(super) fn accept_places(&mut self, all: Vec<LastingContact>) -> Vec<Arc<LastingContact>> {
        let all: Vec<_> = all.into_iter().map(Arc::new).collect();
        self.crowd.pushing.clear();
        self.crowd.course = None;
        let Crowd { bodies, places, .. } = &mut self.crowd;
        places.retain(|place| !place.is_of(bodies));
        places.extend(all.iter().cloned());
        all
    }

    /// Returns the forces of limits and motors in the last part of a step: the constraint, its row, and the multiplier of each.
    pub(crate) fn joint_forces(&self) -> &[(usize, usize, f64)] {
        self.crowd.solver.joint_forces()
    }

    /// Returns the bodies held at rest that a body of the crowd touches, or may hit within `dt` seconds. Only bodies for which `moves` is true
    /// count.
    pub(crate) fn may_be_hit(
        &self,
        model: &Model,
        state: &State,
        dt: f64,
        moves: impl Fn(usize) -> bool,
    ) -> Vec<usize> {
        let is_held = |body: usize| model.inverse_mass()[body] == 0.0 && model.can_move(body);
        let mut hit = Vec::new();
        for pair in self.crowd_pairs(model, state, dt) {
            let [a, b] = pair.bodies;
            let (held, other) = if is_held(a) { (a, b) } else { (b, a) };
            let comes = self.crowd.bodies.contains(&other) && moves(other) || model.motion(other).is_some();
            if !is_held(held) || !comes {
                continue;
            }
            let [Some(x), Some(y)] = pair.bodies.map(|body| self.solids[body].as_ref()) else { continue };
            let [p, q] = pair.bodies.map(|body| pose(body, model, state));
            let speed = state.velocity[other].length() + self.spin(other, model, state);
            let within =
                2.0 * speed * dt + super::substep_motion::PUSHING_CONTACT_TOLERANCE * self.size(pair.bodies);
            if nearest(x, &p, y, &q, f64::INFINITY).is_some_and(|near| near.gap <= within) {
                hit.push(held);
            }
        }
        hit
    }
}

impl Crowd {
    /// Computes the power of the loads without a potential on the crowd, W: the power that these loads would lose if the bodies stood still.
    pub(super) fn power(&self, model: &Model, t: f64, now: &State) -> Accounts {
        if self.is_all {
            // The crowd is all that moves, and its motion is all of the step.
            let mut loads = Loads::default();
            if model.does_work() || model.has_guided() {
                model.sum(t, now, &mut loads);
                model.bear(now, &mut loads);
            }
            return loads.power;
        }
        if !model.does_work() {
            return Accounts::default();
        }
        let (mut loads, mut still) = (Loads::default(), now.clone());
        for &i in &self.bodies {
            (still.velocity[i], still.angular_momentum[i]) = (DVec3::ZERO, DVec3::ZERO);
        }
        model.sum(t, &still, &mut loads);
        let others = loads.power;
        model.sum(t, now, &mut loads);
        loads.power.add(-1.0, others);
        loads.power
    }

    /// Copies the bodies of the crowd and the energy accounts into a state of all bodies.
    pub(super) fn put(&self, from: &State, into: &mut State) {
        for (at, &body) in self.bodies.iter().enumerate() {
            into.location[body] = from.location[at];
            into.velocity[body] = from.velocity[at];
            into.orientation[body] = from.orientation[at];
            into.angular_momentum[body] = from.angular_momentum[at];
        }
        into.accounts = from.accounts;
    }
}
