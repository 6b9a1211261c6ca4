//! The effect of a unit impulse along each row on the bodies.

use std::ops::Range;

use glam::DVec3;

use super::jacobian::{move_members, product, products};
use super::member::Member;
use super::solver::Solver;
use super::{Direction, Law};

/// M⁻¹ Jᵀ, row by row, under the reactions of the joints.
#[derive(Clone, Debug, Default)]
pub(super) struct Columns {
    changes: Vec<Change>,
    rows: Vec<Range<usize>>,
    weights: Vec<f64>,
}

/// The effect of a unit impulse on a member.
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

    /// Adds the next row. `weight` is the change of its own rate by a unit impulse.
    pub(super) fn push(&mut self, changes: impl Iterator<Item = Change>, weight: f64) {
        let start = self.changes.len();
        self.changes
            .extend(changes.filter(|it| it.velocity != DVec3::ZERO || it.angular_velocity != DVec3::ZERO));
        self.rows.push(start..self.changes.len());
        self.weights.push(weight);
    }

    /// The effects of a unit impulse along a row.
    pub(super) fn of(&self, row: usize) -> &[Change] {
        &self.changes[self.rows[row].clone()]
    }

    /// The change of each row's own rate by a unit impulse; 0 for a row of a joint.
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
    /// Finds the effect of a unit impulse along each row, with the reactions of the joints. Rows of the joints themselves stay empty.
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

    /// Adds the effect of an impulse along a row while joints hold. Their reactions move other bodies as well.
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

    /// Adds the same if no joint holds bodies: only the bodies of the row move.
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
