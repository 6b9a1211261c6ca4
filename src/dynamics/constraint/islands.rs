//! Sweeps over contacts where no joint holds bodies: one island of bodies that touch each other after another.
//!
//! What bodies of one island do to each other does not concern another one, so each is swept only until it has settled. Rows lie one behind another in
//! memory, in the order in which they are swept.

use glam::{DVec2, DVec3};

use super::super::sets::Sets;
use super::Law;
use super::anderson::Anderson;
use super::solver::Solver;
use super::sweep::SWEEPS;

/// A row of a contact, as sweeps need it.
struct Line {
    /// The number of the row in the solver.
    row: usize,
    /// The members that it concerns.
    members: [usize; 2],
    /// Its direction for each of them: linear and angular.
    along: [[DVec3; 2]; 2],
    /// What a unit impulse does to each of them.
    change: [[DVec3; 2]; 2],
    /// How much a unit impulse changes its rate.
    weight: f64,
    /// The part of its rate that does not come from velocities, and the rate that is wanted.
    bias: f64,
    goal: f64,
    /// The least impulse.
    least: f64,
}

/// Two rows of friction, which follow each other.
struct Pair {
    first: usize,
    normal: usize,
    coefficient: f64,
    weight: f64,
}

/// Rows that concern each other through bodies that move.
#[derive(Default)]
struct Island {
    lines: Vec<Line>,
    impulses: Vec<f64>,
    normals: Vec<usize>,
    pairs: Vec<Pair>,
}

impl Line {
    #[inline]
    fn rate(&self, velocities: &[[DVec3; 2]]) -> f64 {
        let of = |i: usize| {
            let velocity = &velocities[self.members[i]];
            self.along[i][0].dot(velocity[0]) + self.along[i][1].dot(velocity[1])
        };
        self.bias + of(0) + of(1)
    }

    #[inline]
    fn push(&self, impulse: f64, velocities: &mut [[DVec3; 2]]) {
        for (&member, change) in self.members.iter().zip(&self.change) {
            let velocity = &mut velocities[member];
            velocity[0] += impulse * change[0];
            velocity[1] += impulse * change[1];
        }
    }

    /// How much a unit impulse changes the rate of another row of the same members.
    fn coupling(&self, other: &Line) -> f64 {
        let of =
            |i: usize| self.change[i][0].dot(other.along[i][0]) + self.change[i][1].dot(other.along[i][1]);
        (of(0) + of(1)).abs()
    }
}

impl Island {
    /// One sweep over all normals, and then over all friction. Gives the largest change of a rate.
    fn sweep(&mut self, velocities: &mut [[DVec3; 2]]) -> f64 {
        let mut change = 0.0_f64;
        for &normal in &self.normals {
            let line = &self.lines[normal];
            if line.weight <= 0.0 {
                continue;
            }
            let before = self.impulses[normal];
            let next = (before - (line.rate(velocities) - line.goal) / line.weight).max(line.least);
            if next != before {
                self.impulses[normal] = next;
                line.push(next - before, velocities);
                change = change.max((next - before).abs() * line.weight);
            }
        }
        for pair in &self.pairs {
            let before = DVec2::new(self.impulses[pair.first], self.impulses[pair.first + 1]);
            let most = pair.coefficient * self.impulses[pair.normal];
            if pair.weight <= 0.0 || most == 0.0 && before == DVec2::ZERO {
                continue;
            }
            let [u, w] = [&self.lines[pair.first], &self.lines[pair.first + 1]];
            let slip = DVec2::new(u.rate(velocities) - u.goal, w.rate(velocities) - w.goal);
            let next = (before - slip / pair.weight).clamp_length_max(most);
            (self.impulses[pair.first], self.impulses[pair.first + 1]) = (next.x, next.y);
            u.push(next.x - before.x, velocities);
            w.push(next.y - before.y, velocities);
            change = change.max((next - before).length() * pair.weight);
        }
        change
    }

    /// Makes sweeps, accelerated by Anderson's method, until one changes no rate by more than `tolerance`.
    fn settle(&mut self, tolerance: f64, velocities: &mut [[DVec3; 2]]) {
        let weights: Vec<f64> = self.lines.iter().map(|line| line.weight).collect();
        let mut anderson = Anderson::from(&self.impulses, &weights);
        for left in (0..SWEEPS).rev() {
            if self.sweep(velocities) <= tolerance || left == 0 {
                return;
            }
            let further = anderson.go_further(&self.impulses);
            for ((line, impulse), &further) in self.lines.iter().zip(&mut self.impulses).zip(further) {
                if further != 0.0 {
                    *impulse += further;
                    line.push(further, velocities);
                }
            }
        }
    }
}

impl Solver {
    /// Finds the impulses in `unknown`, which begin as they are, and changes the velocities of the members by them. Contacts let their
    /// rates fall to `goals` and no further; friction counts only if it is said.
    pub(super) fn sweep_islands(&mut self, goals: &[f64], with_friction: bool, tolerance: f64) {
        let mut velocities: Vec<[DVec3; 2]> =
            self.members.iter().map(|member| [member.velocity, member.angular_velocity]).collect();
        for mut island in self.islands(goals, with_friction) {
            island.settle(tolerance, &mut velocities);
            for (line, impulse) in island.lines.iter().zip(island.impulses) {
                self.unknown[line.row] = impulse;
            }
        }
        for (member, [velocity, angular_velocity]) in self.members.iter_mut().zip(velocities) {
            (member.velocity, member.angular_velocity) = (velocity, angular_velocity);
        }
    }

    /// The contacts as islands. Bodies that do not move belong to none.
    fn islands(&self, goals: &[f64], with_friction: bool) -> Vec<Island> {
        let Some(structure) = &self.structure else { return Vec::new() };
        let mut sets = Sets::new(self.members.len());
        let both = |row: usize| {
            let directions = &self.jacobian[structure.directions_of(row)];
            [directions[0].member, directions[directions.len() - 1].member]
        };
        let moves = |member: usize| self.members[member].inverse_mass != 0.0;
        for place in &structure.places {
            let [a, b] = both(place.row);
            if moves(a) && moves(b) {
                sets.unite(a, b);
            }
        }
        let mut islands: Vec<Island> = Vec::new();
        let mut known: Vec<Option<usize>> = vec![None; self.members.len()];
        let mut grips = self.grips.iter().peekable();
        for place in &structure.places {
            let own = both(place.row).into_iter().find(|&member| moves(member));
            let set = own.map_or(0, |member| sets.first(member));
            let island = *known[set].get_or_insert_with(|| {
                islands.push(Island::default());
                islands.len() - 1
            });
            let island = &mut islands[island];
            let normal = island.lines.len();
            island.normals.push(normal);
            let rows = if with_friction { place.rows } else { 1 };
            for (row, &goal) in goals.iter().enumerate().skip(place.row).take(rows) {
                island.lines.push(self.line(row, goal));
                island.impulses.push(self.unknown[row]);
            }
            while let Some(grip) = grips.next_if(|grip| grip.row < place.row + place.rows) {
                if with_friction {
                    let first = normal + grip.row - place.row;
                    let [u, w] = [&island.lines[first], &island.lines[first + 1]];
                    // The two rows change each other little: their tangents are at right angles.
                    let weight = u.weight.max(w.weight);
                    let weight = if weight > 0.0 { weight + u.coupling(w) } else { 0.0 };
                    island.pairs.push(Pair { first, normal, coefficient: grip.coefficient, weight });
                }
            }
        }
        islands
    }

    fn line(&self, row: usize, goal: f64) -> Line {
        let mut line = Line {
            row,
            members: [0; 2],
            along: [[DVec3::ZERO; 2]; 2],
            change: [[DVec3::ZERO; 2]; 2],
            weight: self.columns.weights()[row],
            bias: self.rows[row].rate,
            goal,
            least: self.least(row),
        };
        let directions =
            self.structure.iter().flat_map(|structure| &self.jacobian[structure.directions_of(row)]);
        for (i, direction) in directions.enumerate() {
            line.members[i] = direction.member;
            line.along[i] = [direction.linear, direction.angular];
        }
        for change in self.columns.of(row) {
            let i = usize::from(change.member != line.members[0]);
            line.change[i] = [change.velocity, change.angular_velocity];
        }
        debug_assert!(self.laws[row] == Law::Stop || matches!(self.laws[row], Law::Friction { .. }));
        line
    }
}
