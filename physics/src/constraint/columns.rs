//! The changes of all bodies' velocities under a unit impulse along each constraint row.

use std::ops::Range;

use glam::DVec3;

use super::factor::PIVOT_TOLERANCE;
use super::member::Member;
use super::solver::Solver;
use super::structure::ConstraintBlock;
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

/// The number of rows of one constraint whose columns are computed together: those of a contact with friction. The joints' equations are
/// read once for all of them.
const ROWS_TOGETHER: usize = 3;

/// The velocity changes of one body under unit impulses along several rows.
#[derive(Clone, Copy, Default)]
struct Moved {
    velocity: [DVec3; ROWS_TOGETHER],
    angular_velocity: [DVec3; ROWS_TOGETHER],
}

/// Working memory for columns. `moved` and `unknown` are zero between two constraints.
#[derive(Default)]
struct Work {
    /// One entry per member.
    moved: Vec<Moved>,
    /// One entry per row.
    unknown: Vec<[f64; ROWS_TOGETHER]>,
    /// The members that move, the mechanisms that the rows touch, and the rows of these mechanisms.
    members: Vec<usize>,
    mechanisms: Vec<usize>,
    rows: Vec<usize>,
}

/// Computes the rates J v of a row from the velocity changes of its bodies.
fn rates(directions: &[Direction], moved: &[Moved]) -> [f64; ROWS_TOGETHER] {
    let mut sums = [0.0; ROWS_TOGETHER];
    for direction in directions {
        let of = &moved[direction.member];
        let turns = direction.angular != DVec3::ZERO;
        for (lane, sum) in sums.iter_mut().enumerate() {
            let turning = if turns { direction.angular.dot(of.angular_velocity[lane]) } else { 0.0 };
            *sum += direction.linear.dot(of.velocity[lane]) + turning;
        }
    }
    sums
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
        let mut work = Work::default();
        for place in self.structure.iter().flat_map(|structure| &structure.places) {
            let is_held = has_joints && self.is_on_mechanism(place);
            let mut row = place.row;
            while row < place.row + place.rows {
                if self.laws[row] == Law::Equality {
                    columns.push(std::iter::empty(), 0.0);
                    row += 1;
                } else if is_held {
                    let rest = &self.laws[row..place.row + place.rows];
                    let free =
                        rest.iter().take(ROWS_TOGETHER).take_while(|law| **law != Law::Equality).count();
                    self.push_held_columns(place, row..row + free, &mut columns, &mut work);
                    row += free;
                } else {
                    self.push_free_column(row, &mut columns);
                    row += 1;
                }
            }
        }
        self.columns = columns;
    }

    /// Returns true if joints act on a body of a constraint.
    fn is_on_mechanism(&self, place: &ConstraintBlock) -> bool {
        let Some(structure) = &self.structure else { return false };
        place.bodies.iter().any(|member| structure.mechanism_of[*member].is_some())
    }

    /// Appends the velocity changes under unit impulses along up to [`ROWS_TOGETHER`] rows of a constraint when joints are active. The reactions of
    /// the joints move other bodies of the mechanism as well. The column of a row along which the joints block all motion is empty.
    fn push_held_columns(
        &self,
        place: &ConstraintBlock,
        own: Range<usize>,
        columns: &mut Columns,
        work: &mut Work,
    ) {
        let Some(structure) = &self.structure else { return };
        let Work { moved, unknown, members, mechanisms, rows } = work;
        moved.resize(self.members.len(), Moved::default());
        unknown.resize(self.rows.len(), [0.0; ROWS_TOGETHER]);
        mechanisms.clear();
        mechanisms.extend(place.bodies.iter().filter_map(|member| structure.mechanism_of[*member]));
        mechanisms.sort_unstable();
        mechanisms.dedup();
        let of = || mechanisms.iter().map(|&mechanism| &structure.mechanisms[mechanism]);
        rows.clear();
        rows.extend(of().flat_map(|mechanism| &mechanism.rows));
        members.clear();
        members.extend(place.bodies.iter().chain(of().flat_map(|mechanism| &mechanism.members)));
        members.sort_unstable();
        members.dedup();

        let directions = |row: usize| &self.jacobian[structure.directions_of(row)];
        let mut free = [0.0; ROWS_TOGETHER];
        for (lane, row) in own.clone().enumerate() {
            for direction in directions(row) {
                let member = &self.members[direction.member];
                let moved = &mut moved[direction.member];
                moved.velocity[lane] += member.inverse_mass * direction.linear;
                moved.angular_velocity[lane] += member.turn(direction.angular);
            }
            free[lane] = rates(directions(row), moved)[lane];
        }
        for &member in &place.bodies {
            for &row in &structure.rows_of[member] {
                unknown[row] = rates(directions(row), moved).map(|rate| -rate);
            }
        }
        self.factor.solve_rows(unknown, rows);
        for &row in &*rows {
            let multipliers = std::mem::take(&mut unknown[row]);
            if multipliers != [0.0; ROWS_TOGETHER] {
                for direction in directions(row) {
                    let member = &self.members[direction.member];
                    let moved = &mut moved[direction.member];
                    for (lane, multiplier) in multipliers.into_iter().enumerate() {
                        moved.velocity[lane] += multiplier * member.inverse_mass * direction.linear;
                        moved.angular_velocity[lane] += member.turn(multiplier * direction.angular);
                    }
                }
            }
        }
        for (lane, row) in own.enumerate() {
            let weight = rates(directions(row), moved)[lane];
            // The joints can block all motion along this row. The remaining response is then only a rounding error, of either sign.
            let is_blocked = weight <= PIVOT_TOLERANCE * free[lane];
            let change = |&member: &usize| {
                let (velocity, angular_velocity) =
                    (moved[member].velocity[lane], moved[member].angular_velocity[lane]);
                UnitResponse { member, velocity, angular_velocity }
            };
            columns.push(
                members.iter().map(change).filter(|_| !is_blocked),
                if is_blocked { 0.0 } else { weight },
            );
        }
        members.iter().for_each(|member| moved[*member] = Moved::default());
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
