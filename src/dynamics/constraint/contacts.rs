//! The contacts among the constraints: adding, dropping and evaluating them, and the joints alone during impacts.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;

use super::super::contact::Closed;
use super::super::{BodyId, Breakdown, ContactSnapshot, Model, State};
use super::Law;
use super::friction::Grip;
use super::jacobian::{move_members, products};
use super::modes::Mode;
use super::solver::Solver;

impl Solver {
    /// Whether there are no active constraints.
    pub(in crate::dynamics) fn is_idle(&self, model: &Model) -> bool {
        model.constraints().is_empty() && self.contacts.is_empty()
    }

    /// The lasting contacts.
    pub(in crate::dynamics) fn contacts(&self) -> &[Arc<Closed>] {
        &self.contacts
    }

    /// Sets the lasting contacts. Returns whether they have changed; the modes of the rows must then be [decided](Self::decide).
    pub(in crate::dynamics) fn take_contacts(&mut self, contacts: Vec<Arc<Closed>>) -> bool {
        let is_same = |(old, new): (&Arc<Closed>, &Arc<Closed>)| old.is(new);
        let are_same =
            contacts.len() == self.contacts.len() && self.contacts.iter().zip(&contacts).all(is_same);
        if !are_same {
            self.contacts = contacts;
            self.forget();
        }
        !are_same
    }

    /// A solver for some of the contacts, with the history so far.
    pub(in crate::dynamics) fn part(&self, contacts: Vec<Arc<Closed>>) -> Solver {
        let (largest_rate, largest_acceleration) = (self.largest_rate, self.largest_acceleration);
        let changes = self.changes.clone();
        Solver { contacts, largest_rate, largest_acceleration, changes, ..Solver::default() }
    }

    /// Whether it has exactly these contacts, and their modes are decided.
    pub(in crate::dynamics) fn has(&self, contacts: &[Arc<Closed>]) -> bool {
        self.structure.is_some()
            && self.contacts.len() == contacts.len()
            && self.contacts.iter().zip(contacts).all(|(own, other)| Arc::ptr_eq(own, other))
    }

    /// Takes over the history and all contacts of other solvers. Their modes must then be [decided](Self::decide).
    pub(in crate::dynamics) fn unite(&mut self, parts: &[Solver]) {
        let mut contacts = Vec::new();
        for part in parts {
            self.largest_rate = self.largest_rate.max(part.largest_rate);
            self.largest_acceleration = self.largest_acceleration.max(part.largest_acceleration);
            for (bodies, changes) in &part.changes {
                let all = self.changes.entry(*bodies).or_default();
                *all = (*all).max(*changes);
            }
            self.failure = self.failure.or(part.failure);
            contacts.extend(part.contacts.iter().cloned());
        }
        contacts.sort_by_key(|contact| contact.bodies);
        self.contacts = contacts;
        self.forget();
    }

    /// Leaves the constraints of some bodies to another solver.
    pub(in crate::dynamics) fn leave(&mut self, bodies: &BTreeSet<usize>) {
        if self.away != *bodies {
            self.away.clone_from(bodies);
            self.forget();
        }
    }

    /// Closes the gaps of constraints by moving bodies the shortest distance.
    pub(in crate::dynamics) fn close_gaps(&mut self, model: &Model, t: f64, state: &mut State) {
        if !self.is_idle(model) {
            // Some rows are measured relative to the start of a step.
            self.begin(model, t, state);
            self.is_ready = false;
            self.measure(t, state);
            let (before, gaps) = (self.worst(), state.clone());
            self.settle_places(t, state);
            self.measure(t, state);
            // If rows contradict each other, gaps remain.
            if self.worst().is_nan() || self.worst() > before {
                state.clone_from(&gaps);
            }
        }
    }

    /// Closes the gaps of all contacts, whatever their modes were.
    pub(in crate::dynamics) fn close_all(&mut self, model: &Model, t: f64, state: &mut State) {
        if self.is_idle(model) {
            return;
        }
        self.begin(model, t, state);
        for (mode, law) in self.modes.iter_mut().zip(&self.laws) {
            *mode = match law {
                Law::Stop => Mode::Held,
                _ => Mode::first(law),
            };
        }
        let joints = model.constraints().len();
        for place in self.structure.iter().flat_map(|structure| &structure.places) {
            if place.constraint < joints {
                for row in (place.row..place.row + place.rows).filter(|&row| self.laws[row] == Law::Stop) {
                    self.modes[row] = if self.rows[row].violation < 0.0 { Mode::Held } else { Mode::Open };
                }
            }
        }
        self.hold();
        self.settle_places(t, state);
    }

    /// The speed below which each row counts as at rest, m/s.
    pub(super) fn stills(&self, model: &Model) -> Vec<f64> {
        let mut stills = vec![0.0; self.rows.len()];
        let places = self.structure.iter().flat_map(|structure| &structure.places);
        for place in places {
            if let Some(contact) = place.constraint.checked_sub(model.constraints().len()) {
                stills[place.row] = self.contacts[contact].still;
            }
        }
        stills
    }

    /// Whether a constraint concerns one of these bodies that can move.
    pub(in crate::dynamics) fn concerns(&self, bodies: &[usize]) -> bool {
        let Some(structure) = &self.structure else { return true };
        let holds = |body: &usize| {
            let member = structure.bodies.binary_search(body);
            member.is_ok_and(|member| self.members[member].inverse_mass != 0.0)
        };
        bodies.iter().any(holds)
    }

    /// Starts a step of `span` seconds, after [`begin`](Self::begin). It is not called to evaluate a state only.
    pub(in crate::dynamics) fn set_out(&mut self, span: f64) {
        self.span = span;
        self.is_unsolved = false;
        self.head();
    }

    /// Reports, after a step, that no friction forces fulfil the equations, as in Painlevé's paradox.
    pub(in crate::dynamics) fn blame_friction(&mut self, model: &Model, time: f64) {
        let Some(structure) = self.structure.as_ref().filter(|_| self.is_unsolved) else { return };
        let slides = |grip: &&Grip| self.modes[grip.row] == Mode::Slid;
        let Some(normal) = self.grips.iter().find(slides).map(|grip| grip.normal) else { return };
        if let Some(place) = structure.places.iter().find(|place| place.row == normal) {
            self.fail(self.broken(model, place.constraint, time, 0.0));
        }
    }

    /// Notes that the run cannot continue.
    pub(in crate::dynamics) fn fail(&mut self, breakdown: Breakdown) {
        self.failure = self.failure.or(Some(breakdown));
    }

    /// Whether the run cannot continue.
    pub(in crate::dynamics) fn has_failed(&self) -> bool {
        self.failure.is_some()
    }

    /// Drops the contacts that do not push. Returns whether there were any; the modes of the others must then be decided anew.
    pub(in crate::dynamics) fn drop_open_contacts(&mut self, model: &Model) -> bool {
        let joints = model.constraints().len();
        let is_held = |k: usize| {
            let row = self.first_row.get(joints + k).copied().flatten();
            row.is_some_and(|row| self.modes[row] == Mode::Held)
        };
        let keep: Vec<bool> = (0..self.contacts.len()).map(is_held).collect();
        if keep.iter().all(|keep| *keep) {
            return false;
        }
        let mut keep = keep.into_iter();
        self.contacts.retain(|_| keep.next().unwrap_or(false));
        self.forget();
        true
    }

    /// Solves A x = b for the active rows.
    #[inline]
    pub(super) fn solve(&mut self) {
        if self.factor.is_soft() {
            self.solve_softly();
        } else {
            self.factor.solve(&mut self.unknown);
        }
    }

    fn solve_softly(&mut self) {
        // Soft rows yield a little. Iterative refinement removes this error.
        let right = self.unknown.clone();
        self.factor.solve(&mut self.unknown);
        for _ in 0..REFINEMENTS {
            let mut left = right.clone();
            self.factor.subtract_product(&self.unknown, &mut left);
            self.factor.solve(&mut left);
            self.unknown.iter_mut().zip(&left).for_each(|(x, more)| *x += more);
        }
    }

    /// From now on, only the joints are kept, starting from a state that satisfies them. Impacts then respect the joints.
    pub(in crate::dynamics) fn hold_joints(&mut self, model: &Model, t: f64, state: &State) {
        self.is_ready = false;
        self.plan(model);
        self.measure(t, state);
        for (held, law) in self.held.iter_mut().zip(&self.laws) {
            *held = *law == Law::Tie;
        }
        self.factorise(true);
    }

    /// Removes velocities that violate the joints, after [`hold_joints`](Self::hold_joints) at these positions.
    pub(in crate::dynamics) fn obey_joints(&mut self, model: &Model, state: &mut State) {
        for (member, nature) in self.members.iter_mut().zip(&self.natures) {
            member.follow(nature, state);
        }
        self.settle_velocities(model, state);
    }

    /// The velocities and angular velocities that impulses and their moments give to two bodies under the joints, after
    /// [`hold_joints`](Self::hold_joints).
    pub(in crate::dynamics) fn respond(
        &mut self,
        model: &Model,
        state: &State,
        bodies: [usize; 2],
        pushes: [(DVec3, DVec3); 2],
    ) -> [(DVec3, DVec3); 2] {
        let mut free = [0, 1].map(|i| model.respond(bodies[i], state, pushes[i]));
        let Solver { structure: Some(structure), members, jacobian, unknown, .. } = self else { return free };
        let places = bodies.map(|body| structure.bodies.binary_search(&body).ok());
        for member in members.iter_mut() {
            (member.velocity, member.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
        }
        for (place, motion) in places.iter().zip(&free) {
            if let Some(place) = place {
                (members[*place].velocity, members[*place].angular_velocity) = *motion;
            }
        }
        products(structure, jacobian, members, unknown);
        unknown.iter_mut().for_each(|rate| *rate = -*rate);
        self.factor.solve(unknown);
        move_members(structure, jacobian, unknown, members);
        for (place, motion) in places.iter().zip(&mut free) {
            if let Some(place) = place {
                *motion = (members[*place].velocity, members[*place].angular_velocity);
            }
        }
        free
    }

    /// The points of contact and their forces at the last evaluation.
    pub(in crate::dynamics) fn contact_snapshots(&self, model: &Model) -> Vec<ContactSnapshot> {
        let Some(structure) = &self.structure else { return Vec::new() };
        let joints = model.constraints().len();
        let mut all: Vec<ContactSnapshot> = Vec::new();
        for (k, contact) in self.contacts.iter().enumerate() {
            let places = &structure.places;
            let Some(place) = places.iter().find(|place| place.constraint == joints + k) else { continue };
            let members = [place.bodies[0], place.bodies[1]].map(|member| &self.members[member]);
            all.push(contact.seen(members, |row, out| {
                let direction = self.jacobian[place.direction + row * place.bodies.len() + 1];
                *out += self.unknown[place.row + row] * direction.linear;
            }));
        }
        all.sort_by_key(|contact| contact.bodies);
        all
    }

    /// The reason why a run cannot continue if constraint `index` is broken.
    pub(super) fn broken(&self, model: &Model, index: usize, time: f64, missing: f64) -> Breakdown {
        match index.checked_sub(model.constraints().len()) {
            None => Breakdown::Broken { constraint: index, time, missing },
            Some(contact) => {
                Breakdown::Jammed { bodies: self.contacts[contact].bodies.map(BodyId::new), time }
            }
        }
    }
}

/// The number of refinements with soft rows. Each reduces the error by about the factor of softness.
const REFINEMENTS: usize = 3;
