//! Projection onto the constraints: the impulses of SHAKE and RATTLE, and the corrections after a step.

use glam::{DQuat, DVec3};

use super::super::integrator::drift_body;
use super::super::{Model, State};
use super::jacobian::{book, for_each_direction, move_members, push, rates};
use super::solver::{FAILURE, Solver};

/// The tolerance of an equation, as a fraction of its scale: a few rounding errors.
const ROUNDING: f64 = 1e-15;

/// Iterations contract at least by the square of the rotation angle in a step. If they need more, they do not converge.
const ITERATIONS: usize = 60;

/// Iteration stops if the error remains above this fraction of the last one.
const STAYS: f64 = 0.95;

/// An iteration diverges if the error grows by more than this factor.
const DIVERGED: f64 = 10.0;

impl Solver {
    /// Changes the velocities at the start of a step such that freely moving bodies satisfy the constraints at its end: the impulses of
    /// SHAKE and RATTLE. [`begin`](Self::begin) has been called at these positions.
    pub(in crate::dynamics) fn aim(&mut self, model: &Model, t: f64, dt: f64, state: &mut State) {
        if self.is_idle(model) {
            return;
        }
        self.is_ready = false;
        self.is_aiming = true;
        self.first.clone_from(&self.jacobian);
        self.first_rates.clear();
        self.first_rates.extend(self.rows.iter().map(|row| row.rate));
        let mut trial = std::mem::take(&mut self.trial);
        let of_all = trial.len() != state.len();
        let known = self.structure.as_ref().filter(|_| !of_all).map(|structure| &structure.bodies[..]);
        trial.take_over(state, known);
        model.place(t + dt, &mut trial);
        let mut before = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let bodies = self.structure.iter().flat_map(|structure| &structure.bodies);
            for &i in bodies.filter(|&&i| model.inverse_mass()[i] != 0.0) {
                trial.location[i] = state.location[i];
                trial.orientation[i] = state.orientation[i];
                trial.velocity[i] = state.velocity[i];
                trial.angular_momentum[i] = state.angular_momentum[i];
                drift_body(model, dt, &mut trial, i);
            }
            self.measure(t + dt, &trial);
            let worst = self.worst();
            let is_enough = worst < FAILURE && worst > 0.5 * before;
            // Friction at several points need not be consistent.
            let stays = self.factor.is_soft() && worst > STAYS * before;
            if worst <= ROUNDING || is_enough || stays {
                break;
            }
            if worst > DIVERGED * before {
                break;
            }
            before = worst;
            for (value, row) in self.unknown.iter_mut().zip(&self.rows) {
                *value = -row.violation / dt;
            }
            self.solve();
            let Solver { structure: Some(structure), first, unknown, .. } = &*self else { break };
            push(structure, first, unknown, model, state);
            book(self.first_rates.iter().copied(), &self.unknown, state);
        }
        self.trial = trial;
        if !self.factor.is_soft() {
            // Contacts that imply each other may be inconsistent with friction. Settling corrects their positions.
            self.blame(model, t + dt);
        }
        self.is_aiming = false;
        // Some rows are measured differently while a step is being aimed.
        self.measured = f64::NAN;
    }

    /// Moves the bodies the shortest distance, in the metric of M, to satisfy all constraints. Removes the components of their velocities
    /// that would violate them.
    pub(in crate::dynamics) fn settle(&mut self, model: &Model, t: f64, state: &mut State) {
        if self.is_idle(model) {
            return;
        }
        self.is_ready = false;
        self.plan(model);
        self.settle_places(t, state);
        self.blame(model, t);
        self.settle_velocities(model, state);
    }

    pub(super) fn settle_places(&mut self, t: f64, state: &mut State) {
        let mut before = f64::INFINITY;
        // The last stage of many methods is at the end of the step, so its factors are near enough.
        self.is_factorised = self.factorised.to_bits() == t.to_bits();
        for _ in 0..ITERATIONS {
            self.measure_places(t, state);
            let worst = self.worst();
            let is_slow = worst > 0.1 * before;
            if worst <= ROUNDING || (worst < FAILURE && is_slow) {
                return;
            }
            if !self.is_factorised || is_slow {
                self.factorise(false);
            }
            before = worst;
            for (value, row) in self.unknown.iter_mut().zip(&self.rows) {
                *value = -row.violation;
            }
            // If rows nearly imply each other but disagree, softness keeps bodies from moving far.
            self.factor.solve(&mut self.unknown);
            let Solver { structure: Some(structure), members, jacobian, unknown, .. } = &*self else {
                return;
            };
            for_each_direction(structure, jacobian, unknown, |member, direction, multiplier| {
                let (i, member) = (structure.bodies[member], &members[member]);
                state.location[i] += multiplier * member.inverse_mass * direction.linear;
                let turn = member.turn(multiplier * direction.angular);
                if turn != DVec3::ZERO {
                    state.orientation[i] = (DQuat::from_scaled_axis(turn) * state.orientation[i]).normalize();
                }
            });
        }
    }

    pub(super) fn settle_velocities(&mut self, model: &Model, state: &mut State) {
        let mut before = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let Solver { structure: Some(structure), members, jacobian, unknown, rows, .. } = self else {
                return;
            };
            let scale = rates(structure, jacobian, members, rows, unknown);
            let worst = unknown.iter().zip(&self.held).filter(|(_, held)| **held);
            let worst = worst.fold(0.0_f64, |worst, (rate, _)| worst.max(rate.abs()));
            // A NaN also ends the loop.
            if !(worst > ROUNDING * scale && worst < 0.5 * before) {
                return;
            }
            if !self.is_factorised || worst > 0.1 * before {
                self.factorise(false);
            }
            before = worst;
            self.unknown.iter_mut().for_each(|rate| *rate = -*rate);
            self.solve();
            let Solver { structure: Some(structure), members, jacobian, unknown, rows, .. } = self else {
                return;
            };
            push(structure, jacobian, unknown, model, state);
            book(rows.iter().map(|row| row.rate), unknown, state);
            move_members(structure, jacobian, unknown, members);
        }
    }
}
