//! What finds the impulses of a substep: a pile for bodies that have nothing to do with joints, and the general solver for all others.

use std::sync::Arc;

use super::super::super::constraint::{Pile, Purpose, Solver, Struck};
use super::super::super::sets::Sets;
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
        self.foresee((part, PUSHING_CONTACT_TOLERANCE), model, state);
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

/// A pile, and beside it mechanisms with all that touches them.
pub(super) struct Mixed<'a> {
    pile: &'a mut Pile,
    jointed: Jointed<'a>,
}

impl<'a> Mixed<'a> {
    pub(super) fn of(pile: &'a mut Pile, solver: &'a mut Solver) -> Mixed<'a> {
        Mixed { pile, jointed: Jointed::of(solver) }
    }
}

/// Splits contacts into those of islands that no joint belongs to, and all others.
pub(super) fn without_joints(
    contacts: Vec<LastingContact>,
    model: &Model,
) -> (Vec<LastingContact>, Vec<LastingContact>) {
    let moves = |body: usize| model.inverse_mass()[body] != 0.0;
    let mut islands = Sets::new(model.len());
    for [a, b] in contacts.iter().map(|contact| contact.bodies) {
        if moves(a) && moves(b) {
            islands.unite(a, b);
        }
    }
    let mut has_joint = vec![false; model.len()];
    for body in model.constraints().iter().flat_map(|joint| joint.bodies()) {
        has_joint[islands.first(body.index())] = true;
    }
    contacts.into_iter().partition(|contact| {
        let [a, b] = contact.bodies;
        !has_joint[islands.first(if moves(a) { a } else { b })]
    })
}

impl Impulses for Mixed<'_> {
    fn begin(&mut self, contacts: Vec<LastingContact>, model: &Model, span: (f64, f64), state: &mut State) {
        let (free, jointed) = without_joints(contacts, model);
        self.pile.begin(free, model, span, state);
        self.jointed.begin(jointed, model, span, state);
    }

    fn strike(&mut self, model: &Model, span: (f64, f64), state: &mut State, loads: &Loads) -> Struck {
        let mut struck = self.pile.strike(model, span, state, loads);
        let of_joints = self.jointed.strike(model, span, state, loads);
        struck.impacts.extend(of_joints.impacts);
        struck.impacts.sort_by(|a, b| a.time.total_cmp(&b.time));
        struck.early.extend(of_joints.early);
        struck.fallen += of_joints.fallen;
        struck
    }

    fn join(&mut self, model: &Model, t: f64, state: &mut State) {
        self.jointed.join(model, t, state);
    }

    fn measure(&mut self, model: &Model, t: f64, state: &mut State) {
        self.pile.measure(model, state);
        self.jointed.measure(model, t, state);
    }

    fn push(&mut self, model: &Model, half: f64, state: &mut State) {
        self.pile.push(model, half, state);
        self.jointed.push(model, half, state);
    }

    fn hardest_contact(&self) -> Option<([usize; 2], f64)> {
        let all = [Pile::hardest_contact(self.pile), self.jointed.hardest_contact()];
        let sum = all.iter().flatten().map(|(_, sum)| sum).sum();
        let hardest = all.into_iter().flatten().max_by(|(_, a), (_, b)| a.total_cmp(b));
        hardest.map(|(bodies, _)| (bodies, sum))
    }

    fn least_size(&self) -> f64 {
        Pile::least_size(self.pile).min(self.jointed.least_size())
    }

    fn widest_joint(&self) -> f64 {
        self.jointed.widest_joint()
    }

    fn pushing_pairs(&self) -> Vec<[usize; 2]> {
        let mut pairs = self.jointed.pushing_pairs();
        pairs.extend(self.pile.pushing());
        pairs
    }

    fn are_within(&mut self, model: &Model, t: f64, state: &State) -> bool {
        let in_pile = self.pile.are_within(model, state);
        self.jointed.are_within(model, t, state) || in_pile
    }

    fn move_apart(&mut self, model: &Model, state: &mut State) {
        self.pile.move_apart(model, state);
        self.jointed.move_apart(model, state);
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
        self.solver.take_contacts_for_sweeps(contacts.into_iter().map(Arc::new).collect(), model);
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
        self.solver.take_contacts_for_sweeps(contacts.into_iter().map(Arc::new).collect(), model);
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
