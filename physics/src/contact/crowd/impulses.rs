//! What finds the impulses of a substep: a pile if there are no joints, and otherwise the general solver.

use std::sync::Arc;

use super::super::super::constraint::{Pile, Purpose, Solver, Struck};
use super::super::super::{Loads, Model, State};
use super::super::lasting_contact::LastingContact;
use super::substep_motion::PUSHING_CONTACT_TOLERANCE;

/// Finds the impulses of all contacts, limits and motors in a substep. The functions are called in the order in which they stand here.
pub(super) trait Impulses {
    /// Takes the possible contacts of a substep with its start and its length, s. Bodies may approach only so fast that
    /// no gap closes before its end.
    fn begin(&mut self, contacts: Vec<LastingContact>, model: &Model, span: (f64, f64), state: &mut State);

    /// Applies the impulses of the impacts within the substep.
    fn strike(&mut self, model: &Model, span: (f64, f64), state: &mut State, loads: &Loads) -> Struck;

    /// Brings the ends of joints together at the middle of the substep.
    fn join(&mut self, model: &Model, t: f64, state: &mut State);

    /// Measures the contacts at the middle of the substep.
    fn measure(&mut self, model: &Model, t: f64, state: &mut State);

    /// Applies the impulses of the forces in half a substep, which lasts for `half` seconds.
    fn push(&mut self, model: &Model, half: f64, state: &mut State);

    /// Returns the two bodies of the contact with the largest normal impulse, and the sum of all normal impulses, N s. `None` if no contact
    /// pushes.
    fn hardest_contact(&self) -> Option<([usize; 2], f64)>;

    /// Returns the typical length of the smallest body in contact, m.
    fn least_size(&self) -> f64;

    /// Returns the largest error of the joints at the middle of the substep, m.
    fn widest_joint(&self) -> f64;

    /// Returns the pairs of bodies whose contacts push.
    fn pushing_pairs(&self) -> Vec<[usize; 2]>;

    /// Measures the overlaps of bodies at a state. Returns true if any of them is too deep to be ignored.
    fn are_within(&mut self, model: &Model, t: f64, state: &State) -> bool;

    /// Moves overlapping bodies apart. [`are_within`](Self::are_within) must have measured the overlaps at this state.
    fn move_apart(&mut self, model: &Model, state: &mut State);
}

impl Impulses for Pile {
    fn begin(
        &mut self,
        contacts: Vec<LastingContact>,
        model: &Model,
        (_, part): (f64, f64),
        state: &mut State,
    ) {
        self.take_contacts(contacts, model, state);
        self.aim(part, PUSHING_CONTACT_TOLERANCE);
    }

    fn strike(&mut self, model: &Model, span: (f64, f64), state: &mut State, loads: &Loads) -> Struck {
        let struck = self.strike_all(model, span, (state, loads));
        self.aim_at_middle();
        struck
    }

    fn join(&mut self, _model: &Model, _t: f64, _state: &mut State) {}

    fn measure(&mut self, model: &Model, _t: f64, state: &mut State) {
        Pile::measure(self, model, state);
    }

    fn push(&mut self, model: &Model, half: f64, state: &mut State) {
        self.push_all(model, half, state);
    }

    fn hardest_contact(&self) -> Option<([usize; 2], f64)> {
        Pile::hardest_contact(self)
    }

    fn least_size(&self) -> f64 {
        Pile::least_size(self)
    }

    fn widest_joint(&self) -> f64 {
        0.0
    }

    fn pushing_pairs(&self) -> Vec<[usize; 2]> {
        self.pushing().collect()
    }

    fn are_within(&mut self, model: &Model, _t: f64, state: &State) -> bool {
        Pile::are_within(self, model, state)
    }

    fn move_apart(&mut self, model: &Model, state: &mut State) {
        self.separate(model, state);
    }
}

/// The general solver in one substep.
pub(super) struct Jointed<'a> {
    solver: &'a mut Solver,
    /// The rates that the rows aim at, at the end of the substep or in its middle.
    goals: Vec<f64>,
    /// The rates of the rows after the impacts.
    rates: Vec<f64>,
    /// The largest error of the joints at the middle of the substep, m.
    open: f64,
}

impl<'a> Jointed<'a> {
    pub(super) fn of(solver: &'a mut Solver) -> Jointed<'a> {
        Jointed { solver, goals: Vec::new(), rates: Vec::new(), open: 0.0 }
    }

    /// Takes contacts and holds the joints, to separate bodies.
    pub(super) fn take_contacts(
        &mut self,
        contacts: Vec<LastingContact>,
        model: &Model,
        t: f64,
        state: &mut State,
    ) {
        self.solver.find_by_sweeps();
        self.solver.take_contacts(contacts.into_iter().map(Arc::new).collect());
        self.solver.forget();
        self.solver.hold_joints(model, t, state);
    }
}

impl Impulses for Jointed<'_> {
    fn begin(
        &mut self,
        contacts: Vec<LastingContact>,
        model: &Model,
        (t, part): (f64, f64),
        state: &mut State,
    ) {
        self.solver.find_by_sweeps();
        self.solver.take_contacts(contacts.into_iter().map(Arc::new).collect());
        self.solver.forget();
        self.solver.prepare_sweeps(model, t, state);
        self.goals = self.solver.gaps(PUSHING_CONTACT_TOLERANCE).iter().map(|gap| -gap / part).collect();
    }

    fn strike(&mut self, model: &Model, span: (f64, f64), state: &mut State, loads: &Loads) -> Struck {
        let struck = self.solver.strike_all(model, span, &mut self.goals, (state, loads));
        self.rates = self.solver.rates_now();
        struck
    }

    fn join(&mut self, model: &Model, t: f64, state: &mut State) {
        self.solver.hold_joints(model, t, state);
        self.solver.settle_places(t, state);
    }

    fn measure(&mut self, model: &Model, t: f64, state: &mut State) {
        self.solver.prepare_sweeps(model, t, state);
        self.open = self.solver.widest_joint();
        self.goals = self.solver.middle(&self.goals, &self.rates);
    }

    fn push(&mut self, model: &Model, half: f64, state: &mut State) {
        self.solver.push_all(model, &self.goals, Purpose::Forces(half), state);
    }

    fn hardest_contact(&self) -> Option<([usize; 2], f64)> {
        self.solver.hardest_contact()
    }

    fn least_size(&self) -> f64 {
        self.solver.least_size()
    }

    fn widest_joint(&self) -> f64 {
        self.open
    }

    fn pushing_pairs(&self) -> Vec<[usize; 2]> {
        self.solver.pushing_pairs()
    }

    fn are_within(&mut self, _model: &Model, t: f64, state: &State) -> bool {
        self.solver.are_within(t, state)
    }

    fn move_apart(&mut self, _model: &Model, state: &mut State) {
        self.solver.separate(state);
    }
}
