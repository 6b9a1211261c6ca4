//! The changes of all bodies' velocities under a unit impulse along each constraint row.

use std::ops::Range;

use glam::DVec3;

use super::factor::PIVOT_TOLERANCE;
use super::jacobian::product;
use super::member::Member;
use super::solver::Solver;
use super::{Direction, Law};

/// The columns of M⁻¹ Jᵀ, one per constraint row, including the reactions of the joints. A column holds the velocity changes of the bodies
/// under a unit impulse along its row.
#[derive(Clone, Debug, Default)]
pub(super) struct Columns {
    changes: Vec<UnitResponse>,
    rows: Vec<Range<usize>>,
    weights: Vec<f64>,
}

/// The velocity change of one body under a unit impulse along a constraint row.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct UnitResponse {
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

    /// Appends the velocity changes of the next constraint row. `weight` is the change of the row's own rate c' under a unit impulse along
    /// this row.
    pub(super) fn push(&mut self, changes: impl Iterator<Item = UnitResponse>, weight: f64) {
        let start = self.changes.len();
        self.changes
            .extend(changes.filter(|it| it.velocity != DVec3::ZERO || it.angular_velocity != DVec3::ZERO));
        self.rows.push(start..self.changes.len());
        self.weights.push(weight);
    }

    /// Returns the velocity changes of the bodies under a unit impulse along a constraint row.
    pub(super) fn of(&self, row: usize) -> &[UnitResponse] {
        &self.changes[self.rows[row].clone()]
    }

    /// Returns the change of each constraint row's own rate c' under a unit impulse along this row, one entry per row; 0 for rows of
    /// joints.
    pub(super) fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Makes sweeps leave a constraint row out.
    pub(super) fn block(&mut self, row: usize) {
        self.weights[row] = 0.0;
    }

    /// Adds the velocity changes under an impulse along a constraint row to the members' velocities.
    #[inline]
    pub(super) fn apply(&self, row: usize, impulse: f64, members: &mut [Member]) {
        for change in self.of(row) {
            members[change.member].velocity += impulse * change.velocity;
            members[change.member].angular_velocity += impulse * change.angular_velocity;
        }
    }
}

impl Solver {
    /// Computes the velocity changes under a unit impulse along each constraint row, including the reactions of the joints. The columns of
    /// the joints' own rows stay empty.
    pub(super) fn find_columns(&mut self) {
        let mut columns = std::mem::take(&mut self.columns);
        columns.clear();
        let has_joints = self.held.contains(&true);
        // Working memory, which is zero between rows.
        let mut moved: Vec<Member> = if has_joints { self.members.clone() } else { Vec::new() };
        for member in &mut moved {
            (member.velocity, member.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
        }
        let mut unknown = vec![0.0; self.rows.len()];
        for row in 0..self.rows.len() {
            if self.laws[row] == Law::Equality {
                columns.push(std::iter::empty(), 0.0);
            } else if has_joints && self.is_on_mechanism(row) {
                self.push_held_column(row, &mut columns, &mut moved, &mut unknown);
            } else {
                self.push_free_column(row, &mut columns);
            }
        }
        self.columns = columns;
    }

    /// Returns true if joints act on a body of a constraint row.
    fn is_on_mechanism(&self, row: usize) -> bool {
        let Some(structure) = &self.structure else { return false };
        let directions = &self.jacobian[structure.directions_of(row)];
        directions.iter().any(|direction| structure.mechanism_of[direction.member].is_some())
    }

    /// Appends the velocity changes under a unit impulse along a constraint row when joints are active. The reactions of the joints move
    /// other bodies of the mechanism as well. The column of a row along which the joints block all motion is empty. `moved` and `unknown` are
    /// working memory.
    fn push_held_column(&self, row: usize, columns: &mut Columns, moved: &mut [Member], unknown: &mut [f64]) {
        let Some(structure) = &self.structure else { return };
        let directions = &self.jacobian[structure.directions_of(row)];
        let mut mechanisms: Vec<usize> =
            directions.iter().filter_map(|direction| structure.mechanism_of[direction.member]).collect();
        mechanisms.sort_unstable();
        mechanisms.dedup();
        let rows = || mechanisms.iter().flat_map(|&mechanism| &structure.mechanisms[mechanism].rows).copied();
        let mut members: Vec<usize> = directions.iter().map(|direction| direction.member).collect();
        members.extend(mechanisms.iter().flat_map(|&mechanism| &structure.mechanisms[mechanism].members));
        members.sort_unstable();
        members.dedup();
        for direction in directions {
            let member = &mut moved[direction.member];
            member.velocity += member.inverse_mass * direction.linear;
            member.angular_velocity += member.turn(direction.angular);
        }
        let free = product(structure, &self.jacobian, moved, row).0;
        for row in rows() {
            unknown[row] = -product(structure, &self.jacobian, moved, row).0;
        }
        self.factor.solve_rows(unknown, rows().collect::<Vec<_>>().as_slice());
        for row in rows() {
            let multiplier = std::mem::take(&mut unknown[row]);
            if multiplier != 0.0 {
                for direction in &self.jacobian[structure.directions_of(row)] {
                    let member = &mut moved[direction.member];
                    member.velocity += multiplier * member.inverse_mass * direction.linear;
                    member.angular_velocity += member.turn(multiplier * direction.angular);
                }
            }
        }
        let weight = product(structure, &self.jacobian, moved, row).0;
        // The joints can block all motion along this row. The remaining response is then only a rounding error, of either sign.
        let is_blocked = weight <= PIVOT_TOLERANCE * free;
        let change = |member: usize| {
            let moved = &mut moved[member];
            let change =
                UnitResponse { member, velocity: moved.velocity, angular_velocity: moved.angular_velocity };
            (moved.velocity, moved.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
            change
        };
        let changes: Vec<UnitResponse> = members.into_iter().map(change).collect();
        columns.push(changes.into_iter().filter(|_| !is_blocked), if is_blocked { 0.0 } else { weight });
    }

    /// Appends the velocity changes under a unit impulse along a constraint row when no joint is active: only the bodies of this row move.
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
            UnitResponse { member: direction.member, velocity: linear, angular_velocity: angular }
        };
        columns.push(directions.iter().map(change), weight);
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::super::super::world::Parts;
    use super::super::super::{Anchor, Hinge, RigidBody, Shape, World};
    use super::super::Freedom;
    use super::*;

    /// A plate has two parallel hinges, so it cannot turn against the limits of the first one.
    #[test]
    fn a_row_that_joints_block_responds_to_nothing() {
        for i in 0..20 {
            let turn =
                DQuat::from_rotation_y(0.37 * f64::from(i)) * DQuat::from_rotation_x(0.2 * f64::from(i));
            let mut world = World::new();
            let plate = RigidBody::new(&Shape::Box { size: DVec3::new(2.0, 0.3, 1.0) }, 3.0);
            let id = world.add(plate.with_orientation(turn));
            for (x, limits) in [(-0.7, Some([-1.0, 1.0])), (0.9, None)] {
                let at = DVec3::new(x, 0.1, 0.2);
                let between = [Anchor::Point(turn * at), Anchor::Body { id, at }];
                let hinge = Hinge::new(between, turn * DVec3::Z, turn.conjugate());
                world.add_constraint(hinge.with(Freedom { limits, ..Freedom::default() }));
            }
            let Parts { model, mut state, .. } = world.into_parts();
            let mut solver = Solver::default();
            solver.prepare_sweeps(&model, 0.0, &mut state);
            let is_limit = |row: &usize| solver.laws[*row] == Law::Inequality;
            let limits: Vec<usize> = (0..solver.rows.len()).filter(is_limit).collect();
            assert_eq!(limits.len(), 2);
            for row in limits {
                assert_eq!(solver.columns.weights()[row], 0.0, "turn {i}");
                assert!(solver.columns.of(row).is_empty(), "turn {i}");
            }
        }
    }
}
