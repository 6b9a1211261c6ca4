//! The equations of motion in the form that integration methods need: forces and constraints together.

use super::constraint::Solver;
use super::{ContactSnapshot, Loads, Model, Reaction, State};

/// The bodies of a world with their forces and constraints, as an integration method sees them.
pub struct System<'a> {
    model: &'a Model,
    solver: &'a mut Solver,
}

impl<'a> System<'a> {
    pub(super) fn new(model: &'a Model, solver: &'a mut Solver) -> System<'a> {
        System { model, solver }
    }

    /// Returns the model: the masses, the forces and the constraints.
    #[must_use]
    pub fn model(&self) -> &'a Model {
        self.model
    }

    /// Returns true if there are any joints or lasting contacts.
    #[must_use]
    pub fn is_constrained(&self) -> bool {
        !self.solver.is_idle(self.model)
    }

    /// Computes all loads at time `t`, s: the sums of the forces and of the constraint forces. Bodies with a given motion must already be
    /// at their places for this time.
    pub fn evaluate(&mut self, t: f64, state: &State, loads: &mut Loads) {
        self.model.sum(t, state, loads);
        self.solver.react(self.model, t, state, loads);
        self.model.bear(state, loads);
    }

    /// Returns the reactions of all constraints at the last evaluation, in the order in which the constraints were added.
    #[must_use]
    pub fn reactions(&self) -> Vec<Reaction> {
        self.solver.reactions(self.model)
    }

    /// Returns the lasting contacts with their forces at the last evaluation, which was for this state at time `t`, s.
    #[must_use]
    pub fn contacts(&mut self, t: f64, state: &State) -> Vec<ContactSnapshot> {
        self.solver.share_seen_forces(self.model, t, state);
        self.solver.contact_snapshots(self.model)
    }

    /// Places the bodies with a given motion for time `t`, s, then [evaluates](Self::evaluate) all loads.
    pub fn arrive(&mut self, t: f64, state: &mut State, loads: &mut Loads) {
        self.model.place(t, state);
        self.evaluate(t, state, loads);
    }

    /// Computes the sums of the forces at time `t`, s, including motors at their limits and sliding friction, but without constraint
    /// forces. For methods that satisfy constraints by impulses.
    pub fn evaluate_forces(&mut self, t: f64, state: &State, loads: &mut Loads) {
        self.model.sum(t, state, loads);
        self.solver.drive(t, state, loads);
        self.model.bear(state, loads);
    }

    /// Corrects the velocities at the start of a step from `t` to `t` + `dt` (s), so that freely moving bodies satisfy the constraints at
    /// its end.
    pub(super) fn aim(&mut self, t: f64, dt: f64, state: &mut State) {
        self.solver.aim(self.model, t, dt, state);
    }

    /// Prepares the constraints for the evaluation of forces at this state at time `t`, s.
    pub(super) fn begin(&mut self, t: f64, state: &State) {
        self.solver.begin(self.model, t, state);
    }

    /// Prepares the constraints for a step of `dt` seconds from this state at time `t`, s.
    pub(super) fn set_out(&mut self, t: f64, dt: f64, state: &State) {
        self.solver.begin(self.model, t, state);
        self.solver.set_out(dt);
    }

    /// Restores the constraints after a change from outside: moves the bodies to satisfy them, and decides which constraints are active.
    /// `loads` is working memory.
    pub(super) fn start(&mut self, t: f64, state: &mut State, loads: &mut Loads) {
        self.model.place(t, state);
        self.solver.start(self.model, t, state, loads);
    }

    /// Returns true if events, such as a rope becoming taut, can occur within a step.
    pub(super) fn has_events(&self) -> bool {
        self.solver.has_events()
    }

    /// Returns the distance of the state from the next event, in units of the event's tolerance, and the constraint row of this event. The
    /// distance is negative after the event.
    pub(super) fn margin(&mut self, t: f64, state: &State, loads: &mut Loads) -> (f64, usize) {
        self.solver.margin(self.model, t, state, loads)
    }

    /// Handles an event of the constraints: applies its impulses, and decides which constraints are active from then on.
    pub(super) fn decide(&mut self, t: f64, state: &mut State, loads: &mut Loads) {
        self.solver.decide(self.model, t, state, loads);
    }

    /// Projects a state onto the constraints. Places the bodies with a given motion, moves the other bodies the shortest distance to
    /// satisfy all constraints, and removes the velocity components that would violate them.
    pub(super) fn settle(&mut self, t: f64, state: &mut State) {
        self.model.place(t, state);
        self.solver.settle(self.model, t, state);
    }
}
