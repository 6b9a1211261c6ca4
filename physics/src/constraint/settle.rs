//! Projection onto the constraints: the impulses of SHAKE and RATTLE, and the corrections of positions and velocities after a step.

use glam::{DQuat, DVec3};

use super::super::integrator::drift_body;
use super::super::{Model, State};
use super::jacobian::{book, move_members, push, rates};
use super::solver::Solver;

/// Velocities obey a constraint if its rate is at most this fraction of the largest rate: a few rounding errors.
const RELATIVE_ROUNDING: f64 = 1e-15;

/// A step does not correct the errors at its start if the rates for that, errors / step, exceed this fraction of the largest rate.
/// In a piece of 1e-15 s, rounding errors of positions would become velocities.
const LARGEST_CORRECTION: f64 = 1e-9;

/// The largest number of iterations of a projection. Each iteration multiplies the error by at most the square of the angle (rad) by which
/// bodies rotate in a step. So a projection that needs more iterations does not converge.
const MAX_ITERATIONS: usize = 60;

/// With friction, the projection stops if the remaining error exceeds this fraction of the error in the iteration before.
const STALLED_RATIO: f64 = 0.95;

/// An iteration converges slowly if it leaves more than this fraction of the largest error. Friction then yields to joints and normals.
const SLOW_CONVERGENCE_RATIO: f64 = 0.1;

/// The projection diverges if the error grows by more than this factor in one iteration.
const DIVERGENCE_RATIO: f64 = 10.0;

impl Solver {
    /// Corrects the velocities at the start of a step by impulses, as in SHAKE and RATTLE. Bodies that move freely from there satisfy the
    /// constraints at the end of the step. [`begin`](Self::begin) must have run at these positions.
    pub(crate) fn aim(&mut self, model: &Model, t: f64, dt: f64, state: &mut State) {
        if self.is_idle(model) {
            return;
        }
        self.is_ready = false;
        self.is_aiming = true;
        self.first.clone_from(&self.jacobian);
        self.first_rates.clear();
        self.first_rates.extend(self.rows.iter().map(|row| row.rate));
        let largest = LARGEST_CORRECTION * self.largest_rate * dt;
        let sudden = |row: usize| self.rows[row].violation.abs() > largest * self.unit(row);
        let is_sudden = !self.contacts.is_empty() && (0..self.rows.len()).any(sudden);
        let left: Vec<f64> = self.rows.iter().filter(|_| is_sudden).map(|row| row.violation).collect();
        let mut trial = std::mem::take(&mut self.trial);
        let of_all = trial.len() != state.len();
        let known = self.structure.as_ref().filter(|_| !of_all).map(|structure| &structure.bodies[..]);
        trial.take_over(state, known);
        model.place(t + dt, &mut trial);
        let (mut before, mut yields) = (f64::INFINITY, false);
        for _ in 0..MAX_ITERATIONS {
            let bodies = self.structure.iter().flat_map(|structure| &structure.bodies);
            for &i in bodies.filter(|&&i| model.inverse_mass()[i] != 0.0) {
                trial.location[i] = state.location[i];
                trial.orientation[i] = state.orientation[i];
                trial.velocity[i] = state.velocity[i];
                trial.angular_momentum[i] = state.angular_momentum[i];
                drift_body(model, dt, &mut trial, i);
            }
            self.measure(t + dt, &trial);
            self.rows.iter_mut().zip(&left).for_each(|(row, left)| row.violation -= left);
            if yields {
                self.yield_friction();
            }
            let mut worst = self.worst();
            if !yields && worst > SLOW_CONVERGENCE_RATIO * before && !self.grips.is_empty() {
                yields = true;
                self.yield_friction();
                (worst, before) = (self.worst(), f64::INFINITY);
            }
            let is_enough = worst > 0.5 * before && self.are_kept();
            // The equations of friction at several points can contradict each other, so the error may stay.
            let stays = self.factor.is_soft() && worst > STALLED_RATIO * before;
            // With friction, a small error may still shrink: far from the origin, what is left of it would change the angular momentum.
            let may_shrink =
                !self.grips.is_empty() && worst > 0.0 && worst <= SLOW_CONVERGENCE_RATIO * before;
            if (worst <= 1.0 && !may_shrink) || is_enough || stays {
                break;
            }
            if worst > DIVERGENCE_RATIO * before {
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
            // Redundant contacts may contradict each other under friction, which is no failure. The projection after the step corrects
            // their positions.
            self.blame(model, t + dt);
        }
        self.is_aiming = false;
        // The errors of some constraint rows are measured differently while the velocities are corrected.
        self.measured = f64::NAN;
    }

    /// Drops the errors of friction: what has slipped stays. The slip within a step is known to the accuracy of the method only, so joints
    /// and normals, which are exact, can contradict it.
    fn yield_friction(&mut self) {
        for grip in &self.grips {
            self.rows[grip.row..grip.row + 2].iter_mut().for_each(|row| row.violation = 0.0);
        }
    }

    /// Projects a state onto the constraints. Moves the bodies the shortest distance, in the metric of the mass matrix M, to satisfy all
    /// constraints. Then removes the velocity components that violate them.
    pub(crate) fn settle(&mut self, model: &Model, t: f64, state: &mut State) {
        if self.is_idle(model) {
            return;
        }
        self.is_ready = false;
        self.plan(model);
        self.settle_places(t, state);
        self.blame(model, t);
        self.settle_velocities(model, state);
    }

    /// Moves the bodies the shortest distance to satisfy the active constraint rows. [`hold_joints`](Self::hold_joints) or
    /// [`begin`](Self::begin) selects them.
    pub(crate) fn settle_places(&mut self, t: f64, state: &mut State) {
        let mut before = f64::INFINITY;
        // The last stage of many methods is at the end of the step, so its factorization is accurate enough.
        self.is_factorised = self.factorised.to_bits() == t.to_bits();
        for _ in 0..MAX_ITERATIONS {
            self.measure_places(t, state);
            let worst = self.worst();
            let is_slow = worst > 0.1 * before;
            if worst <= 1.0 || (is_slow && self.are_kept()) {
                return;
            }
            if !self.is_factorised || is_slow {
                self.factorise(false);
            }
            before = worst;
            for (value, row) in self.unknown.iter_mut().zip(&self.rows) {
                *value = -row.violation;
            }
            // If nearly redundant constraint rows contradict each other, the softness keeps bodies from moving far.
            self.factor.solve(&mut self.unknown);
            self.move_at_once(state);
        }
    }

    /// Moves the bodies by the shifts M⁻¹ Jᵀ Λ, where `unknown` holds Λ. The turns of all equations are added before a body turns: turns made
    /// one after another would leave a rotation of the second order, which depends on the axes and the order of the equations.
    fn move_at_once(&mut self, state: &mut State) {
        let Solver { structure: Some(structure), members, jacobian, unknown, .. } = self else { return };
        // The velocities of the members serve as working memory. The next measurement restores them.
        for member in members.iter_mut() {
            (member.velocity, member.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
        }
        move_members(structure, jacobian, unknown, members);
        for (member, &i) in members.iter().zip(&structure.bodies) {
            let turn = member.angular_velocity;
            state.location[i] += member.velocity;
            if turn != DVec3::ZERO {
                state.orientation[i] = (DQuat::from_scaled_axis(turn) * state.orientation[i]).normalize();
            }
        }
    }

    pub(super) fn settle_velocities(&mut self, model: &Model, state: &mut State) {
        let mut before = f64::INFINITY;
        for _ in 0..MAX_ITERATIONS {
            let Solver { structure: Some(structure), members, jacobian, unknown, rows, .. } = self else {
                return;
            };
            let scale = rates(structure, jacobian, members, rows, unknown);
            let length = structure.length;
            let worst = unknown.iter().zip(rows.iter()).zip(&self.held).filter(|(_, held)| **held);
            let worst = worst.fold(0.0_f64, |worst, ((rate, row), _)| {
                worst.max(if row.scale.is_length { rate.abs() } else { length * rate.abs() })
            });
            // If a rate is NaN, the comparison is false and the loop ends as well.
            if !(worst > RELATIVE_ROUNDING * scale && worst < 0.5 * before) {
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
