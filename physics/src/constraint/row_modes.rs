//! The modes of constraint rows that are not always active: a row holds, is open, slides, or pushes with its limit.
//!
//! A stop (c ≥ 0) with c = 0 and c' = 0 either holds with λ ≥ 0, or opens with c'' ≥ 0. A motor either keeps its speed with |λ| ≤ its
//! limit, or pushes with its limit. Both cases lead to linear complementarity problems: first for velocities at an impact, then for
//! accelerations. They are solved by changing the mode of one row at a time. Sources: F. Pfeiffer & C. Glocker, *Multibody Dynamics with
//! Unilateral Contacts* (1996), chapters 5 and 8; K. G. Murty, Opsearch 11 (1974) 115, for the order of the changes.

use super::super::{Loads, Model, State};
use super::events::VIOLATION_TOLERANCE;
use super::jacobian;
use super::member::Member;
use super::solver::Solver;
use super::{Law, Row};

/// The mode of a constraint row: whether the row is active, and how it exerts force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mode {
    /// The constraint row is active: it keeps c = 0, or c' = 0 for a motor or sticking friction.
    Held,
    /// The constraint row is inactive: it exerts no force.
    Open,
    /// The motor of this constraint row pushes with its limit. The value is the sign of its multiplier, ±1. In snapshots of Moreau's scheme,
    /// it is the part of the limit with which the motor pushed, and for a stop (an inequality) its multiplier.
    Pushed(f64),
    /// The friction row slides: friction has its full size and opposes the slip.
    Slid,
}

/// A stop (c ≥ 0) counts as touched if c is at most this fraction of its size.
pub(super) const STOP_TOLERANCE: f64 = 1e-9;

/// The largest number of sliding contacts that one decision of modes can make stick at once.
const MAX_STICKING_PER_DECISION: usize = 4;

/// The largest number of times that one decision of modes shares the contact forces anew.
const MAX_SHARES: usize = 8;

/// A sum counts as a rounding error if it is below this fraction of its largest term.
pub(super) const RELATIVE_ROUNDING: f64 = 1e-10;

/// A motor that reaches its speed within this fraction of a step gets the speed by an impulse.
const MOTOR_INSTANT: f64 = 1e-8;

impl Mode {
    /// Returns the initial mode of a constraint row with this law.
    pub(super) fn first(law: &Law) -> Mode {
        match law {
            Law::Equality => Mode::Held,
            Law::Inequality | Law::SpeedMotor { .. } | Law::Friction { .. } => Mode::Open,
        }
    }

    /// Returns the multiplier of a constraint row if its mode gives it.
    pub(super) fn given(self, law: Law) -> Option<f64> {
        match (law, self) {
            (Law::SpeedMotor { limit }, Mode::Pushed(sign)) => Some(sign * limit),
            (Law::Inequality, Mode::Pushed(force)) => Some(force),
            _ => None,
        }
    }

    /// Returns the error of an equation in this mode: the amount by which the law is violated.
    pub(super) fn missing(self, law: Law, row: &Row) -> f64 {
        match (law, self) {
            // Friction is an equation for velocities, so its row has no error of position.
            (Law::Friction { .. }, _) => 0.0,
            (_, Mode::Held) => row.violation.abs(),
            (Law::Inequality, _) => (-row.violation).max(0.0),
            (Law::Equality | Law::SpeedMotor { .. }, _) => 0.0,
        }
    }
}

impl Solver {
    /// Moves bodies to satisfy the constraints after a change from outside at time `t`, and decides the mode of each row.
    pub(crate) fn start(&mut self, model: &Model, t: f64, state: &mut State, loads: &mut Loads) {
        self.begin(model, t, state);
        if !self.has_modes {
            self.settle(model, t, state);
            return;
        }
        // A violated stop (inequality c ≥ 0) is held while positions and velocities are corrected.
        for ((mode, law), row) in self.modes.iter_mut().zip(&self.laws).zip(&self.rows) {
            if *law == Law::Inequality && row.violation < 0.0 {
                *mode = Mode::Held;
            }
        }
        self.hold();
        self.settle(model, t, state);
        for (mode, law) in self.modes.iter_mut().zip(&self.laws) {
            *mode = Mode::first(law);
        }
        self.decide(model, t, state, loads);
    }

    /// Decides the mode of each constraint row from now on. Applies the impulses of stops (inequalities c ≥ 0) that are hit, and finds
    /// from the accelerations which rows stay active. `loads` is working memory.
    pub(crate) fn decide(&mut self, model: &Model, t: f64, state: &mut State, loads: &mut Loads) {
        self.is_ready = false;
        self.plan(model);
        self.measure(t, state);
        let touched: Vec<bool> = self
            .laws
            .iter()
            .zip(&self.rows)
            .map(|(law, row)| *law == Law::Inequality && row.violation <= row.tolerance(STOP_TOLERANCE))
            .collect();
        let size = self.hit(model, state, &touched);
        // The impulses have changed the velocities.
        self.measure(t, state);
        let mut rates = vec![0.0; self.rows.len()];
        if let Some(structure) = &self.structure {
            jacobian::rates(structure, &self.jacobian, &self.members, &self.rows, &mut rates);
        }
        let mut members = self.members.clone();
        self.hold();
        self.see_accelerations(model, t, state, loads, &members);
        let mut can_hold = vec![false; self.rows.len()];
        let stills = self.stills(model);
        for i in 0..self.rows.len() {
            // A body that passes a stop (inequality c ≥ 0) by the tolerated depth c reaches a rate of √(2 c'' c). This rate counts as
            // zero. Otherwise two active stops would be hit in turn endlessly.
            let unit = self.unit(i);
            let fallen = 8.0 * self.rows[i].tolerance(VIOLATION_TOLERANCE) * self.largest_acceleration * unit;
            let is_still = rates[i].abs() <= (STOP_TOLERANCE * size * unit).max(fallen.sqrt()).max(stills[i]);
            (self.modes[i], can_hold[i]) = match self.laws[i] {
                Law::Equality => (Mode::Held, false),
                Law::Inequality if touched[i] && is_still => (Mode::Held, true),
                Law::Inequality => (Mode::Open, false),
                Law::SpeedMotor { .. } if is_still => (Mode::Held, true),
                Law::SpeedMotor { .. } => (Mode::Pushed(-rates[i].signum()), false),
                // The mode of the normal row decides first.
                Law::Friction { .. } => (Mode::Open, false),
            };
        }
        self.members.copy_from_slice(&members);
        if self.start_motors(model, state, &touched, &rates, &mut can_hold) {
            self.measure(t, state);
            members.copy_from_slice(&self.members);
            if let Some(structure) = &self.structure {
                jacobian::rates(structure, &self.jacobian, &self.members, &self.rows, &mut rates);
            }
        }
        let modes = self.modes.clone();
        self.undecided = None;
        for _ in 0..=MAX_STICKING_PER_DECISION {
            for grip in 0..self.grips.len() {
                self.take_grip(grip, &rates);
            }
            if self.still_moves(&rates) {
                self.members.copy_from_slice(&members);
                self.hold();
                self.halt(model, state, &rates);
                self.measure(t, state);
                members.copy_from_slice(&self.members);
                if let Some(structure) = &self.structure {
                    jacobian::rates(structure, &self.jacobian, &self.members, &self.rows, &mut rates);
                }
            }
            let Some(wrong) = self.go_on(model, t, state, loads, (&members, &can_hold, &rates)) else {
                self.undecided = None;
                break;
            };
            self.undecided = Some(wrong);
            if !self.catch(wrong) {
                break;
            }
            self.modes.clone_from(&modes);
        }
        self.grips.iter_mut().for_each(|grip| grip.is_caught = false);
        self.see_strength();
    }

    /// Computes c'' of each constraint row in the present modes. `members` are the bodies with their velocities; the velocities in
    /// `self.members` are overwritten by accelerations.
    fn see_accelerations(
        &mut self,
        model: &Model,
        t: f64,
        state: &State,
        loads: &mut Loads,
        members: &[Member],
    ) -> Vec<f64> {
        let mut accelerations = vec![0.0; self.rows.len()];
        self.members.copy_from_slice(members);
        model.sum(t, state, loads);
        self.note_loads(model, loads);
        let size = self.react_seeing(t, state, loads, &mut accelerations);
        self.largest_acceleration = self.largest_acceleration.max(size);
        accelerations
    }

    /// Applies the impulses of stops (inequalities c ≥ 0) that are hit. The impulses only push, and afterwards no body moves further into
    /// a stop. Returns the largest magnitude of the rates so far.
    fn hit(&mut self, model: &Model, state: &mut State, touched: &[bool]) -> f64 {
        let n = self.rows.len();
        let (mut before, mut after) = (vec![0.0; n], vec![0.0; n]);
        for (i, mode) in self.modes.iter_mut().enumerate() {
            *mode = Mode::first(&self.laws[i]);
        }
        let Some(structure) = &self.structure else { return 0.0 };
        jacobian::rates(structure, &self.jacobian, &self.members, &self.rows, &mut before);
        let size =
            jacobian::magnitude((structure, &self.jacobian, &self.members), &self.rows, &self.grips, |row| {
                row.rate
            });
        self.largest_rate = self.largest_rate.max(size);
        let size = self.largest_rate;
        let slight = RELATIVE_ROUNDING * size;
        let units: Vec<f64> = (0..n).map(|i| self.unit(i)).collect();
        let is_hit = |i: usize, rate: f64| touched[i] && rate < -slight * units[i];
        if !(0..n).any(|i| is_hit(i, before[i])) {
            return size;
        }
        for i in (0..n).filter(|&i| is_hit(i, before[i])) {
            self.modes[i] = Mode::Held;
        }
        let members = self.members.clone();
        for round in 0..rounds(n) {
            self.hold();
            for (value, rate) in self.unknown.iter_mut().zip(&before) {
                *value = -rate;
            }
            self.solve();
            let Solver { structure: Some(structure), members: moved, jacobian, unknown, .. } = self else {
                return size;
            };
            moved.clone_from(&members);
            jacobian::move_members(structure, jacobian, unknown, moved);
            jacobian::rates(structure, jacobian, moved, &self.rows, &mut after);
            let wrong = |i: usize| match self.modes[i] {
                Mode::Held if touched[i] => -self.unknown[i] * self.weight(i),
                Mode::Open if touched[i] => -after[i],
                _ => 0.0,
            };
            match worst(n, round, slight, |i| wrong(i) / units[i]) {
                None => break,
                Some(i) if self.modes[i] == Mode::Held => self.modes[i] = Mode::Open,
                Some(i) => self.modes[i] = Mode::Held,
            }
        }
        let Solver { structure: Some(structure), jacobian, unknown, rows, .. } = self else { return size };
        jacobian::push(structure, jacobian, unknown, model, state);
        jacobian::book(rows.iter().map(|row| row.rate), unknown, state);
        // The impulses do the work ½ Λ (c' before + c' after), which includes the work of motors and of the guides of given motions.
        let mut taken = 0.0;
        let mut at_contacts = 0.0;
        for i in 0..n {
            let work = 0.5 * unknown[i] * (before[i] + after[i]);
            *if self.factor.is_row_soft(i) { &mut at_contacts } else { &mut taken } += work;
        }
        state.accounts.limits += taken;
        state.accounts.impacts += at_contacts;
        size
    }

    /// Gives motors their speed by an impulse if their limit reaches it within an instant: the time until then would be too short for
    /// events. Books the work of the impulse, and returns true if there is one. A motor that would push a body into a stop gets none.
    fn start_motors(
        &mut self,
        model: &Model,
        state: &mut State,
        touched: &[bool],
        rates: &[f64],
        can_hold: &mut [bool],
    ) -> bool {
        let n = self.rows.len();
        let mut fast: Vec<bool> = self.modes.iter().map(|mode| matches!(mode, Mode::Pushed(_))).collect();
        if !fast.contains(&true) {
            return false;
        }
        let decided = self.modes.clone();
        let is_motor = |law: &Law| matches!(law, Law::SpeedMotor { .. });
        // Each round takes out the motors that are too weak.
        let mut are_found = false;
        while !are_found && fast.contains(&true) {
            for i in 0..n {
                let is_active = self.laws[i] == Law::Equality
                    || is_motor(&self.laws[i]) && (fast[i] || decided[i] == Mode::Held);
                self.modes[i] = if is_active { Mode::Held } else { Mode::Open };
            }
            self.hold();
            for (value, rate) in self.unknown.iter_mut().zip(rates) {
                *value = -rate;
            }
            self.solve();
            are_found = true;
            for (i, fast) in fast.iter_mut().enumerate() {
                let Law::SpeedMotor { limit } = self.laws[i] else { continue };
                if *fast && self.unknown[i].abs() > limit * MOTOR_INSTANT * self.step {
                    (*fast, are_found) = (false, false);
                }
            }
        }
        self.modes = decided;
        if !are_found {
            return false;
        }
        let slight: Vec<f64> = (0..n).map(|i| RELATIVE_ROUNDING * self.largest_rate * self.unit(i)).collect();
        let Solver { structure: Some(structure), jacobian, unknown, rows, laws, members, .. } = self else {
            return false;
        };
        let mut moved = members.clone();
        let mut after = vec![0.0; n];
        jacobian::move_members(structure, jacobian, unknown, &mut moved);
        jacobian::rates(structure, jacobian, &moved, rows, &mut after);
        if (0..n).any(|i| touched[i] && after[i] < rates[i].min(0.0) - slight[i]) {
            return false;
        }
        jacobian::push(structure, jacobian, unknown, model, state);
        jacobian::book(rows.iter().map(|row| row.rate), unknown, state);
        state.accounts.motors += (0..n)
            .filter(|&i| is_motor(&laws[i]))
            .map(|i| 0.5 * unknown[i] * (rates[i] + after[i]))
            .sum::<f64>();
        for i in (0..n).filter(|&i| fast[i]) {
            (self.modes[i], can_hold[i]) = (Mode::Held, true);
        }
        true
    }

    /// Stops the motion along the active constraint rows by impulses, and books the work of these impulses.
    fn halt(&mut self, model: &Model, state: &mut State, rates: &[f64]) {
        for (value, rate) in self.unknown.iter_mut().zip(rates) {
            *value = -rate;
        }
        self.solve();
        let Solver { structure: Some(structure), jacobian, unknown, rows, .. } = self else { return };
        jacobian::push(structure, jacobian, unknown, model, state);
        jacobian::book(rows.iter().map(|row| row.rate), unknown, state);
        let work = unknown.iter().zip(rates).map(|(impulse, rate)| 0.5 * impulse * rate).sum::<f64>();
        state.accounts.impacts += work;
    }

    /// Decides from the accelerations which constraint rows stay active. Returns `None` on success, otherwise a row for which no mode was
    /// consistent.
    fn go_on(
        &mut self,
        model: &Model,
        t: f64,
        state: &State,
        loads: &mut Loads,
        (members, can_hold, rates): (&[Member], &[bool], &[f64]),
    ) -> Option<usize> {
        let mut last = None;
        let n = self.rows.len();
        let is_free = can_hold.iter().all(|can| !can);
        if !self.grips.is_empty() {
            self.factor.weigh([]);
            self.hold();
            self.see_accelerations(model, t, state, loads, members);
            self.share_load();
            self.see_stiffness();
        }
        let mut held_before = Vec::new();
        let mut shares = 0;
        for round in 0..rounds(n) {
            // If only the directions of friction have changed, the factorization is still valid.
            if held_before != self.modes {
                self.hold();
                held_before.clone_from(&self.modes);
            }
            if is_free {
                return None;
            }
            let accelerations = self.see_accelerations(model, t, state, loads, members);
            let size = self.largest_acceleration;
            let wrong = |i: usize| match (self.modes[i], self.laws[i]) {
                (_, Law::Friction { .. }) => 0.0,
                _ if !can_hold[i] => 0.0,
                (Mode::Held, Law::Inequality) => -self.unknown[i] * self.weight(i),
                (Mode::Held, Law::SpeedMotor { limit }) => (self.unknown[i].abs() - limit) * self.weight(i),
                (Mode::Open, _) => -accelerations[i],
                (Mode::Pushed(sign), _) => sign * accelerations[i],
                (Mode::Held, Law::Equality) | (Mode::Slid, _) => 0.0,
            };
            last = worst(n, round, RELATIVE_ROUNDING * size, |i| wrong(i) / self.unit(i));
            match last {
                None => {
                    let strained = self.strained(&accelerations, RELATIVE_ROUNDING * size);
                    if strained.is_none() || shares == MAX_SHARES {
                        return strained;
                    }
                    shares += 1;
                    let slides = strained.is_some_and(|row| self.modes[row] == Mode::Slid);
                    let Some(shared) = self.share_forces(t, state, loads, |row| can_hold[row]) else {
                        return strained;
                    };
                    self.grip_as_shared(&shared, can_hold);
                    // The forces hold together what sticks. What slides must agree with the forces of its mode.
                    if self.modes == held_before && !slides {
                        return None;
                    }
                }
                Some(i) => {
                    self.modes[i] = match (self.modes[i], self.laws[i]) {
                        (Mode::Held, Law::SpeedMotor { .. }) => Mode::Pushed(self.unknown[i].signum()),
                        (Mode::Held, _) => Mode::Open,
                        _ => Mode::Held,
                    };
                    for grip in 0..self.grips.len() {
                        if self.grips[grip].normal == i {
                            self.take_grip(grip, rates);
                        }
                    }
                }
            }
        }
        last
    }
}

/// Returns the largest number of rounds of mode changes in a problem of `n` constraint rows.
fn rounds(n: usize) -> usize {
    100 + 4 * n
}

/// Returns the constraint row with the largest error above the tolerance `slight`, or `None`. After many rounds, it returns the first row
/// with such an error, which breaks cycles.
fn worst(n: usize, round: usize, slight: f64, wrong: impl Fn(usize) -> f64) -> Option<usize> {
    let all = (0..n).map(|i| (i, wrong(i))).filter(|(_, wrong)| *wrong > slight);
    if round > 50 + 2 * n {
        return all.map(|(i, _)| i).next();
    }
    all.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
}
