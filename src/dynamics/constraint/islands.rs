//! Gauss–Seidel sweeps over contacts without joints, island by island. An island is a set of bodies that touch each other.
//!
//! Islands are independent, so the sweeps over each island end as soon as its impulses have converged. The contact rows of an island are
//! stored in the order of the sweep.

use std::ops::Range;

use glam::{DVec2, DVec3};

use super::super::sets::Sets;
use super::Law;
use super::anderson::Anderson;
use super::solver::Solver;
use super::structure::{Place, Structure};
use super::sweep::{Stopping, even_out, stiffest};

/// A constraint row of a contact (normal or tangent) in the form that Gauss–Seidel sweeps need.
struct Line {
    /// The index of the contact row in the solver.
    row: usize,
    /// The terms of the contact row's rate, as a range of `Island::terms`.
    terms: Range<usize>,
    /// The change of the contact row's rate c' under a unit impulse along this row.
    weight: f64,
    /// The part of the contact row's rate c' that the Gauss–Seidel sweep cannot change: ∂c/∂t and the velocities of fixed bodies.
    bias: f64,
    goal: f64,
    /// The rate that counts as much as 1 m/s.
    unit: f64,
    /// The smallest impulse that the contact row may have.
    least: f64,
}

/// The dependence of a contact row on one body's velocity or angular velocity.
struct Term {
    /// The index into the list of all velocities: 2 i for the velocity of member i, 2 i + 1 for its angular velocity.
    velocity: usize,
    /// The entry of the Jacobian: the derivative of the row's rate with respect to this velocity.
    along: DVec3,
    /// The change of this velocity under a unit impulse along the contact row.
    change: DVec3,
}

/// The two friction rows of a contact, with the indices of their lines in the island.
struct Pair {
    first: usize,
    normal: usize,
    coefficient: f64,
    weight: f64,
}

/// The contact rows of one island: rows that are coupled through moving bodies.
#[derive(Default)]
struct Island {
    lines: Vec<Line>,
    terms: Vec<Term>,
    impulses: Vec<f64>,
    normals: Vec<usize>,
    pairs: Vec<Pair>,
}

impl Line {
    #[inline]
    fn rate(&self, terms: &[Term], velocities: &[DVec3]) -> f64 {
        let terms = &terms[self.terms.clone()];
        terms.iter().fold(self.bias, |rate, term| rate + term.along.dot(velocities[term.velocity]))
    }

    #[inline]
    fn push(&self, impulse: f64, terms: &[Term], velocities: &mut [DVec3]) {
        for term in &terms[self.terms.clone()] {
            velocities[term.velocity] += impulse * term.change;
        }
    }
}

impl Island {
    /// Makes one Gauss–Seidel sweep over all normal rows, then over all friction rows. Returns the largest change of a rate.
    fn sweep(&mut self, velocities: &mut [DVec3]) -> f64 {
        let mut change = 0.0_f64;
        for &normal in &self.normals {
            let line = &self.lines[normal];
            if line.weight <= 0.0 {
                continue;
            }
            let before = self.impulses[normal];
            let next =
                (before - (line.rate(&self.terms, velocities) - line.goal) / line.weight).max(line.least);
            if next != before {
                self.impulses[normal] = next;
                line.push(next - before, &self.terms, velocities);
                change = change.max((next - before).abs() * line.weight / line.unit);
            }
        }
        for pair in &self.pairs {
            let before = DVec2::new(self.impulses[pair.first], self.impulses[pair.first + 1]);
            let most = pair.coefficient * self.impulses[pair.normal];
            if pair.weight <= 0.0 || most == 0.0 && before == DVec2::ZERO {
                continue;
            }
            let [u, w] = [&self.lines[pair.first], &self.lines[pair.first + 1]];
            let slip = DVec2::new(
                u.rate(&self.terms, velocities) - u.goal,
                w.rate(&self.terms, velocities) - w.goal,
            );
            let next = (before - slip / pair.weight).clamp_length_max(most);
            (self.impulses[pair.first], self.impulses[pair.first + 1]) = (next.x, next.y);
            u.push(next.x - before.x, &self.terms, velocities);
            w.push(next.y - before.y, &self.terms, velocities);
            change = change.max((next - before).length() * pair.weight / u.unit);
        }
        change
    }

    /// Returns the change of the rate of `other` under a unit impulse along `line`. Both contact rows have the same members.
    fn coupling(&self, line: &Line, other: &Line) -> f64 {
        let of = |term: &Term| {
            let same = self.terms[other.terms.clone()].iter().find(|same| same.velocity == term.velocity);
            same.map_or(0.0, |same| term.change.dot(same.along))
        };
        self.terms[line.terms.clone()].iter().map(of).sum()
    }

    /// Repeats Gauss–Seidel sweeps.
    fn settle(&mut self, stopping: Stopping, velocities: &mut [DVec3]) {
        let mut weights: Vec<f64> = self.lines.iter().map(|line| line.weight).collect();
        self.pairs.iter().for_each(|pair| even_out(&mut weights[pair.first..pair.first + 2]));
        let mut anderson = Anderson::from(&self.impulses, &weights);
        for number in 1.. {
            if stopping.ends(number, self.sweep(velocities)) {
                return;
            }
            if !stopping.is_fast {
                continue;
            }
            let further = anderson.go_further(&self.impulses);
            for ((line, impulse), &further) in self.lines.iter().zip(&mut self.impulses).zip(further) {
                if further != 0.0 {
                    *impulse += further;
                    line.push(further, &self.terms, velocities);
                }
            }
        }
    }
}

impl Solver {
    /// Finds the contact impulses by Gauss–Seidel sweeps over each island, and applies them to the velocities of the members. `unknown`
    /// holds the initial impulses before the call and the result after it. `goals` holds one rate per constraint row: the rate of a normal
    /// row may fall to its goal, and friction drives the rate of a tangent row towards its goal. Friction is included if `with_friction` is
    /// true.
    pub(super) fn sweep_islands(&mut self, goals: &[f64], with_friction: bool, stopping: Stopping) {
        let mut velocities: Vec<DVec3> =
            self.members.iter().flat_map(|member| [member.velocity, member.angular_velocity]).collect();
        for mut island in self.islands(goals, with_friction) {
            island.settle(stopping, &mut velocities);
            for (line, impulse) in island.lines.iter().zip(island.impulses) {
                self.unknown[line.row] = impulse;
            }
        }
        for (member, velocity) in self.members.iter_mut().zip(velocities.chunks_exact(2)) {
            (member.velocity, member.angular_velocity) = (velocity[0], velocity[1]);
        }
    }

    /// Groups the constraints by the moving bodies that couple them. Fixed bodies couple nothing.
    pub(super) fn coupled<'a>(&self, structure: &'a Structure) -> Vec<Vec<&'a Place>> {
        let mut sets = Sets::new(self.members.len());
        let moving =
            |place: &'a Place| place.bodies.iter().copied().filter(|&body| self.members[body].can_move());
        for place in &structure.places {
            let mut bodies = moving(place);
            let Some(first) = bodies.next() else { continue };
            bodies.for_each(|body| sets.unite(first, body));
        }
        let mut groups: Vec<Vec<&Place>> = vec![Vec::new(); self.members.len()];
        for place in &structure.places {
            if let Some(body) = moving(place).next() {
                groups[sets.first(body)].push(place);
            }
        }
        groups.retain(|places| !places.is_empty());
        groups
    }

    /// Collects the contacts of each island.
    fn islands(&self, goals: &[f64], with_friction: bool) -> Vec<Island> {
        let Some(structure) = &self.structure else { return Vec::new() };
        let collect = |places: Vec<&Place>| {
            let mut island = Island::default();
            for place in places {
                self.add_contact(&mut island, place, goals, with_friction);
            }
            island
        };
        self.coupled(structure).into_iter().map(collect).collect()
    }

    /// Adds the rows of a contact to an island.
    fn add_contact(&self, island: &mut Island, place: &Place, goals: &[f64], with_friction: bool) {
        let normal = island.lines.len();
        island.normals.push(normal);
        let rows = if with_friction { place.rows } else { 1 };
        for (row, &goal) in goals.iter().enumerate().skip(place.row).take(rows) {
            let line = self.line(row, goal, &mut island.terms);
            island.lines.push(line);
            island.impulses.push(self.unknown[row]);
        }
        if !with_friction {
            return;
        }
        let start = self.grips.partition_point(|grip| grip.row < place.row);
        for grip in self.grips[start..].iter().take_while(|grip| grip.row < place.row + place.rows) {
            let first = normal + grip.row - place.row;
            let [u, w] = [&island.lines[first], &island.lines[first + 1]];
            let weight = stiffest([u.weight, w.weight], island.coupling(u, w));
            island.pairs.push(Pair { first, normal, coefficient: grip.coefficient, weight });
        }
    }

    /// Creates the [`Line`] of a contact row, and appends its terms to `terms`. The velocities of fixed bodies count as part of the
    /// constant `bias`.
    fn line(&self, row: usize, goal: f64, terms: &mut Vec<Term>) -> Line {
        let mut bias = self.rows[row].rate;
        let first = terms.len();
        let directions =
            self.structure.iter().flat_map(|structure| &self.jacobian[structure.directions_of(row)]);
        for direction in directions {
            let member = &self.members[direction.member];
            let changes = self.columns.of(row).iter().find(|change| change.member == direction.member);
            let [linear, angular] =
                changes.map_or([DVec3::ZERO; 2], |change| [change.velocity, change.angular_velocity]);
            let of = [
                (direction.linear, linear, member.velocity),
                (direction.angular, angular, member.angular_velocity),
            ];
            for (i, (along, change, velocity)) in of.into_iter().enumerate() {
                if member.inverse_mass == 0.0 {
                    bias += along.dot(velocity);
                } else if along != DVec3::ZERO || change != DVec3::ZERO {
                    terms.push(Term { velocity: 2 * direction.member + i, along, change });
                }
            }
        }
        debug_assert!(self.laws[row] == Law::Inequality || matches!(self.laws[row], Law::Friction { .. }));
        let (weight, least) = (self.columns.weights()[row], self.least(row));
        let unit = self.unit(row);
        Line { row, terms: first..terms.len(), weight, bias, goal, unit, least }
    }
}
