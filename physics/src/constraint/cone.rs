//! Contact forces within the cones of friction, where the contact points of two bodies can share their forces in many ways.
//!
//! A box stands on four corners. Its balance gives three equations for the four normal forces, and three for the eight components of
//! friction, so many sets of forces hold it. The factorization picks the set with the smallest sum of squares. In this set, some forces can
//! lie outside their cones (|λ| ≤ μ λₙ), although another set within the cones would hold the box as well. Sweeps over all contacts then
//! look for a set within the cones. If there is none, they show which points slip: those that accelerate although their friction is at its
//! limit.

use glam::DVec2;

use super::super::{Loads, Model, State};
use super::Law;
use super::friction::FrictionPair;
use super::jacobian::{move_members, product};
use super::row_modes::Mode;
use super::solver::Solver;
use super::sweep::{Purpose, Stopping};

/// The sweeps end when they change no acceleration by more than this fraction of the largest acceleration.
const SWEEP_TOLERANCE: f64 = 1e-12;

/// The largest number of sweeps in one search for forces.
const MAX_SWEEPS: usize = 2_000;

/// The forces are found if they violate no law of contacts by more than this fraction of the largest acceleration.
const LARGEST_VIOLATION: f64 = 1e-7;

/// A contact that sticks begins to slip if the acceleration of its slip exceeds this fraction of the largest acceleration.
pub(super) const LEAST_SLIP: f64 = 1e-9;

/// If a slip begins with more than this fraction of the largest acceleration, its direction is taken from the acceleration. A slower one
/// takes the direction of the friction, which is then known more exactly.
const CLEAR_SLIP: f64 = 1e-4;

/// The acceleration to which the sweeps drive the slip of a sliding contact, as a multiple of the largest acceleration. No friction can
/// give it, so the friction of a sliding contact has its full size.
const UNREACHABLE_ACCELERATION: f64 = 1e12;

impl Solver {
    /// Returns the first row of a pair of friction rows in a wrong mode: one that begins to slide in the direction in which friction pushes it,
    /// or else one that sticks with a force outside its cone.
    /// `slight` is the tolerance for accelerations.
    pub(super) fn strained(&self, accelerations: &[f64], slight: f64) -> Option<usize> {
        let is_strained = |grip: &&FrictionPair| {
            let slight = slight * self.unit(grip.row);
            match self.modes[grip.row] {
                Mode::Held => self.excess(grip) > slight,
                Mode::Slid if grip.is_beginning => grip.of(accelerations).dot(grip.push) > slight,
                _ => false,
            }
        };
        let slides = |grip: &&FrictionPair| self.modes[grip.row] == Mode::Slid;
        let strained = self.grips.iter().filter(is_strained);
        let first = strained.clone().find(slides).or(strained.clone().next());
        first.map(|grip| grip.row)
    }

    /// Returns by how much the friction of a pair exceeds its limit, as an acceleration. Negative within the cone.
    pub(super) fn excess(&self, grip: &FrictionPair) -> f64 {
        let most = grip.coefficient * self.unknown[grip.normal].max(0.0);
        (grip.of(&self.unknown).length() - most) * self.pair_weight(grip.row)
    }

    /// Finds contact forces within the cones of friction at the state of the last measurement, and writes them to `unknown`, which holds
    /// the forces of the present modes before the call. `loads` are all other forces, including those of motors at their limits.
    /// `can_push` tells which inequalities may push. Returns the acceleration c'' of each constraint row, or `None` if the sweeps find no
    /// forces.
    pub(super) fn share_forces(
        &mut self,
        t: f64,
        state: &State,
        loads: &Loads,
        can_push: impl Fn(usize) -> bool,
    ) -> Option<Vec<f64>> {
        let size = self.largest_acceleration;
        let held = self.held.clone();
        let laws = self.laws.iter();
        self.held = laws.map(|law| *law == Law::Equality).collect();
        let has_joints = self.held.contains(&true);
        if has_joints {
            self.factorise(true);
        }
        self.find_columns();
        let mut goals = vec![0.0; self.rows.len()];
        for (row, goal) in goals.iter_mut().enumerate() {
            let start = self.unknown[row];
            (*goal, self.unknown[row]) = match (self.laws[row], self.modes[row]) {
                (Law::Inequality, _) if can_push(row) => (0.0, start.max(0.0)),
                (Law::Inequality, _) => (f64::NEG_INFINITY, 0.0),
                (Law::Friction { .. }, _) | (Law::SpeedMotor { .. }, Mode::Held) => (0.0, start),
                (Law::SpeedMotor { .. }, _) => {
                    self.columns.block(row);
                    (0.0, 0.0)
                }
                (Law::Equality, _) => (0.0, 0.0),
            };
        }
        for grip in self.grips.iter().filter(|grip| self.slips(grip)) {
            let goal = UNREACHABLE_ACCELERATION * size * self.unit(grip.row) * grip.push;
            (goals[grip.row], goals[grip.row + 1]) = (goal.x, goal.y);
        }
        let contacts = self.unknown.clone();
        self.unknown.fill(0.0);
        self.see_constrained_accelerations(t, state, loads);
        self.unknown = contacts;
        for (row, &force) in self.unknown.iter().enumerate() {
            self.columns.apply(row, force, &mut self.members);
        }
        // Sweeps over rates find forces if each rate is an acceleration.
        self.rows.iter_mut().for_each(|row| std::mem::swap(&mut row.rate, &mut row.bias));
        self.sweep_all(
            &goals,
            Purpose::Forces(1.0),
            Stopping::fast(SWEEP_TOLERANCE * size).at_most(MAX_SWEEPS),
        );
        let accelerations = self.rates_now();
        self.rows.iter_mut().for_each(|row| std::mem::swap(&mut row.rate, &mut row.bias));
        let is_found = self.lawlessness(&accelerations, can_push) <= LARGEST_VIOLATION * size;
        if has_joints {
            self.see_constrained_accelerations(t, state, loads);
        }
        self.held = held;
        if has_joints {
            self.factorise(false);
        }
        is_found.then_some(accelerations)
    }

    /// Returns true if a pair of friction rows slides, and its slip velocity is not zero.
    fn slips(&self, grip: &FrictionPair) -> bool {
        self.modes[grip.row] == Mode::Slid && !grip.is_beginning
    }

    /// Overwrites the velocities of the members with their accelerations under the loads, the contact forces in `unknown`, and the
    /// reactions of the joints, which are written to `unknown`.
    fn see_constrained_accelerations(&mut self, t: f64, state: &State, loads: &Loads) {
        for (member, nature) in self.members.iter_mut().zip(&self.natures) {
            member.follow(nature, state);
        }
        self.see_free_accelerations(t, state, loads);
        let Solver { structure: Some(structure), members, rows, jacobian, unknown, laws, held, .. } = self
        else {
            return;
        };
        for (value, law) in unknown.iter_mut().zip(laws.iter()) {
            if *law == Law::Equality {
                *value = 0.0;
            }
        }
        move_members(structure, jacobian, unknown, members);
        if !held.contains(&true) {
            return;
        }
        let mut reactions: Vec<f64> =
            (0..rows.len()).map(|i| -(product(structure, jacobian, members, i).0 + rows[i].bias)).collect();
        self.factor.solve(&mut reactions);
        move_members(structure, jacobian, &reactions, members);
        for (value, reaction) in unknown.iter_mut().zip(reactions) {
            *value += reaction;
        }
    }

    /// Returns by how much the forces in `unknown` violate the laws of contacts, as an acceleration. Each force is corrected once by its own
    /// law, with the other forces as they are; the largest change of an acceleration counts.
    fn lawlessness(&self, accelerations: &[f64], can_push: impl Fn(usize) -> bool) -> f64 {
        let weights = self.columns.weights();
        let normals = (0..self.rows.len()).filter(|&row| self.laws[row] == Law::Inequality && can_push(row));
        let off = |row: usize| {
            let force = self.unknown[row];
            (force - (force - accelerations[row] / weights[row]).max(0.0)).abs() * weights[row]
                / self.unit(row)
        };
        let normals = normals.filter(|&row| weights[row] > 0.0).map(off);
        let pairs = self.grips.iter().filter(|grip| !self.slips(grip));
        let pairs = pairs.filter_map(|grip| {
            let weight = weights[grip.row].max(weights[grip.row + 1]);
            let force = grip.of(&self.unknown);
            let most = grip.coefficient * self.unknown[grip.normal];
            let next = (force - grip.of(accelerations) / weight).clamp_length_max(most);
            (weight > 0.0).then(|| (next - force).length() * weight / self.unit(grip.row))
        });
        // A NaN counts as a violation.
        normals.chain(pairs).fold(0.0, |most, off| if off <= most { most } else { off })
    }

    /// Decides from shared forces, in `unknown`, and their accelerations which contacts push, stick, and begin to slide.
    pub(super) fn grip_as_shared(&mut self, accelerations: &[f64], can_push: &[bool]) {
        let slight = LEAST_SLIP * self.largest_acceleration;
        for row in (0..self.rows.len()).filter(|&row| self.laws[row] == Law::Inequality && can_push[row]) {
            let opens = self.unknown[row] <= 0.0 && accelerations[row] > slight * self.unit(row);
            self.modes[row] = if opens { Mode::Open } else { Mode::Held };
        }
        for i in 0..self.grips.len() {
            let FrictionPair { row, normal, .. } = self.grips[i];
            let slip = self.grips[i].of(accelerations);
            let mode = if self.modes[normal] != Mode::Held {
                Mode::Open
            } else if self.slips(&self.grips[i]) {
                Mode::Slid
            } else if slip.length() > slight * self.unit(row) {
                let force = self.grips[i].of(&self.unknown);
                let clear = CLEAR_SLIP * self.largest_acceleration * self.unit(row);
                let is_clear = slip.length() > clear || force == DVec2::ZERO;
                let grip = &mut self.grips[i];
                grip.push = if is_clear { -slip.normalize() } else { force.normalize() };
                (grip.heading, grip.is_beginning) = (-grip.push, true);
                Mode::Slid
            } else {
                Mode::Held
            };
            (self.modes[row], self.modes[row + 1]) = (mode, mode);
        }
    }

    /// Shares the contact forces of the last evaluation so that they lie within the cones of friction, where some do not. What the bodies
    /// and joints feel together stays the same.
    pub(crate) fn share_seen_forces(&mut self, model: &Model, t: f64, state: &State) {
        let size = self.largest_acceleration;
        if self.strained(&vec![0.0; self.rows.len()], LEAST_SLIP * size).is_none() {
            return;
        }
        let mut loads = Loads::default();
        model.sum(t, state, &mut loads);
        let found = self.unknown.clone();
        for (member, nature) in self.members.iter_mut().zip(&self.natures) {
            member.follow(nature, state);
        }
        self.push_drives(&mut loads);
        self.unknown.clone_from(&found);
        let modes = self.modes.clone();
        if self.share_forces(t, state, &loads, |row| modes[row] == Mode::Held).is_none() {
            self.unknown = found;
        }
    }
}
