//! Impulses of all contacts, limits and motors by projected Gauss–Seidel sweeps. The joints hold exactly throughout. For bodies
//! that have nothing to do with joints, `pile.rs` finds the impulses sooner.
//!
//! Source: M. Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235.

use std::sync::Arc;

use glam::DVec2;

use super::super::contact::LastingContact;
use super::super::{Model, State};
use super::anderson::Anderson;
use super::friction::FrictionPair;
use super::jacobian::push;
use super::last_forces::LastForces;
use super::solver::Solver;
use super::{Direction, Law, Row};

/// The largest number of Gauss–Seidel sweeps for one set of impulses.
pub(super) const MAX_SWEEPS: usize = 100;

/// For forces, the Gauss–Seidel sweeps end when they change rates by less than this fraction of the largest rate.
pub(super) const FORCE_SWEEP_TOLERANCE: f64 = 1e-7;

/// For impacts, the Gauss–Seidel sweeps end when they change rates by less than this fraction of the largest rate. The forces computed
/// afterwards correct the remaining error.
pub(super) const IMPACT_SWEEP_TOLERANCE: f64 = 1e-5;

/// The largest number of sweeps without acceleration, which replace accelerated sweeps that have added energy.
const PATIENT_SWEEPS: usize = 20 * MAX_SWEEPS;

/// Impulses add energy if their work is more than this many times the work that the remaining errors of the rates can do.
const EXCUSED_WORK: f64 = 10.0;

/// An extrapolation leaves rounding errors of this fraction of its size. If they exceed the tolerance, the accelerated sweeps have lost
/// their way.
const EXTRAPOLATION_ERROR: f64 = 1e-12;

/// How sweeps over contacts end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stopping {
    /// The change of a rate in one sweep below which no further sweep is needed.
    tolerance: f64,
    /// The largest number of sweeps.
    most: usize,
    /// True if the impulses of several sweeps are extrapolated (Anderson acceleration).
    pub(super) is_fast: bool,
    /// The largest change of a rate that an impulse or an extrapolation may cause alone.
    bound: f64,
}

impl Stopping {
    /// Accelerated sweeps, which converge sooner.
    pub(super) const fn fast(tolerance: f64) -> Stopping {
        Stopping { tolerance, most: MAX_SWEEPS, is_fast: true, bound: f64::INFINITY }
    }

    /// The same with another largest number of sweeps.
    pub(super) const fn at_most(self, most: usize) -> Stopping {
        Stopping { most, ..self }
    }

    /// Many sweeps without acceleration. From zero impulses, none of them adds energy.
    pub(super) const fn patient(tolerance: f64) -> Stopping {
        Stopping { tolerance, most: PATIENT_SWEEPS, is_fast: false, bound: f64::INFINITY }
    }

    /// The same, unless an impulse or an extrapolation would change a rate, alone, by more than `bound`, m/s. Then patient sweeps from zero
    /// replace these.
    ///
    /// Where bodies are wedged between contacts and joints, impulses can grow together without changing any rate, and the acceleration makes
    /// them grow far, from substep to substep. Their errors then change the energy.
    pub(super) fn within(self, bound: f64) -> Stopping {
        Stopping { bound, ..self }
    }

    /// Returns true if sweeps whose largest extrapolation would change a rate by `farthest` have to be repeated without acceleration.
    fn went_too_far(self, farthest: f64) -> bool {
        self.is_fast && EXTRAPOLATION_ERROR * farthest > self.tolerance
    }

    /// Returns true if sweep number `sweep`, counted from 1, is the last, after a change of a rate by `change`.
    pub(super) fn ends(self, sweep: usize, change: f64) -> bool {
        change <= self.tolerance || sweep >= self.most
    }
}

/// What the impulses of a set of Gauss–Seidel sweeps stand for: an impact, or forces during a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Purpose {
    /// An impact: approaching bodies stop. The work of the impulses is booked as lost at impacts.
    Impact,
    /// Forces that act during this time, s: the first half of a substep. The resulting velocities are those in the middle of the substep.
    /// The work of the whole substep is twice the booked work, since the second half repeats the impulses at the same velocities.
    Forces(f64),
}

impl Solver {
    /// Lets Gauss–Seidel sweeps find the forces of contacts from now on.
    pub(crate) fn find_by_sweeps(&mut self) {
        self.is_swept = true;
    }

    /// Replaces the contacts of the solver. Gauss–Seidel sweeps find their forces from now on.
    pub(crate) fn take_contacts_for_sweeps(&mut self, contacts: Vec<Arc<LastingContact>>, model: &Model) {
        let fits = |(old, new): (&Arc<LastingContact>, &Arc<LastingContact>)| {
            old.bodies == new.bodies && old.law == new.law
        };
        let has_place = self.is_swept
            && contacts.len() == self.contacts.len()
            && self.contacts.iter().zip(&contacts).all(fits)
            && self.fits(model);
        self.find_by_sweeps();
        self.contacts = contacts;
        if has_place {
            self.start_anew(model);
        } else {
            self.forget();
        }
    }

    /// Evaluates all equations at a state, removes velocities that violate the joints, and computes the effects of unit impulses.
    /// Gauss–Seidel sweeps need all three.
    pub(crate) fn prepare_sweeps(&mut self, model: &Model, t: f64, state: &mut State) {
        self.hold_joints(model, t, state);
        self.settle_velocities(model, state);
        self.find_columns();
    }

    /// Applies the impulses of contacts, limits and motors to the bodies, and books their work. [`prepare_sweeps`](Self::prepare_sweeps)
    /// must have run at these positions. The rates of stops (inequalities c ≥ 0) may not fall below their `goals`. Friction reduces slip
    /// velocities to the `goals` of its constraint rows.
    pub(crate) fn push_all(&mut self, model: &Model, goals: &[f64], purpose: Purpose, state: &mut State) {
        let before = self.rates_of(model, state);
        self.sweep(goals, purpose, &before);
        let after = self.rates_now();
        let Some(structure) = &self.structure else { return };
        push(structure, &self.jacobian, &self.unknown, model, state);
        let joints = model.constraints().len();
        for place in &structure.places {
            for row in place.row..place.row + place.rows {
                let moved = self.rows[row].rate;
                let work = self.unknown[row]
                    * match purpose {
                        Purpose::Impact => 0.5 * (before[row] + after[row]) - moved,
                        Purpose::Forces(_) => after[row] - moved,
                    };
                let account = match self.laws[row] {
                    Law::Friction { .. } if purpose != Purpose::Impact => &mut state.accounts.friction,
                    Law::SpeedMotor { .. } => &mut state.accounts.motors,
                    Law::Inequality if place.constraint < joints => &mut state.accounts.limits,
                    _ => &mut state.accounts.impacts,
                };
                *account += work;
            }
        }
        let impulses = self.unknown.clone();
        self.rates_of(model, state);
        self.unknown = impulses;
    }

    /// Computes the rate c' of each constraint row from the velocities of a state, at the positions of the last measurement. Velocities
    /// that violate the joints are removed first.
    pub(crate) fn rates_of(&mut self, model: &Model, state: &mut State) -> Vec<f64> {
        for (member, nature) in self.members.iter_mut().zip(&self.natures) {
            member.follow(nature, state);
        }
        self.settle_velocities(model, state);
        self.rates_now()
    }

    /// Returns the target rate of each constraint row for the middle of a time interval: the mean of its rate at the start, in `rates`, and
    /// `goals`, the target at the end. Bodies can stop within the interval, so each target can be reached. A contact that already closes
    /// faster than its goal slows down to the goal at once.
    pub(crate) fn middle(&self, goals: &[f64], rates: &[f64]) -> Vec<f64> {
        let middle = |(row, (&goal, &rate)): (usize, (&f64, &f64))| {
            let middle = 0.5 * (goal + rate);
            if self.laws[row] == Law::Inequality { middle.max(goal) } else { middle }
        };
        goals.iter().zip(rates).enumerate().map(middle).collect()
    }

    /// Returns the gap of each constraint row at the last measurement, m. Gaps of contacts below `closed` times the size of the smaller
    /// body count as zero, as do all rows that are not inequalities (stops).
    pub(crate) fn gaps(&self, closed: f64) -> Vec<f64> {
        let gap =
            |(row, law): (&Row, &Law)| if *law == Law::Inequality { row.violation.max(0.0) } else { 0.0 };
        let mut gaps: Vec<f64> = self.rows.iter().zip(&self.laws).map(gap).collect();
        for place in self.structure.iter().flat_map(|structure| &structure.places) {
            let Some(contact) = place.constraint.checked_sub(self.joints()) else { continue };
            if gaps[place.row] < closed * self.contacts[contact].size {
                gaps[place.row] = 0.0;
            }
        }
        gaps
    }

    /// Returns the pairs of bodies whose contacts pushed in the last solution.
    pub(crate) fn pushing_pairs(&self) -> Vec<[usize; 2]> {
        let places = self.structure.iter().flat_map(|structure| &structure.places);
        let pushing = places.filter(|place| self.unknown[place.row] > 0.0);
        let contacts = pushing.filter_map(|place| place.constraint.checked_sub(self.joints()));
        contacts.map(|contact| self.contacts[contact].bodies).collect()
    }

    /// Returns the two bodies of the contact with the largest normal impulse in the last solution, and the sum of all normal impulses, N s.
    /// `None` if no contact pushes.
    pub(crate) fn hardest_contact(&self) -> Option<([usize; 2], f64)> {
        let places = self.structure.iter().flat_map(|structure| &structure.places);
        let pushing =
            places.filter(|place| place.constraint >= self.joints() && self.unknown[place.row] > 0.0);
        let sum = pushing.clone().map(|place| self.unknown[place.row]).sum();
        let hardest = pushing.max_by(|a, b| self.unknown[a.row].total_cmp(&self.unknown[b.row]))?;
        Some((self.contacts[hardest.constraint - self.joints()].bodies, sum))
    }

    /// Returns the largest rate of a constraint row before the contact forces acted, in the last part of a step, m/s.
    pub(crate) fn fastest(&self) -> f64 {
        self.forced
    }

    /// Forgets the last forces, from which the next sweeps would start.
    pub(crate) fn start_cold(&mut self) {
        self.warm = LastForces::default();
    }

    /// Returns the typical length of the smallest body in contact, m.
    pub(crate) fn least_size(&self) -> f64 {
        self.contacts.iter().map(|contact| contact.size).fold(f64::MAX, f64::min)
    }

    /// Returns the largest error of the joints at the last measurement, m. Angles count times the size of the mechanism.
    pub(crate) fn widest_joint(&self) -> f64 {
        let joints = (0..self.rows.len()).filter(|&row| self.laws[row] == Law::Equality);
        joints.map(|row| self.rows[row].violation.abs() / self.unit(row)).fold(0.0, f64::max)
    }

    /// Computes the rate c' of each constraint row from the velocities of the members.
    pub(crate) fn rates_now(&self) -> Vec<f64> {
        (0..self.rows.len()).map(|row| self.rate_of(row)).collect()
    }

    fn rate_of(&self, row: usize) -> f64 {
        let Some(structure) = &self.structure else { return 0.0 };
        // This loop equals `product`, but it does not compute the magnitude of the terms.
        let mut rate = self.rows[row].rate;
        for direction in &self.jacobian[structure.directions_of(row)] {
            let member = &self.members[direction.member];
            rate += direction.linear.dot(member.velocity) + direction.angular.dot(member.angular_velocity);
        }
        rate
    }

    /// Finds the impulses in `unknown`, and applies them to the velocities of the members. `before` holds the rate of each constraint row
    /// without these impulses.
    fn sweep(&mut self, goals: &[f64], purpose: Purpose, before: &[f64]) {
        let speeds = before.iter().enumerate().map(|(row, rate)| rate.abs() / self.unit(row));
        let fastest = speeds.fold(0.0, f64::max);
        if purpose != Purpose::Impact {
            self.forced = fastest;
        }
        // Rates need no accuracy far below their change by forces in a substep.
        let part = if purpose == Purpose::Impact { IMPACT_SWEEP_TOLERANCE } else { FORCE_SWEEP_TOLERANCE };
        let largest = fastest.max(self.forced);
        let tolerance = part * largest;
        let members = self.members.clone();
        let mut goals = goals.to_vec();
        self.sweep_warmly(&goals, purpose, (largest, tolerance));
        self.refine(&goals, purpose, (largest, tolerance), &members);
        let moved: Vec<f64> = self.rows.iter().map(|row| row.rate).collect();
        let now = self.rates_now();
        let mut is_cold = false;
        if purpose != Purpose::Impact && self.adds_energy(&moved, &now, tolerance) {
            // A contact that opens in the first half of a substep was made to open on in the second. It may close again instead.
            for (goal, law) in goals.iter_mut().zip(&self.laws) {
                *goal = if *law == Law::Inequality { goal.min(0.0) } else { *goal };
            }
            self.members.clone_from(&members);
            self.sweep_warmly(&goals, purpose, (largest, tolerance));
            self.refine(&goals, purpose, (largest, tolerance), &members);
            let now = self.rates_now();
            // Friction can also jam bodies that part, and then adds energy. Without impulses at the start, they part.
            is_cold = self.adds_energy(&moved, &now, tolerance);
        }
        // In the second phase of an impact, contacts give back a part of the energy that the first phase has taken.
        if is_cold || self.least.is_empty() && self.adds_energy(&goals, before, tolerance) {
            // From zero, and without acceleration, each step of a sweep brings the energy nearer to its least value.
            self.unknown.fill(0.0);
            self.members.clone_from(&members);
            self.sweep_all(&goals, purpose, Stopping::patient(tolerance));
        }
        if let Purpose::Forces(time) = purpose {
            self.remember_forces(time);
        }
    }

    /// Sweeps with acceleration. Forces start from those of the last substep. `largest` is the largest rate, m/s.
    fn sweep_warmly(&mut self, goals: &[f64], purpose: Purpose, (largest, tolerance): (f64, f64)) {
        self.unknown.fill(0.0);
        if let Purpose::Forces(time) = purpose {
            self.start_warm(time);
        }
        // At the foot of a stack, an impulse changes its rate by as many times the largest rate as there are bodies above it.
        #[allow(clippy::cast_precision_loss, reason = "there are fewer rows")]
        let bound = largest * self.rows.len() as f64;
        self.sweep_all(goals, purpose, Stopping::fast(tolerance).within(bound));
    }

    /// Repeats sweeps over all contacts, limits and motors.
    pub(super) fn sweep_all(&mut self, goals: &[f64], purpose: Purpose, stopping: Stopping) {
        self.sweep_until(stopping, |solver| {
            let change = solver.sweep_rows(goals, purpose);
            (0..solver.grips.len()).fold(change, |change, grip| change.max(solver.sweep_grip(grip, goals)))
        });
    }

    /// Returns true if the impulses in `unknown` add energy to the motion relative to `goals`, which no contact can. Their work is
    /// computed from the mean of the present rate of each constraint row and that in `before`.
    fn adds_energy(&self, goals: &[f64], before: &[f64], tolerance: f64) -> bool {
        let is_bound =
            |(row, _): &(usize, &f64)| matches!(self.laws[*row], Law::Inequality | Law::Friction { .. });
        let of = |(row, impulse): (usize, &f64)| {
            let work = impulse * (0.5 * (before[row] + self.rate_of(row)) - goals[row]);
            (work, impulse.abs() * self.unit(row))
        };
        adds_energy(self.unknown.iter().enumerate().filter(is_bound).map(of), tolerance)
    }

    /// Repeats Gauss–Seidel sweeps. `sweep` returns the largest change of a rate.
    pub(super) fn sweep_until(&mut self, stopping: Stopping, mut sweep: impl FnMut(&mut Self) -> f64) {
        let (first, members) = (self.unknown.clone(), self.members.clone());
        let mut weights = self.columns.weights().to_vec();
        self.grips.iter().for_each(|grip| even_out(&mut weights[grip.row..grip.row + 2]));
        let mut anderson = Anderson::from(&self.unknown, &weights);
        let mut farthest = 0.0_f64;
        for number in 1.. {
            if stopping.ends(number, sweep(self)) {
                break;
            }
            if !stopping.is_fast {
                continue;
            }
            for (row, &further) in anderson.go_further(&self.unknown).iter().enumerate() {
                self.unknown[row] += further;
                self.columns.apply(row, further, &mut self.members);
                farthest = farthest.max(further.abs() * self.columns.weights()[row] / self.unit(row));
            }
        }
        let alone =
            |(row, impulse): (usize, &f64)| impulse.abs() * self.columns.weights()[row] / self.unit(row);
        let largest = self.unknown.iter().enumerate().map(alone).fold(farthest, f64::max);
        if largest > stopping.bound {
            self.members = members;
            for (row, impulse) in first.into_iter().enumerate() {
                self.columns.apply(row, -impulse, &mut self.members);
            }
            self.unknown.fill(0.0);
        } else if stopping.went_too_far(farthest) {
            (self.unknown, self.members) = (first, members);
        } else {
            return;
        }
        let patient = Stopping::patient(stopping.tolerance);
        let mut number = 1;
        while !patient.ends(number, sweep(self)) {
            number += 1;
        }
    }

    /// Initializes the impulses from the last forces at the same contacts, which act for `time` seconds. Bodies at rest then need no more
    /// Gauss–Seidel sweeps.
    pub(super) fn start_warm(&mut self, time: f64) {
        for place in self.structure.iter().flat_map(|structure| &structure.places) {
            let Some(contact) = place.constraint.checked_sub(self.joints()) else { continue };
            let Some(forces) = self.warm.find(&self.contacts[contact]) else { continue };
            for (row, force) in (place.row..place.row + place.rows).zip(forces) {
                self.unknown[row] = force * time;
            }
        }
        for (row, &impulse) in self.unknown.iter().enumerate().filter(|(_, impulse)| **impulse != 0.0) {
            self.columns.apply(row, impulse, &mut self.members);
        }
    }

    fn remember_forces(&mut self, time: f64) {
        let mut warm = std::mem::take(&mut self.warm);
        self.contacts.iter().for_each(|contact| warm.forget(contact.bodies));
        for place in self.structure.iter().flat_map(|structure| &structure.places) {
            let Some(contact) = place.constraint.checked_sub(self.joints()) else { continue };
            let forces = self.unknown[place.row..place.row + place.rows].iter().map(|impulse| impulse / time);
            warm.note(&self.contacts[contact], forces);
        }
        self.warm = warm;
        let mut joint_forces = Vec::new();
        for place in self.structure.iter().flat_map(|structure| &structure.places) {
            let rows = (place.row..place.row + place.rows).filter(|_| place.constraint < self.joints());
            let is_one = |row: &usize| self.laws[*row] != Law::Equality && self.unknown[*row] != 0.0;
            let force = |row| (place.constraint, row - place.row, self.unknown[row] / time);
            joint_forces.extend(rows.filter(is_one).map(force));
        }
        self.joint_forces = joint_forces;
    }

    /// Returns the number of constraints that precede the contacts: those of the model.
    pub(super) fn joints(&self) -> usize {
        self.first_row.len() - self.contacts.len()
    }

    /// Makes one Gauss–Seidel sweep over limits, motors and the normal rows of contacts. Returns the largest change of a rate,
    /// m/s.
    pub(super) fn sweep_rows(&mut self, goals: &[f64], purpose: Purpose) -> f64 {
        let mut change = 0.0_f64;
        for (row, &goal) in goals.iter().enumerate() {
            let weight = self.columns.weights()[row];
            let law = self.laws[row];
            if weight <= 0.0 || !matches!(law, Law::Inequality | Law::SpeedMotor { .. }) {
                continue;
            }
            let before = self.unknown[row];
            let goal = if law == Law::Inequality { goal } else { 0.0 };
            let wanted = before - (self.rate_of(row) - goal) / weight;
            let next = match (law, purpose) {
                (Law::Inequality, _) => wanted.max(self.least(row)),
                (Law::SpeedMotor { limit }, Purpose::Forces(time)) => {
                    wanted.clamp(-limit * time, limit * time)
                }
                _ => 0.0,
            };
            self.unknown[row] = next;
            self.columns.apply(row, next - before, &mut self.members);
            change = change.max((next - before).abs() * weight / self.unit(row));
        }
        change
    }

    /// Makes one Gauss–Seidel sweep over a pair of friction rows. Returns the change of its slip velocity.
    fn sweep_grip(&mut self, grip: usize, goals: &[f64]) -> f64 {
        let FrictionPair { row, normal, coefficient, .. } = self.grips[grip];
        let before = DVec2::new(self.unknown[row], self.unknown[row + 1]);
        let most = coefficient * self.unknown[normal];
        if most == 0.0 && before == DVec2::ZERO {
            return 0.0;
        }
        let weights = self.columns.weights();
        let weight = stiffest([weights[row], weights[row + 1]], self.coupling(row));
        if weight <= 0.0 {
            return 0.0;
        }
        let slip = DVec2::new(self.rate_of(row) - goals[row], self.rate_of(row + 1) - goals[row + 1]);
        let next = (before - slip / weight).clamp_length_max(most);
        (self.unknown[row], self.unknown[row + 1]) = (next.x, next.y);
        self.columns.apply(row, next.x - before.x, &mut self.members);
        self.columns.apply(row + 1, next.y - before.y, &mut self.members);
        (next - before).length() * weight / self.unit(row)
    }

    /// Returns the change of the next constraint row's rate under a unit impulse along this row.
    fn coupling(&self, row: usize) -> f64 {
        let Some(structure) = &self.structure else { return 0.0 };
        let directions = &self.jacobian[structure.directions_of(row + 1)];
        let changes = self.columns.of(row);
        let of = |direction: &Direction| {
            let change = changes.iter().find(|change| change.member == direction.member);
            change.map_or(0.0, |change| {
                direction.linear.dot(change.velocity) + direction.angular.dot(change.angular_velocity)
            })
        };
        directions.iter().map(of).sum()
    }
}

/// Returns true if the works of impulses, J, exceed what rates that are off by `tolerance`, m/s, explain. Each work comes with the size of
/// its impulse, N s.
pub(super) fn adds_energy(works: impl Iterator<Item = (f64, f64)>, tolerance: f64) -> bool {
    let add = |(work, size): (f64, f64), (more, larger): (f64, f64)| (work + more, size + larger);
    let (work, size) = works.fold((0.0, 0.0), add);
    work > EXCUSED_WORK * tolerance * size
}

/// Returns the largest response to a unit impulse along any tangent of a contact, from the responses along two of its tangents and their
/// coupling: the larger eigenvalue of a symmetric 2 × 2 matrix. It does not depend on which two tangents these are. 0 without a response.
#[inline]
pub(super) fn stiffest([u, w]: [f64; 2], coupling: f64) -> f64 {
    if u.max(w) > 0.0 { 0.5 * (u + w) + libm::hypot(0.5 * (u - w), coupling) } else { 0.0 }
}

/// Replaces the responses along the two tangents of a contact by their mean, which does not depend on which two tangents these are.
pub(super) fn even_out(pair: &mut [f64]) {
    let mean = pair.iter().sum::<f64>() / pair.len() as f64;
    pair.fill(mean);
}
