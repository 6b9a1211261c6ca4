//! What a unit impulse along each row does to the bodies.

use std::ops::Range;

use glam::DVec3;

use super::jacobian::{move_members, product, products};
use super::member::Member;
use super::solver::Solver;
use super::{Direction, Law};

/// M⁻¹ Jᵀ, row by row, as far as the joints allow.
#[derive(Clone, Debug, Default)]
pub(super) struct Columns {
    changes: Vec<Change>,
    rows: Vec<Range<usize>>,
    weights: Vec<f64>,
}

/// What a unit impulse does to a member.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Change {
    pub(super) member: usize,
    pub(super) velocity: DVec3,
    pub(super) angular_velocity: DVec3,
}

impl Columns {
    pub(super) fn clear(&mut self) {
        self.changes.clear();
        self.rows.clear();
        self.weights.clear();
    }

    /// Adds the next row, with how much a unit impulse changes its own rate.
    pub(super) fn push(&mut self, changes: impl Iterator<Item = Change>, weight: f64) {
        let start = self.changes.len();
        self.changes
            .extend(changes.filter(|it| it.velocity != DVec3::ZERO || it.angular_velocity != DVec3::ZERO));
        self.rows.push(start..self.changes.len());
        self.weights.push(weight);
    }

    /// What a unit impulse along a row does.
    pub(super) fn of(&self, row: usize) -> &[Change] {
        &self.changes[self.rows[row].clone()]
    }

    /// How much a unit impulse along each row changes its own rate; 0 for a row of a joint itself.
    pub(super) fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Gives members the velocities that an impulse along a row causes.
    #[inline]
    pub(super) fn apply(&self, row: usize, impulse: f64, members: &mut [Member]) {
        for change in self.of(row) {
            members[change.member].velocity += impulse * change.velocity;
            members[change.member].angular_velocity += impulse * change.angular_velocity;
        }
    }
}

impl Solver {
    /// Finds what a unit impulse along each row does, as the joints allow; nothing for a row of a joint itself.
    pub(super) fn find_columns(&mut self) {
        let mut columns = std::mem::take(&mut self.columns);
        columns.clear();
        let has_joints = self.held.contains(&true);
        for row in 0..self.rows.len() {
            if self.laws[row] == Law::Tie {
                columns.push(std::iter::empty(), 0.0);
            } else if has_joints {
                self.push_held_column(row, &mut columns);
            } else {
                self.push_free_column(row, &mut columns);
            }
        }
        self.columns = columns;
    }

    /// Adds what an impulse along a row does while joints hold: their reactions move other bodies as well.
    fn push_held_column(&mut self, row: usize, columns: &mut Columns) {
        let Some(structure) = &self.structure else { return };
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
        let change = |(number, member): (usize, &Member)| Change {
            member: number,
            velocity: member.velocity,
            angular_velocity: member.angular_velocity,
        };
        columns.push(moved.iter().enumerate().map(change), weight);
    }

    /// The same where no joint holds bodies: only those of the row itself move.
    fn push_free_column(&self, row: usize, columns: &mut Columns) {
        let Some(structure) = &self.structure else { return };
        let directions = &self.jacobian[structure.directions_of(row)];
        let mut weight = 0.0;
        for direction in directions {
            let Direction { linear, angular, .. } = self.members[direction.member].weigh(direction);
            weight += direction.linear.dot(linear) + direction.angular.dot(angular);
        }
        let change = |direction: &Direction| {
            let Direction { linear, angular, .. } = self.members[direction.member].weigh(direction);
            Change { member: direction.member, velocity: linear, angular_velocity: angular }
        };
        columns.push(directions.iter().map(change), weight);
    }
}
