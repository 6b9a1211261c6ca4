//! Newton's method for the islands whose impulses Gauss–Seidel sweeps have not found.

use glam::{DMat3, DVec3};

use super::super::sets::Sets;
use super::Law;
use super::member::Member;
use super::newton::{Bound, Inert, Island, Line, Term};
use super::solver::Solver;
use super::structure::{ConstraintBlock, Structure};
use super::sweep::Purpose;

/// The largest error of a rate that sweeps may leave, as a fraction of the largest rate before the impulses. Newton's method takes over if
/// they leave more.
pub(super) const MAX_SWEEP_RESIDUAL: f64 = 1e-4;

/// Newton's method has helped if it leaves less than this fraction of the error.
pub(super) const MAX_NEWTON_REMAINDER: f64 = 0.5;

/// After failures in a row, Newton's method is left out for a number of times that doubles up to this one.
const LONGEST_PAUSE: u32 = 256;

/// Leaves Newton's method out for a while after it has failed. Flowing grains would otherwise cost much time in vain.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pause {
    /// How often the method is still left out.
    left: u32,
    /// The length of the last pause.
    length: u32,
}

impl Pause {
    /// Returns true if the method is left out this time.
    pub(super) fn goes_on(&mut self) -> bool {
        let goes_on = self.left > 0;
        self.left = self.left.saturating_sub(1);
        goes_on
    }

    /// Notes whether the method has improved any impulses.
    pub(super) fn note(&mut self, has_helped: bool) {
        self.length = if has_helped { 0 } else { (2 * self.length).clamp(1, LONGEST_PAUSE) };
        self.left = self.length;
    }
}

impl Solver {
    /// Improves the impulses in `unknown` by Newton's method in each island where the sweeps have not found them. `members` are the bodies
    /// without the impulses. `largest` is the largest rate, and `tolerance` that of the sweeps.
    pub(super) fn refine(
        &mut self,
        goals: &[f64],
        purpose: Purpose,
        (largest, tolerance): (f64, f64),
        members: &[Member],
    ) {
        if self.pause.goes_on() {
            return;
        }
        let Some(structure) = &self.structure else { return };
        let mut unknown = self.unknown.clone();
        let mut has_changed = None;
        for places in self.coupled(structure) {
            if places.iter().all(|place| place.constraint < self.joints()) {
                continue;
            }
            let (mut island, numbers) = self.island(&places, (goals, purpose), members, &unknown);
            let velocities =
                |&member: &usize| [self.members[member].velocity, self.members[member].angular_velocity];
            let residual = island.residual(&numbers.iter().map(velocities).collect());
            if residual <= MAX_SWEEP_RESIDUAL * largest {
                continue;
            }
            let is_better = island.solve(tolerance) < MAX_NEWTON_REMAINDER * residual;
            has_changed = Some(has_changed == Some(true) || is_better);
            if is_better {
                for (line, impulse) in island.lines.iter().zip(&island.impulses) {
                    if line.bound != Bound::Any {
                        unknown[line.row] = *impulse;
                    }
                }
            }
        }
        let Some(has_changed) = has_changed else { return };
        self.pause.note(has_changed);
        if has_changed {
            self.unknown = unknown;
            self.members.copy_from_slice(members);
            for (row, &impulse) in self.unknown.iter().enumerate().filter(|(_, impulse)| **impulse != 0.0) {
                self.columns.apply(row, impulse, &mut self.members);
            }
        }
    }

    /// Groups the constraints by the moving bodies that couple them. Fixed bodies couple nothing.
    fn coupled<'a>(&self, structure: &'a Structure) -> Vec<Vec<&'a ConstraintBlock>> {
        let mut sets = Sets::new(self.members.len());
        let moving = |place: &'a ConstraintBlock| {
            place.bodies.iter().copied().filter(|&body| self.members[body].can_move())
        };
        for place in &structure.places {
            let mut bodies = moving(place);
            let Some(first) = bodies.next() else { continue };
            bodies.for_each(|body| sets.unite(first, body));
        }
        let mut groups: Vec<Vec<&ConstraintBlock>> = vec![Vec::new(); self.members.len()];
        for place in &structure.places {
            if let Some(body) = moving(place).next() {
                groups[sets.first(body)].push(place);
            }
        }
        groups.retain(|places| !places.is_empty());
        groups
    }

    /// Collects an island: its bodies with their velocities in `members`, and the rows of its constraints with the impulses in `unknown`.
    /// Returns it with the index of the member of each body.
    fn island(
        &self,
        places: &[&ConstraintBlock],
        (goals, purpose): (&[f64], Purpose),
        members: &[Member],
        unknown: &[f64],
    ) -> (Island, Vec<usize>) {
        let mut island = Island::default();
        let mut numbers = Vec::new();
        let mut number = vec![None; members.len()];
        let grips = |row: usize| {
            self.grips.binary_search_by_key(&row, |grip| grip.row).ok().map(|at| &self.grips[at])
        };
        for place in places {
            // The first row of a contact is its normal row. Without it, its friction has no bound, and is left out, too.
            let mut normal = None;
            for row in place.row..place.row + place.rows {
                let at = island.lines.len();
                let (bound, goal) = match (self.laws[row], purpose) {
                    (Law::Equality, _) if self.held[row] => (Bound::Any, 0.0),
                    (Law::Inequality, _) if self.columns.weights()[row] > 0.0 => {
                        normal = normal.or(Some(at));
                        (Bound::AtLeast(self.least(row)), goals[row])
                    }
                    (Law::SpeedMotor { limit }, Purpose::Forces(time))
                        if self.columns.weights()[row] > 0.0 =>
                    {
                        (Bound::AtMost(limit * time), 0.0)
                    }
                    (Law::Friction { .. }, _) => match (normal, grips(row)) {
                        (None, _) => continue,
                        (Some(normal), Some(grip)) => {
                            (Bound::Disc { coefficient: grip.coefficient, normal }, goals[row])
                        }
                        (Some(_), None) => (Bound::Second, goals[row]),
                    },
                    _ => continue,
                };
                self.push_line(row, (bound, goal), members, (&mut number, &mut numbers), &mut island);
                island.impulses.push(unknown[row]);
            }
        }
        island.even_weights();
        (island, numbers)
    }

    /// Appends a row to an island.
    fn push_line(
        &self,
        row: usize,
        (bound, goal): (Bound, f64),
        members: &[Member],
        (number, numbers): (&mut [Option<usize>], &mut Vec<usize>),
        island: &mut Island,
    ) {
        let (mut bias, mut weight, first) = (self.rows[row].rate, 0.0, island.terms.len());
        let directions =
            self.structure.iter().flat_map(|structure| &self.jacobian[structure.directions_of(row)]);
        for direction in directions {
            let member = &members[direction.member];
            if !member.can_move() {
                bias +=
                    direction.linear.dot(member.velocity) + direction.angular.dot(member.angular_velocity);
                continue;
            }
            let body = *number[direction.member].get_or_insert_with(|| {
                island.bodies.push(inert(member));
                numbers.push(direction.member);
                island.bodies.len() - 1
            });
            let weighed = member.weigh(direction);
            weight += direction.linear.dot(weighed.linear) + direction.angular.dot(weighed.angular);
            let angular = if island.bodies[body].inverse_inertia == DMat3::ZERO {
                DVec3::ZERO
            } else {
                direction.angular
            };
            island.terms.push(Term { body, linear: direction.linear, angular });
        }
        let unit = self.unit(row);
        island.lines.push(Line { row, terms: first..island.terms.len(), bias, goal, bound, unit, weight });
    }
}

/// Returns the inertia of a body. A body that does not rotate gets a unit tensor, which no torque reaches.
fn inert(member: &Member) -> Inert {
    let turns = member.inverse_inertia.determinant() > 0.0;
    Inert {
        mass: member.inverse_mass.recip(),
        inertia: if turns { member.inverse_inertia.inverse() } else { DMat3::IDENTITY },
        inverse_inertia: if turns { member.inverse_inertia } else { DMat3::ZERO },
        velocity: member.velocity,
        angular_velocity: member.angular_velocity,
        size: member.size,
    }
}
