//! The equations of motion in the form that integration methods need.

use super::constraint::Solver;
use super::{ContactSnapshot, Loads, Model, Reaction, State};

/// Bodies, the forces on them, and the constraints that hold them together.
pub struct System<'a> {
    model: &'a Model,
    solver: &'a mut Solver,
}

impl<'a> System<'a> {
    pub(super) fn new(model: &'a Model, solver: &'a mut Solver) -> System<'a> {
        System { model, solver }
    }

    /// The masses, the forces and the constraints.
    #[must_use]
    pub fn model(&self) -> &'a Model {
        self.model
    }

    /// Whether there are active constraints.
    #[must_use]
    pub fn is_constrained(&self) -> bool {
        !self.solver.is_idle(self.model)
    }

    /// Sums up all loads at time `t`, s: the forces, and the constraint forces. Bodies with a given motion must already be placed for
    /// that time.
    pub fn evaluate(&mut self, t: f64, state: &State, loads: &mut Loads) {
        self.model.sum(t, state, loads);
        self.solver.react(self.model, t, state, loads);
        self.model.bear(state, loads);
    }

    /// The reactions of all constraints at the last evaluation.
    #[must_use]
    pub fn reactions(&self) -> Vec<Reaction> {
        self.solver.reactions(self.model)
    }

    /// The lasting contacts at the last evaluation.
    #[must_use]
    pub fn contacts(&self) -> Vec<ContactSnapshot> {
        self.solver.contact_snapshots(self.model)
    }

    /// Places the bodies with a given motion for time `t`, then [evaluates](Self::evaluate).
    pub fn arrive(&mut self, t: f64, state: &mut State, loads: &mut Loads) {
        self.model.place(t, state);
        self.evaluate(t, state, loads);
    }

    /// Sums up the forces, including motors at their limits, but no constraint forces: for methods that keep constraints by impulses.
    pub fn evaluate_forces(&mut self, t: f64, state: &State, loads: &mut Loads) {
        self.model.sum(t, state, loads);
        self.solver.drive(t, state, loads);
        self.model.bear(state, loads);
    }

    /// Changes the velocities at the start of a step from `t` to `t` + `dt` such that freely moving bodies satisfy the constraints at its
    /// end.
    pub(super) fn aim(&mut self, t: f64, dt: f64, state: &mut State) {
        self.solver.aim(self.model, t, dt, state);
    }

    /// Must be called before the forces at this state at time `t` are evaluated.
    pub(super) fn begin(&mut self, t: f64, state: &State) {
        self.solver.begin(self.model, t, state);
    }

    /// Must be called before a step of `dt` from this state at time `t`.
    pub(super) fn set_out(&mut self, t: f64, dt: f64, state: &State) {
        self.solver.begin(self.model, t, state);
        self.solver.set_out(dt);
    }

    /// After manual changes: moves the bodies to satisfy the constraints, and decides which of these push. `loads` is working memory.
    pub(super) fn start(&mut self, t: f64, state: &mut State, loads: &mut Loads) {
        self.model.place(t, state);
        self.solver.start(self.model, t, state, loads);
    }

    /// Whether events can occur within a step.
    pub(super) fn has_events(&self) -> bool {
        self.solver.has_events()
    }

    /// The distance of the bodies from the next event, negative after it, and its row.
    pub(super) fn margin(&mut self, t: f64, state: &State, loads: &mut Loads) -> (f64, usize) {
        self.solver.margin(self.model, t, state, loads)
    }

    /// At an event: applies its impulses, and decides which constraints push from then on.
    pub(super) fn decide(&mut self, t: f64, state: &mut State, loads: &mut Loads) {
        self.solver.decide(self.model, t, state, loads);
    }

    /// Places the bodies with a given motion, and moves the others the shortest distance to satisfy all constraints. Removes the
    /// components of velocities that would violate them.
    pub(super) fn settle(&mut self, t: f64, state: &mut State) {
        self.model.place(t, state);
        self.solver.settle(self.model, t, state);
    }
}
