//! Events: the distance of a state from the next change of a row's mode.

use super::super::{Loads, Model, State};
use super::Law;
use super::friction::Grip;
use super::jacobian;
use super::modes::Mode;
use super::solver::Solver;

/// An event needs more than this: an open stop that is passed by this fraction of its scale, or a speed of this fraction of the rates.
pub(super) const PASSED: f64 = 1e-12;

/// The tolerance for multipliers of the wrong sign, as a fraction of the accelerations. It exceeds the tolerance of [`Solver::decide`],
/// so that each event changes something.
const PULLED: f64 = 1e-9;

impl Solver {
    /// Whether rows can change their modes.
    pub(in crate::dynamics) fn has_events(&self) -> bool {
        self.has_modes
    }

    /// The distance of a state from the next event, in units of the tolerance, and the row of that event. It is 1 if a stop is just
    /// touched, and negative after the event. `loads` is working memory.
    pub(in crate::dynamics) fn margin(
        &mut self,
        model: &Model,
        t: f64,
        state: &State,
        loads: &mut Loads,
    ) -> (f64, usize) {
        self.is_ready = false;
        self.measure(t, state);
        let n = self.rows.len();
        let mut rates = vec![0.0; n];
        let size = match &self.structure {
            Some(structure) => {
                jacobian::rates(structure, &self.jacobian, &self.members, &self.rows, &mut rates)
            }
            None => return (f64::INFINITY, 0),
        };
        self.seen = [size, 0.0];
        let pulls = |(mode, law): (&Mode, &Law)| *mode == Mode::Held && *law != Law::Tie;
        if self.modes.iter().zip(&self.laws).any(pulls) {
            self.factorise(false);
            self.is_ready = true;
            model.sum(t, state, loads);
            let mut accelerations = vec![0.0; n];
            let size = self.react_seeing(t, state, loads, &mut accelerations);
            self.seen[1] = size;
        }
        let (size, force) =
            (self.largest_rate.max(self.seen[0]), self.largest_acceleration.max(self.seen[1]));
        let part = |value: f64, of: f64, tolerated: f64| {
            if of > 0.0 { value / of / tolerated + 1.0 } else { 1.0 }
        };
        let margin = |i: usize| match (self.modes[i], self.laws[i]) {
            (Mode::Open, Law::Stop) => part(self.rows[i].violation, self.rows[i].scale, PASSED),
            (Mode::Pushed(sign), _) => part(-sign * rates[i], size, PASSED),
            (Mode::Held, Law::Stop) => part(self.unknown[i] * self.weight(i), force, PULLED),
            (Mode::Held, Law::Drive { limit }) => {
                part((limit - self.unknown[i].abs()) * self.weight(i), force, PULLED)
            }
            _ => f64::INFINITY,
        };
        let of_grip = |grip: &Grip| match self.modes[grip.row] {
            Mode::Held if grip.is_restless => f64::INFINITY,
            Mode::Held => {
                let left = grip.coefficient * self.unknown[grip.normal] - grip.of(&self.unknown).length();
                part(left * self.weight(grip.row), force, PULLED)
            }
            Mode::Slid => part(grip.of(&rates).dot(grip.heading), size, PASSED),
            Mode::Open | Mode::Pushed(_) => f64::INFINITY,
        };
        let grips = self.grips.iter().map(|grip| (of_grip(grip), grip.row));
        let rows = (0..n).map(|i| (margin(i), i));
        rows.chain(grips).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0))
    }

    /// Must be called if the state of the last [`margin`](Self::margin) ends a piece. Only these states determine the typical size of
    /// rates and accelerations: a trial step that is too long can give far larger values.
    pub(in crate::dynamics) fn accept(&mut self) {
        let [rate, acceleration] = std::mem::take(&mut self.seen);
        self.largest_rate = self.largest_rate.max(rate);
        self.largest_acceleration = self.largest_acceleration.max(acceleration);
    }

    /// The typical change of rates by forces within a time, s.
    pub(in crate::dynamics) fn usual_change(&self, time: f64) -> f64 {
        let change = self.largest_acceleration * time;
        if change.is_finite() { change } else { 0.0 }
    }

    /// The bodies of the constraint to which a row belongs.
    pub(in crate::dynamics) fn bodies_of(&self, row: usize) -> Vec<usize> {
        let Some(structure) = &self.structure else { return Vec::new() };
        let place = structure.place_of_row(row);
        place
            .map_or(Vec::new(), |place| place.bodies.iter().map(|&member| structure.bodies[member]).collect())
    }

    /// Whether no friction forces were found in the last step.
    pub(in crate::dynamics) fn is_unsolved(&self) -> bool {
        self.is_unsolved
    }

    /// The bodies of a contact for which no mode was right in the last decision.
    pub(in crate::dynamics) fn take_undecided(&mut self, model: &Model) -> Option<Vec<usize>> {
        let row = self.undecided.take()?;
        let joints = model.constraints().len();
        let place = self.structure.as_ref()?.place_of_row(row)?;
        (place.constraint >= joints).then(|| self.bodies_of(row))
    }

    /// Reports that the run cannot continue, because a row changes its mode again and again.
    pub(in crate::dynamics) fn give_up(&mut self, model: &Model, row: usize, time: f64) {
        let Some(structure) = &self.structure else { return };
        let place = structure.place_of_row(row);
        let missing = self.rows.get(row).map_or(0.0, |row| row.violation.abs());
        if let (None, Some(place)) = (self.failure, place) {
            self.failure = Some(self.broken(model, place.constraint, time, missing));
        }
    }
}
