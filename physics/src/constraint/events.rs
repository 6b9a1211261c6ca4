//! Event detection: how far a state is from the next change of a constraint row's mode, such as a rope that becomes taut.

use super::super::{Loads, Model, State};
use super::Law;
use super::cone::LEAST_SLIP;
use super::friction::FrictionPair;
use super::jacobian;
use super::row_modes::{Mode, STOP_TOLERANCE};
use super::solver::Solver;

/// An inequality c ≥ 0 counts as violated if c falls below 0 by this fraction of its size. A constraint counts as moving if its rate c'
/// exceeds this fraction of the largest rate of all constraints.
pub(super) const VIOLATION_TOLERANCE: f64 = 1e-12;

/// The tolerance for multipliers of the wrong sign, as a fraction of the largest acceleration. It exceeds the tolerance of
/// [`Solver::decide`], so every event changes at least one mode.
const MULTIPLIER_TOLERANCE: f64 = 1e-9;

impl Solver {
    /// Returns true if any constraint row can change its mode.
    pub(crate) fn has_events(&self) -> bool {
        self.has_modes
    }

    /// Returns the distance of a state from the next event, in units of the event's tolerance, and the constraint row that causes this
    /// event. For an open inequality c ≥ 0, the distance is 1 at c = 0. It is negative once an event has happened. `loads` is working
    /// memory.
    pub(crate) fn margin(&mut self, model: &Model, t: f64, state: &State, loads: &mut Loads) -> (f64, usize) {
        (self.is_ready, self.is_implausible) = (false, false);
        self.measure(t, state);
        let n = self.rows.len();
        let mut rates = vec![0.0; n];
        let Some(structure) = &self.structure else { return (f64::INFINITY, 0) };
        jacobian::rates(structure, &self.jacobian, &self.members, &self.rows, &mut rates);
        let size =
            jacobian::magnitude((structure, &self.jacobian, &self.members), &self.rows, &self.grips, |row| {
                row.rate
            });
        self.seen = [size, 0.0];
        let pulls = |(mode, law): (&Mode, &Law)| *mode == Mode::Held && *law != Law::Equality;
        let mut slips = None;
        self.strained.clear();
        if self.modes.iter().zip(&self.laws).any(pulls) {
            self.factorise(false);
            self.is_ready = true;
            model.sum(t, state, loads);
            let mut accelerations = vec![0.0; n];
            let size = self.react_seeing(t, state, loads, &mut accelerations);
            self.seen[1] = size;
            let strained =
                self.strained(&accelerations, MULTIPLIER_TOLERANCE * self.largest_acceleration.max(size));
            if let Some(row) = strained {
                self.strained = self.bodies_of(row);
                let forces = self.unknown.clone();
                let modes = self.modes.clone();
                slips = self.share_forces(t, state, loads, |row| modes[row] == Mode::Held);
                self.unknown = forces;
            }
        }
        let (size, force) =
            (self.largest_rate.max(self.seen[0]), self.largest_acceleration.max(self.seen[1]));
        let part = |value: f64, of: f64, tolerated: f64| {
            if of > 0.0 { value / of / tolerated + 1.0 } else { 1.0 }
        };
        let margin = |i: usize| match (self.modes[i], self.laws[i]) {
            (Mode::Open, Law::Inequality) => {
                let margin = part(self.rows[i].violation, self.rows[i].tolerance(VIOLATION_TOLERANCE), 1.0);
                // A stop that was touched at the start of the step and opens is passed at first: by as much as its event tolerates, and by
                // the error of the integration method. A rate that an event takes for rest must not be an event itself.
                let opens = rates[i] >= -STOP_TOLERANCE * size * self.unit(i)
                    && self.touched.get(i).is_some_and(|touched| *touched);
                if opens { margin.max(0.0) } else { margin }
            }
            (Mode::Pushed(sign), _) => part(-sign * rates[i], size * self.unit(i), VIOLATION_TOLERANCE),
            (Mode::Held, Law::Inequality) => {
                part(self.unknown[i] * self.weight(i), force * self.unit(i), MULTIPLIER_TOLERANCE)
            }
            (Mode::Held, Law::SpeedMotor { limit }) => part(
                (limit - self.unknown[i].abs()) * self.weight(i),
                force * self.unit(i),
                MULTIPLIER_TOLERANCE,
            ),
            _ => f64::INFINITY,
        };
        let of_grip = |grip: &FrictionPair| match self.modes[grip.row] {
            Mode::Held => match &slips {
                // Other forces may hold the contact: it slips only if none do.
                Some(slips) => {
                    let unit = self.unit(grip.row);
                    part(-grip.of(slips).length(), force * unit, 2.0 * LEAST_SLIP)
                }
                None => part(-self.excess(grip), force * self.unit(grip.row), MULTIPLIER_TOLERANCE),
            },
            Mode::Slid => {
                part(grip.of(&rates).dot(grip.heading), size * self.unit(grip.row), VIOLATION_TOLERANCE)
            }
            Mode::Open | Mode::Pushed(_) => f64::INFINITY,
        };
        let grips = self.grips.iter().map(|grip| (of_grip(grip), grip.row));
        let rows = (0..n).map(|i| (margin(i), i));
        rows.chain(grips).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0))
    }

    /// Returns the bodies of a contact whose force lay outside its cone of friction at the end of the last piece of a step, and forgets
    /// them. Empty if there was none.
    pub(crate) fn take_strained(&mut self) -> Vec<usize> {
        std::mem::take(&mut self.strained)
    }

    /// Records the typical size of rates and accelerations. Must be called if a piece of a step ends at the state of the last
    /// [`margin`](Self::margin). Other states do not count, because a trial step that is too long can give far larger values.
    pub(crate) fn accept(&mut self) {
        let [rate, acceleration] = std::mem::take(&mut self.seen);
        self.largest_rate = self.largest_rate.max(rate);
        self.largest_acceleration = self.largest_acceleration.max(acceleration);
    }

    /// Records the speeds that the loads alone, without constraint forces, would give to touching bodies in a step. Bodies that start from rest
    /// have no other speed to which rounding errors of their rates can be compared.
    pub(super) fn note_loads(&mut self, model: &Model, loads: &Loads) {
        for &body in self.contacts.iter().flat_map(|contact| &contact.bodies) {
            let speed = self.step * model.inverse_mass()[body] * loads.force[body].length();
            self.speed_by_loads = self.speed_by_loads.max(if speed.is_finite() { speed } else { 0.0 });
        }
        self.largest_rate = self.largest_rate.max(self.speed_by_loads);
    }

    /// Returns the largest change of speed of a touching body by its loads in one step, of all steps so far, m/s.
    pub(crate) fn speed_by_loads(&self) -> f64 {
        self.speed_by_loads
    }

    /// Records the largest acceleration that loads give to a body, m/s².
    pub(crate) fn note_acceleration(&mut self, acceleration: f64) {
        if acceleration.is_finite() {
            self.largest_acceleration = self.largest_acceleration.max(acceleration);
        }
    }

    /// Returns the typical change of a constraint row's rate c' by forces within `time` seconds, m/s.
    pub(crate) fn usual_change(&self, time: f64) -> f64 {
        let change = self.largest_acceleration * time;
        if change.is_finite() { change } else { 0.0 }
    }

    /// Returns the indices of the bodies that the constraint of a row connects.
    pub(crate) fn bodies_of(&self, row: usize) -> Vec<usize> {
        let Some(structure) = &self.structure else { return Vec::new() };
        let place = structure.place_of_row(row);
        place
            .map_or(Vec::new(), |place| place.bodies.iter().map(|&member| structure.bodies[member]).collect())
    }

    /// Returns the two bodies of the contact to which a constraint row belongs, by index; `None` for a row of a joint.
    pub(crate) fn contact_of(&self, model: &Model, row: usize) -> Option<[usize; 2]> {
        let place = self.structure.as_ref()?.place_of_row(row)?;
        let contact = place.constraint.checked_sub(model.constraints().len())?;
        Some(self.contacts[contact].bodies)
    }

    /// Returns true if the equations of sliding friction had no solution in the last step, or if the contacts at the state of the last
    /// [`margin`](Self::margin) would need accelerations that nothing causes.
    pub(crate) fn is_unsolved(&self) -> bool {
        self.is_unsolved || self.is_implausible
    }

    /// Returns the two bodies of the contact for which the last decision found no consistent mode, and forgets it. `None` if there is no
    /// such contact.
    pub(crate) fn take_undecided(&mut self, model: &Model) -> Option<Vec<usize>> {
        let row = self.undecided.take()?;
        let joints = model.constraints().len();
        let place = self.structure.as_ref()?.place_of_row(row)?;
        (place.constraint >= joints).then(|| self.bodies_of(row))
    }

    /// Reports that the run cannot continue, because a constraint row changes its mode endlessly.
    pub(crate) fn give_up(&mut self, model: &Model, row: usize, time: f64) {
        let Some(structure) = &self.structure else { return };
        let place = structure.place_of_row(row);
        let missing = self.rows.get(row).map_or(0.0, |row| row.violation.abs());
        if let (None, Some(place)) = (self.failure, place) {
            self.failure = Some(self.broken(model, place.constraint, time, missing));
        }
    }
}
