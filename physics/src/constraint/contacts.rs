//! Lasting contacts as constraints of the solver: adding, dropping and evaluating them. Also the response of the joints to impacts.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;

use super::super::contact::LastingContact;
use super::super::{BodyId, Breakdown, ContactSnapshot, Model, State};
use super::Law;
use super::events::VIOLATION_TOLERANCE;
use super::friction::FrictionPair;
use super::jacobian::{move_members, products};
use super::row_modes::Mode;
use super::separate::MAX_SHIFT;
use super::solver::Solver;

impl Solver {
    /// Returns true if the solver has no constraints at all: neither joints nor lasting contacts.
    pub(crate) fn is_idle(&self, model: &Model) -> bool {
        model.constraints().is_empty() && self.contacts.is_empty()
    }

    /// Returns the lasting contacts, which the solver treats as constraints.
    pub(crate) fn contacts(&self) -> &[Arc<LastingContact>] {
        &self.contacts
    }

    /// Replaces the lasting contacts of the solver. Returns true if they differ from the previous ones; the modes of the constraint rows
    /// must then be [decided](Self::decide) again.
    pub(crate) fn take_contacts(&mut self, contacts: Vec<Arc<LastingContact>>) -> bool {
        let is_same = |(old, new): (&Arc<LastingContact>, &Arc<LastingContact>)| old.is(new);
        let are_same =
            contacts.len() == self.contacts.len() && self.contacts.iter().zip(&contacts).all(is_same);
        if !are_same {
            self.contacts = contacts;
            self.forget();
        }
        !are_same
    }

    /// Creates a solver for these contacts only, with the typical rates and accelerations of this solver.
    pub(crate) fn part(&self, contacts: Vec<Arc<LastingContact>>) -> Solver {
        let Solver { step, largest_rate, largest_acceleration, speed_by_loads, .. } = *self;
        Solver { contacts, step, largest_rate, largest_acceleration, speed_by_loads, ..Solver::default() }
    }

    /// Returns true if the solver has exactly these contacts and the modes of their constraint rows are decided.
    pub(crate) fn has(&self, contacts: &[Arc<LastingContact>]) -> bool {
        self.structure.is_some()
            && self.contacts.len() == contacts.len()
            && self.contacts.iter().zip(contacts).all(|(own, other)| Arc::ptr_eq(own, other))
    }

    /// Replaces the contacts of this solver by those of other solvers, and merges their histories into its own. The modes of the constraint
    /// rows must then be [decided](Self::decide) again.
    pub(crate) fn unite(&mut self, parts: &[Solver]) {
        let mut contacts = Vec::new();
        for part in parts {
            self.largest_rate = self.largest_rate.max(part.largest_rate);
            self.largest_acceleration = self.largest_acceleration.max(part.largest_acceleration);
            self.speed_by_loads = self.speed_by_loads.max(part.speed_by_loads);
            self.failure = self.failure.or(part.failure);
            contacts.extend(part.contacts.iter().cloned());
        }
        contacts.sort_by_key(|contact| contact.bodies);
        self.contacts = contacts;
        self.forget();
    }

    /// Excludes the constraints of these bodies, because another solver handles them. Replaces the previous set of excluded bodies.
    pub(crate) fn leave(&mut self, bodies: &BTreeSet<usize>) {
        if self.away != *bodies {
            self.away.clone_from(bodies);
            self.forget();
        }
    }

    /// Closes the gaps of active constraints by moving the bodies the shortest distance. If this enlarges the largest error, the bodies
    /// return to their places.
    pub(crate) fn close_gaps(&mut self, model: &Model, t: f64, state: &mut State) {
        if !self.is_idle(model) {
            // The errors of some constraint rows are measured relative to the start of a step.
            self.begin(model, t, state);
            self.close_held(t, state);
        }
    }

    /// Closes the gaps of the rows that are held, after [`hold`](Self::hold).
    fn close_held(&mut self, t: f64, state: &mut State) {
        self.is_ready = false;
        self.measure(t, state);
        let held = (0..self.rows.len()).filter(|&row| self.held[row]);
        let largest = held.map(|row| self.rows[row].violation.abs() / self.unit(row)).fold(0.0, f64::max);
        let (before, gaps) = (self.worst(), state.clone());
        self.settle_places(t, state);
        self.measure(t, state);
        let moved = state.location.iter().zip(&gaps.location).map(|(now, then)| now.distance(*then));
        let is_far = moved.fold(0.0, f64::max) > MAX_SHIFT * largest * self.rows.len() as f64;
        // If constraint rows contradict each other, their gaps cannot all close.
        if self.worst().is_nan() || self.worst() > before || is_far {
            state.clone_from(&gaps);
        }
    }

    /// Closes the gaps of all contacts, also of those that were open or sliding, as [`close_gaps`](Self::close_gaps) does. Limits of joints
    /// are corrected only where they are exceeded.
    pub(crate) fn close_all(&mut self, model: &Model, t: f64, state: &mut State) {
        if self.is_idle(model) {
            return;
        }
        self.begin(model, t, state);
        for (mode, law) in self.modes.iter_mut().zip(&self.laws) {
            *mode = match law {
                Law::Inequality => Mode::Held,
                _ => Mode::first(law),
            };
        }
        let joints = model.constraints().len();
        for place in self.structure.iter().flat_map(|structure| &structure.places) {
            if place.constraint < joints {
                for row in
                    (place.row..place.row + place.rows).filter(|&row| self.laws[row] == Law::Inequality)
                {
                    self.modes[row] = if self.rows[row].violation < 0.0 { Mode::Held } else { Mode::Open };
                }
            }
        }
        self.hold();
        self.close_held(t, state);
    }

    /// Returns the speed, m/s, below which the bodies at each constraint row count as at rest, one entry per row; 0 for rows of joints and
    /// friction.
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

    /// Returns true if a constraint acts on at least one movable body of this list, or if the constraints are not laid out yet.
    pub(crate) fn concerns(&self, bodies: &[usize]) -> bool {
        let Some(structure) = &self.structure else { return true };
        let holds = |body: &usize| {
            let member = structure.bodies.binary_search(body);
            member.is_ok_and(|member| self.members[member].inverse_mass != 0.0)
        };
        bodies.iter().any(holds)
    }

    /// Prepares friction and stops for a step of `span` seconds, after [`begin`](Self::begin). Evaluating a state without a step does not
    /// need this call.
    pub(crate) fn set_out(&mut self, span: f64) {
        self.span = span;
        (self.is_unsolved, self.is_implausible) = (false, false);
        self.touched.clear();
        if self.has_modes {
            let laws = self.laws.iter().zip(&self.rows);
            self.touched.extend(laws.map(|(law, row)| {
                *law == Law::Inequality && row.violation <= row.tolerance(VIOLATION_TOLERANCE)
            }));
        }
        self.head();
    }

    /// Reports a breakdown after a step if the step's equations of sliding friction had no solution, as in Painlevé's paradox.
    pub(crate) fn blame_friction(&mut self, model: &Model, time: f64) {
        let Some(structure) = self.structure.as_ref().filter(|_| self.is_unsolved) else { return };
        let slides = |grip: &&FrictionPair| self.modes[grip.row] == Mode::Slid;
        let Some(normal) = self.grips.iter().find(slides).map(|grip| grip.normal) else { return };
        if let Some(place) = structure.places.iter().find(|place| place.row == normal) {
            self.fail(self.broken(model, place.constraint, time, 0.0));
        }
    }

    /// Records why the run cannot continue, unless an earlier reason is recorded.
    pub(crate) fn fail(&mut self, breakdown: Breakdown) {
        self.failure = self.failure.or(Some(breakdown));
    }

    /// Returns true if the run cannot continue.
    pub(crate) fn has_failed(&self) -> bool {
        self.failure.is_some()
    }

    /// Drops the contacts that do not push. Returns true if any contact was dropped; the modes of the remaining contacts must then be
    /// decided again.
    pub(crate) fn drop_open_contacts(&mut self, model: &Model) -> bool {
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

    /// Solves A x = b for the active constraint rows, where A = J M⁻¹ Jᵀ. `unknown` holds b before the call and x after it.
    #[inline]
    pub(super) fn solve(&mut self) {
        if self.factor.is_soft() {
            self.solve_softly();
        } else {
            self.factor.solve(&mut self.unknown);
        }
    }

    fn solve_softly(&mut self) {
        // For soft constraint rows, the factors belong to a slightly enlarged diagonal. Iterative refinement removes the resulting error.
        let right = self.unknown.clone();
        self.factor.solve(&mut self.unknown);
        for _ in 0..ITERATIVE_REFINEMENTS {
            let mut left = right.clone();
            self.factor.subtract_product(&self.unknown, &mut left);
            self.factor.solve(&mut left);
            self.unknown.iter_mut().zip(&left).for_each(|(x, more)| *x += more);
        }
    }

    /// Activates only the constraint rows of the joints, at a state that satisfies them. The computed impacts then respect the joints.
    pub(crate) fn hold_joints(&mut self, model: &Model, t: f64, state: &State) {
        self.is_ready = false;
        self.plan(model);
        self.measure(t, state);
        for (held, law) in self.held.iter_mut().zip(&self.laws) {
            *held = *law == Law::Equality;
        }
        self.factorise(true);
    }

    /// Removes the velocity components that violate the joints. [`hold_joints`](Self::hold_joints) must have run at the same positions.
    pub(crate) fn obey_joints(&mut self, model: &Model, state: &mut State) {
        for (member, nature) in self.members.iter_mut().zip(&self.natures) {
            member.follow(nature, state);
        }
        self.settle_velocities(model, state);
    }

    /// Computes how two bodies respond to impulses while the joints hold. Each entry of `pushes` is an impulse and its moment about the
    /// center of mass; each entry of the result is a change of velocity and of angular velocity. [`hold_joints`](Self::hold_joints) must
    /// have run before.
    pub(crate) fn respond(
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
        for (body, motion) in bodies.into_iter().zip(&mut free) {
            *motion = self.response_of(body).unwrap_or(*motion);
        }
        free
    }

    /// Returns the indices of the bodies with constraints, in ascending order.
    pub(crate) fn bodies(&self) -> Vec<usize> {
        self.structure.as_ref().map_or(Vec::new(), |structure| structure.bodies.clone())
    }

    /// Returns the changes of velocity and of angular velocity of a body by the last impulses that [`respond`](Self::respond) applied;
    /// `None` for a body without joints.
    pub(crate) fn response_of(&self, body: usize) -> Option<(DVec3, DVec3)> {
        let member = self.structure.as_ref()?.bodies.binary_search(&body).ok()?;
        Some((self.members[member].velocity, self.members[member].angular_velocity))
    }

    /// Returns the place and the forces of each lasting contact at the last evaluation of forces, sorted by bodies.
    pub(crate) fn contact_snapshots(&self, model: &Model) -> Vec<ContactSnapshot> {
        let Some(structure) = &self.structure else { return Vec::new() };
        let joints = model.constraints().len();
        let mut all: Vec<ContactSnapshot> = Vec::new();
        for (k, contact) in self.contacts.iter().enumerate() {
            let places = &structure.places;
            let Some(place) = places.iter().find(|place| place.constraint == joints + k) else { continue };
            let members = [place.bodies[0], place.bodies[1]].map(|member| &self.members[member]);
            all.push(contact.snapshot(members, |row, out| {
                let direction = self.jacobian[place.direction + row * place.bodies.len() + 1];
                *out += self.unknown[place.row + row] * direction.linear;
            }));
        }
        all.sort_by_key(|contact| contact.bodies);
        all
    }

    /// Returns the reason why the run stops if constraint `index` fails: a broken joint or a jammed contact. `missing` is the error of the
    /// constraint. If it is not finite, the run diverged, because a body of the constraint has no finite position.
    pub(super) fn broken(&self, model: &Model, index: usize, time: f64, missing: f64) -> Breakdown {
        if !missing.is_finite()
            && let Some(body) = self.lost_body(index)
        {
            return Breakdown::Diverged { body: BodyId::new(body), time };
        }
        match index.checked_sub(model.constraints().len()) {
            None => Breakdown::Broken { constraint: index, time, missing },
            Some(contact) => {
                Breakdown::Jammed { bodies: self.contacts[contact].bodies.map(BodyId::new), time }
            }
        }
    }

    /// Returns the body of constraint `index` that is most likely to blame for a value that is not finite: a movable body without a finite
    /// position, or else its first movable body. `None` if there is none.
    fn lost_body(&self, index: usize) -> Option<usize> {
        let structure = self.structure.as_ref()?;
        let place = structure.places.iter().find(|place| place.constraint == index)?;
        let movable = || place.bodies.iter().filter(|member| self.members[**member].inverse_mass != 0.0);
        let is_lost = |member: &&usize| {
            let member = &self.members[**member];
            !(member.location.is_finite() && member.orientation.is_finite())
        };
        let member = movable().find(is_lost).or(movable().next())?;
        Some(structure.bodies[*member])
    }
}

/// The number of iterative refinements if constraint rows are soft. Each multiplies the error by about the relative softness of the rows.
const ITERATIVE_REFINEMENTS: usize = 3;
