//! The equations of motion, as a method of integration sees them.

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

    /// Whether constraints hold bodies.
    #[must_use]
    pub fn is_constrained(&self) -> bool {
        !self.solver.is_idle(self.model)
    }

    /// All that acts at time `t`, s: the forces, and what the constraints take to be kept. Bodies whose motion is given must
    /// be where they are at that time.
    pub fn evaluate(&mut self, t: f64, state: &State, loads: &mut Loads) {
        self.model.sum(t, state, loads);
        self.solver.react(self.model, t, state, loads);
        self.model.bear(state, loads);
    }

    /// What each constraint does at the moment that was evaluated last.
    #[must_use]
    pub fn reactions(&self) -> Vec<Reaction> {
        self.solver.reactions(self.model)
    }

    /// The places where bodies stay in touch at the moment that was evaluated last.
    #[must_use]
    pub fn contacts(&self) -> Vec<ContactSnapshot> {
        self.solver.contact_snapshots(self.model)
    }

    /// Places the bodies whose motion is given where they are at time `t`, and then [evaluates](Self::evaluate).
    pub fn arrive(&mut self, t: f64, state: &mut State, loads: &mut Loads) {
        self.model.place(t, state);
        self.evaluate(t, state, loads);
    }

    /// The forces and the motors that push as hard as they can, without what the constraints take: for methods that keep these by
    /// impulses.
    pub fn evaluate_forces(&mut self, t: f64, state: &State, loads: &mut Loads) {
        self.model.sum(t, state, loads);
        self.solver.drive(t, state, loads);
        self.model.bear(state, loads);
    }

    /// Changes the velocities at the beginning of a step from `t` to `t` + `dt` such that bodies on which nothing acts
    /// within it are where the constraints hold at its end.
    pub(super) fn aim(&mut self, t: f64, dt: f64, state: &mut State) {
        self.solver.aim(self.model, t, dt, state);
    }

    /// To be called before the forces at this state at time `t` are evaluated.
    pub(super) fn begin(&mut self, t: f64, state: &State) {
        self.solver.begin(self.model, t, state);
    }

    /// To be called before a step of `dt` from this state at time `t`.
    pub(super) fn set_out(&mut self, t: f64, dt: f64, state: &State) {
        self.solver.begin(self.model, t, state);
        self.solver.set_out(dt);
    }

    /// After changes by hand: brings the bodies to where the constraints hold, and finds out which of these push. `loads` is
    /// room to work in.
    pub(super) fn start(&mut self, t: f64, state: &mut State, loads: &mut Loads) {
        self.model.place(t, state);
        self.solver.start(self.model, t, state, loads);
    }

    /// Whether something can happen within a step.
    pub(super) fn has_events(&self) -> bool {
        self.solver.has_events()
    }

    /// How far the bodies are from the next event, which has happened where this is negative; and its row.
    pub(super) fn margin(&mut self, t: f64, state: &State, loads: &mut Loads) -> (f64, usize) {
        self.solver.margin(self.model, t, state, loads)
    }

    /// At an event: takes its impulses, and finds out which constraints push from then on.
    pub(super) fn decide(&mut self, t: f64, state: &mut State, loads: &mut Loads) {
        self.solver.decide(self.model, t, state, loads);
    }

    /// Places the bodies whose motion is given, and moves the others the shortest way to where all constraints hold; takes out
    /// of velocities what leads away from there.
    pub(super) fn settle(&mut self, t: f64, state: &mut State) {
        self.model.place(t, state);
        self.solver.settle(self.model, t, state);
    }
}
