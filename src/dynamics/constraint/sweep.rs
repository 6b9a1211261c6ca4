//! Impulses at all contacts, limits and motors at once, by projected Gauss–Seidel sweeps; joints hold exactly meanwhile.
//!
//! Source: M. Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235, for the sweeps.

use glam::{DVec2, DVec3};

use super::super::{Model, State};
use super::Law;
use super::friction::Grip;
use super::jacobian::{move_members, product, products, push};
use super::member::Member;
use super::solver::Solver;
use super::structure::Structure;

/// So many sweeps are made at most.
const SWEEPS: usize = 300;

/// Sweeps end when they change rates by less than this part of the largest one.
const SETTLED: f64 = 1e-7;

/// Sweeps that move bodies apart end when they move them by less than this part of the largest overlap.
const APART: f64 = 1e-5;

/// What the impulses are for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::dynamics) enum Purpose {
    /// An impact: what comes nearer stops. Its work counts as lost at impacts.
    Impact,
    /// Half of what forces do in twice this time, s: the velocities are those in the middle of it.
    Forces(f64),
}

/// What a unit impulse along a row does: changes of the velocities and the angular velocities of members.
#[derive(Clone, Debug, Default)]
pub(super) struct Column {
    changes: Vec<(usize, DVec3, DVec3)>,
    /// How much it changes the rate of its own row.
    weight: f64,
}

impl Column {
    fn apply(&self, impulse: f64, members: &mut [Member]) {
        for &(member, velocity, angular_velocity) in &self.changes {
            members[member].velocity += impulse * velocity;
            members[member].angular_velocity += impulse * angular_velocity;
        }
    }
}

impl Solver {
    /// From now on, all forces are found by sweeps.
    pub(in crate::dynamics) fn find_by_sweeps(&mut self, model: &Model) {
        self.is_loose = model.constraints().is_empty();
    }

    /// Measures all equations at a state, and takes out of the velocities what the joints do not allow. What follows relies on it.
    pub(in crate::dynamics) fn prepare_sweeps(&mut self, model: &Model, t: f64, state: &mut State) {
        self.hold_joints(model, t, state);
        self.settle_velocities(model, state);
        self.columns = (0..self.rows.len()).map(|row| self.column(row)).collect();
    }

    /// What a unit impulse along a row does, as the joints allow; nothing for a row of a joint itself.
    fn column(&mut self, row: usize) -> Column {
        let Some(structure) = &self.structure else { return Column::default() };
        if self.laws[row] == Law::Tie {
            return Column::default();
        }
        if !self.held.contains(&true) {
            return self.free_column(structure, row);
        }
        let mut moved: Vec<Member> = self.members.clone();
        for member in &mut moved {
            (member.velocity, member.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
        }
        let mut unknown = vec![0.0; self.rows.len()];
        unknown[row] = 1.0;
        move_members(structure, &self.jacobian, &unknown, &mut moved);
        products(structure, &self.jacobian, &moved, &mut unknown);
        unknown.iter_mut().for_each(|rate| *rate = -*rate);
        self.factor.solve(&mut unknown);
        move_members(structure, &self.jacobian, &unknown, &mut moved);
        let weight = product(structure, &self.jacobian, &moved, row).0;
        let moves =
            |member: &Member| member.velocity != DVec3::ZERO || member.angular_velocity != DVec3::ZERO;
        let changes = moved.iter().enumerate().filter(|(_, member)| moves(member));
        let changes = changes.map(|(i, member)| (i, member.velocity, member.angular_velocity)).collect();
        Column { changes, weight }
    }

    /// The same where no joint holds bodies: only those of the row itself move.
    fn free_column(&self, structure: &Structure, row: usize) -> Column {
        let mut column = Column::default();
        for direction in &self.jacobian[structure.directions_of(row)] {
            let change = self.members[direction.member].weigh(direction);
            column.weight += direction.linear.dot(change.linear) + direction.angular.dot(change.angular);
            if change.linear != DVec3::ZERO || change.angular != DVec3::ZERO {
                column.changes.push((direction.member, change.linear, change.angular));
            }
        }
        column
    }

    /// Gives the bodies the impulses that contacts, limits and motors exert, after [`prepare_sweeps`](Self::prepare_sweeps) at these
    /// places. Stops let their rates fall to `goals` and no further; friction slows slips down to them.
    pub(in crate::dynamics) fn push_all(
        &mut self,
        model: &Model,
        goals: &[f64],
        purpose: Purpose,
        state: &mut State,
    ) {
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
                        Purpose::Forces(_) => 2.0 * (after[row] - moved),
                    };
                let account = match self.laws[row] {
                    Law::Friction { .. } if purpose != Purpose::Impact => &mut state.accounts.friction,
                    Law::Drive { .. } => &mut state.accounts.motors,
                    Law::Stop if place.constraint < joints => &mut state.accounts.limits,
                    _ => &mut state.accounts.impacts,
                };
                *account += work;
            }
        }
        self.rates_of(model, state);
    }

    /// c' of each row at a state at the places that have been measured last. What joints do not allow is taken out of the velocities.
    pub(in crate::dynamics) fn rates_of(&mut self, model: &Model, state: &mut State) -> Vec<f64> {
        for (member, nature) in self.members.iter_mut().zip(&self.natures) {
            member.follow(nature, state);
        }
        self.settle_velocities(model, state);
        self.rates_now()
    }

    /// Friction stops slips at the end of a time, so that they are half as fast in its middle: writes that to the goals.
    pub(in crate::dynamics) fn halve_slips(&self, goals: &mut [f64]) {
        for grip in &self.grips {
            for row in [grip.row, grip.row + 1] {
                goals[row] = 0.5 * self.rate_of(row);
            }
        }
    }

    /// Lets friction stop at once what it would drive on: the place of contact has moved too far meanwhile.
    pub(in crate::dynamics) fn check_slips(&self, goals: &mut [f64]) {
        for grip in &self.grips {
            let goal = grip.of(goals);
            let slip = DVec2::new(self.rate_of(grip.row), self.rate_of(grip.row + 1));
            if goal.dot(slip - goal) < 0.0 {
                (goals[grip.row], goals[grip.row + 1]) = (0.0, 0.0);
            }
        }
    }

    /// The gaps of all rows as they have been measured last, m.
    pub(in crate::dynamics) fn gaps(&self) -> Vec<f64> {
        let gap =
            |(row, law): (&super::Row, &Law)| if *law == Law::Stop { row.violation.max(0.0) } else { 0.0 };
        self.rows.iter().zip(&self.laws).map(gap).collect()
    }

    /// Moves bodies out of each other, after [`prepare_sweeps`](Self::prepare_sweeps) a little earlier.
    pub(in crate::dynamics) fn separate(&mut self, t: f64, state: &mut State) {
        self.measure(t, state);
        let is_within = |(row, law): (&super::Row, &Law)| *law == Law::Stop && row.violation < 0.0;
        if !self.rows.iter().zip(&self.laws).any(is_within) {
            return;
        }
        self.factorise(true);
        self.columns = (0..self.rows.len()).map(|row| self.column(row)).collect();
        let goals: Vec<f64> = self.rows.iter().map(|row| -row.violation).collect();
        for member in &mut self.members {
            (member.velocity, member.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
        }
        let before = vec![0.0; goals.len()];
        self.sweep_stops(&goals, &before);
        let bodies = self.structure.iter().flat_map(|structure| &structure.bodies);
        for (&body, member) in bodies.zip(&self.members).filter(|(_, member)| member.inverse_mass != 0.0) {
            state.location[body] += member.velocity;
            if member.angular_velocity != DVec3::ZERO {
                let turn = glam::DQuat::from_scaled_axis(member.angular_velocity);
                state.orientation[body] = (turn * state.orientation[body]).normalize();
            }
        }
    }

    /// The contacts that pushed last, by their numbers. `joints` is the number of constraints before them.
    pub(in crate::dynamics) fn pushing_contacts(&self, joints: usize) -> impl Iterator<Item = usize> {
        let places = self.structure.iter().flat_map(|structure| &structure.places);
        let pushing = places.filter(|place| self.unknown[place.row] > 0.0);
        pushing.filter_map(move |place| place.constraint.checked_sub(joints))
    }

    /// c' of each row at the velocities of the members.
    fn rates_now(&self) -> Vec<f64> {
        (0..self.rows.len()).map(|row| self.rate_of(row)).collect()
    }

    fn rate_of(&self, row: usize) -> f64 {
        let Some(structure) = &self.structure else { return 0.0 };
        // As in `product`, but nobody needs to know how large the terms are.
        let mut rate = self.rows[row].rate;
        for direction in &self.jacobian[structure.directions_of(row)] {
            let member = &self.members[direction.member];
            rate += direction.linear.dot(member.velocity) + direction.angular.dot(member.angular_velocity);
        }
        rate
    }

    /// Finds the impulses in `unknown`, and changes the velocities of the members by them.
    fn sweep(&mut self, goals: &[f64], purpose: Purpose, before: &[f64]) {
        self.unknown.fill(0.0);
        if let Purpose::Forces(time) = purpose {
            self.start_warm(time);
        }
        let fastest = before.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        for _ in 0..SWEEPS {
            let mut change = self.sweep_rows(goals, purpose);
            for grip in 0..self.grips.len() {
                change = change.max(self.sweep_grip(grip, goals));
            }
            if change <= SETTLED * fastest {
                break;
            }
        }
        if let Purpose::Forces(time) = purpose {
            self.remember_forces(time);
        }
    }

    /// Begins with the forces that were found last at the same places: what lies still needs no more sweeps then.
    fn start_warm(&mut self, time: f64) {
        for place in self.structure.iter().flat_map(|structure| &structure.places) {
            let Some(contact) = place.constraint.checked_sub(self.joints()) else { continue };
            let Some(forces) = self.warm.find(&self.contacts[contact]) else { continue };
            for (row, force) in (place.row..place.row + place.rows).zip(forces) {
                self.unknown[row] = force * time;
            }
        }
        for (column, impulse) in
            self.columns.iter().zip(&self.unknown).filter(|(_, impulse)| **impulse != 0.0)
        {
            column.apply(*impulse, &mut self.members);
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
    }

    /// The number of constraints before the contacts.
    fn joints(&self) -> usize {
        self.first_row.len() - self.contacts.len()
    }

    /// The same, but only stops push, and there is no friction.
    fn sweep_stops(&mut self, goals: &[f64], before: &[f64]) {
        self.unknown.fill(0.0);
        let size = goals.iter().chain(before).fold(0.0_f64, |most, goal| most.max(*goal));
        for _ in 0..SWEEPS {
            if self.sweep_rows(goals, Purpose::Impact) <= APART * size {
                break;
            }
        }
    }

    /// One sweep over limits, motors and the normals of contacts. Gives the largest change of a rate.
    fn sweep_rows(&mut self, goals: &[f64], purpose: Purpose) -> f64 {
        let mut change = 0.0_f64;
        for (row, &goal) in goals.iter().enumerate() {
            let weight = self.columns[row].weight;
            let law = self.laws[row];
            if weight <= 0.0 || !matches!(law, Law::Stop | Law::Drive { .. }) {
                continue;
            }
            let before = self.unknown[row];
            let goal = if law == Law::Stop { goal } else { 0.0 };
            let wanted = before - (self.rate_of(row) - goal) / weight;
            let next = match (law, purpose) {
                (Law::Stop, _) => wanted.max(0.0),
                (Law::Drive { limit }, Purpose::Forces(time)) => wanted.clamp(-limit * time, limit * time),
                _ => 0.0,
            };
            self.unknown[row] = next;
            self.columns[row].apply(next - before, &mut self.members);
            change = change.max((next - before).abs() * weight);
        }
        change
    }

    /// One sweep over a pair of rows of friction.
    fn sweep_grip(&mut self, grip: usize, goals: &[f64]) -> f64 {
        let Grip { row, normal, coefficient, .. } = self.grips[grip];
        let before = DVec2::new(self.unknown[row], self.unknown[row + 1]);
        let most = coefficient * self.unknown[normal];
        if most == 0.0 && before == DVec2::ZERO {
            return 0.0;
        }
        // The two rows change each other little: their tangents are at right angles.
        let weight = self.columns[row].weight.max(self.columns[row + 1].weight);
        if weight <= 0.0 {
            return 0.0;
        }
        let weight = weight + self.coupling(row);
        let slip = DVec2::new(self.rate_of(row) - goals[row], self.rate_of(row + 1) - goals[row + 1]);
        let next = (before - slip / weight).clamp_length_max(most);
        (self.unknown[row], self.unknown[row + 1]) = (next.x, next.y);
        self.columns[row].apply(next.x - before.x, &mut self.members);
        self.columns[row + 1].apply(next.y - before.y, &mut self.members);
        (next - before).length() * weight
    }

    /// How much a unit impulse along a row changes the rate of the next one.
    fn coupling(&self, row: usize) -> f64 {
        let Some(structure) = &self.structure else { return 0.0 };
        let directions = &self.jacobian[structure.directions_of(row + 1)];
        let changes = &self.columns[row].changes;
        let of = |direction: &super::Direction| {
            let change = changes.iter().find(|(member, ..)| *member == direction.member);
            change.map_or(0.0, |(_, velocity, turn)| {
                direction.linear.dot(*velocity) + direction.angular.dot(*turn)
            })
        };
        directions.iter().map(of).sum::<f64>().abs()
    }
}
