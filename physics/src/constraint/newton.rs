//! Impulses of all contacts, limits, motors and joints of an island by Newton's method.
//!
//! Gauss–Seidel sweeps carry an impulse from contact to contact, so they need many rounds for a tower, or for a heavy body on light ones.
//! Newton's method sees all contacts at once. It looks for the velocities v with the least value of
//!
//! ½ (v − v*)ᵀ M (v − v*) + Σ ψ(J v)
//!
//! Here v* are the velocities without impulses, and ψ is the augmented Lagrangian of each law: its impulse is λ = P(λ₀ − ρ (J v − goal)),
//! the projection P onto the impulses that the law allows. The result replaces λ₀, until λ₀ hardly changes. Then the laws hold exactly, for
//! every stiffness ρ. The bound μ λₙ of friction follows from the last normal impulse λₙ, so each search is convex, and has one solution.
//! Sources: P. Alart & A. Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353; A. Castro, F. Permenter & X. Han, IEEE Trans. Robotics 39
//! (2023) 1301, for the convex search for velocities.

use std::collections::BTreeSet;
use std::ops::Range;

use glam::{DMat3, DVec2, DVec3};

use super::envelope::{Envelope, narrow_order};

/// The stiffness ρ of a row in the first round, and the largest one, as multiples of the row's effective mass. The stiffness grows from round
/// to round. A small stiffness makes each round short; a large one makes the rounds few.
const FIRST_STIFFNESS: f64 = 1e2;
const LARGEST_STIFFNESS: f64 = 1e6;
const STIFFNESS_GROWTH: f64 = 30.0;

/// The largest number of rounds, each with fixed λ₀.
const MAX_ROUNDS: usize = 40;

/// Islands whose matrix takes more multiplications to factorize are left to the sweeps: large heaps.
const MAX_WORK: f64 = 5e6;

/// Most rounds end within this number of steps of Newton's method. A longer round ends as soon as a step leaves more than
/// `FAST_REMAINDER` of the imbalance: where grains flow, steps go back and forth, and more of them do not help.
const USUAL_STEPS: usize = 6;
const FAST_REMAINDER: f64 = 0.1;

/// A round ends when the momenta balance within this fraction of the tolerance.
const LARGEST_IMBALANCE: f64 = 0.1;

/// A step of Newton's method is shortened until the slope along it has fallen to this fraction.
const LARGEST_SLOPE: f64 = 0.3;

/// The largest number of attempts to shorten a step.
const MAX_SHORTENINGS: usize = 30;

/// The rounds end if this many of them together have not halved the residual.
const ROUNDS_TO_HALVE: usize = 6;

/// A body of an island: its inertia and its velocities without impulses.
pub(super) struct Inert {
    /// The mass, kg, and the inertia tensor in world axes, kg m².
    pub(super) mass: f64,
    pub(super) inertia: DMat3,
    /// The inverse inertia tensor, 1/(kg m²).
    pub(super) inverse_inertia: DMat3,
    /// The velocity, m/s, and the angular velocity, rad/s.
    pub(super) velocity: DVec3,
    pub(super) angular_velocity: DVec3,
    /// The size of the body, m, by which a rate of rotation counts as a speed.
    pub(super) size: f64,
}

/// The law of a row, with the bounds of its impulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Bound {
    /// A joint: any impulse.
    Any,
    /// A contact or a limit: at least this impulse, N s.
    AtLeast(f64),
    /// A motor: at most this impulse in each direction, N s.
    AtMost(f64),
    /// The first of two rows of friction: together at most this multiple of the impulse of the row with this index.
    Disc { coefficient: f64, normal: usize },
    /// The second of two rows of friction.
    Second,
}

/// A row of an island: rate = Σ along · velocity + bias.
pub(super) struct Line {
    /// The index of the row in the solver.
    pub(super) row: usize,
    pub(super) terms: Range<usize>,
    pub(super) bias: f64,
    pub(super) goal: f64,
    pub(super) bound: Bound,
    /// The rate that counts as much as 1 m/s.
    pub(super) unit: f64,
    /// The change of the row's rate under a unit impulse along it, without joints; for two rows of friction, the sum of both.
    pub(super) weight: f64,
}

/// The dependence of a row's rate on the velocities of one body.
pub(super) struct Term {
    pub(super) body: usize,
    pub(super) linear: DVec3,
    pub(super) angular: DVec3,
}

/// All contacts, limits, motors and joints of an island, and its bodies.
#[derive(Default)]
pub(super) struct Island {
    pub(super) bodies: Vec<Inert>,
    pub(super) lines: Vec<Line>,
    pub(super) terms: Vec<Term>,
    /// The impulse of each line.
    pub(super) impulses: Vec<f64>,
}

/// The velocity and the angular velocity of each body.
pub(super) type Velocities = Vec<[DVec3; 2]>;

/// The state of the search in a round.
struct Round<'a> {
    island: &'a Island,
    /// λ₀ of each line.
    first: Vec<f64>,
    /// The largest impulse of friction of each first row of friction.
    most: Vec<f64>,
    /// The stiffness of a row as a multiple of its effective mass.
    stiffness: f64,
}

impl Island {
    /// Finds the impulses, starting from those in `impulses`. Returns the residual: the largest change of a rate, m/s, by which a law would
    /// correct an impulse. The search ends when it is below the tolerance. If the search fails, `impulses` hold the best ones found.
    pub(super) fn solve(&mut self, tolerance: f64) -> f64 {
        let (order, mut matrix) = self.layout();
        let most_rounds = if matrix.work() > MAX_WORK { 0 } else { MAX_ROUNDS };
        let mut best = (self.residual(&self.velocities()), self.impulses.clone());
        // The least residual after each round.
        let mut residuals = vec![best.0];
        let mut velocities = self.velocities();
        let mut stiffness = FIRST_STIFFNESS;
        for _ in 0..most_rounds {
            if best.0 <= tolerance {
                break;
            }
            let round = Round { island: self, first: self.impulses.clone(), most: self.bounds(), stiffness };
            stiffness = (stiffness * STIFFNESS_GROWTH).min(LARGEST_STIFFNESS);
            let Some(impulses) =
                round.search(&mut velocities, &order, &mut matrix, LARGEST_IMBALANCE * tolerance)
            else {
                break;
            };
            self.impulses = impulses;
            let residual = self.residual(&self.velocities());
            if residual < best.0 {
                best = (residual, self.impulses.clone());
            }
            residuals.push(best.0);
            let past = residuals.len().checked_sub(1 + ROUNDS_TO_HALVE).map(|round| residuals[round]);
            if past.is_some_and(|past| best.0 > 0.5 * past) {
                break;
            }
        }
        self.impulses = best.1;
        best.0
    }

    /// Gives both rows of each pair of friction rows the sum of their weights, which does not depend on the directions of the tangents.
    pub(super) fn even_weights(&mut self) {
        for at in 1..self.lines.len() {
            if self.lines[at].bound == Bound::Second {
                let both = self.lines[at - 1].weight + self.lines[at].weight;
                (self.lines[at - 1].weight, self.lines[at].weight) = (both, both);
            }
        }
    }

    /// Returns the place of each body in the order of the factorization, and the empty matrix.
    fn layout(&self) -> (Vec<usize>, Envelope) {
        let mut graph = vec![BTreeSet::new(); self.bodies.len()];
        for line in &self.lines {
            let bodies = || self.terms[line.terms.clone()].iter().map(|term| term.body);
            for body in bodies() {
                graph[body].extend(bodies().filter(|&other| other != body));
            }
        }
        let mut place = vec![0; graph.len()];
        let order = narrow_order(&graph);
        order.iter().enumerate().for_each(|(at, &body)| place[body] = at);
        let before =
            |&body: &usize| graph[body].iter().map(|&other| place[other]).fold(place[body], usize::min);
        let first = order.iter().map(before).flat_map(|first| [6 * first; 6]).collect();
        (place, Envelope::new(first))
    }

    /// Returns the rate of a line, less its goal.
    fn slip(&self, line: &Line, velocities: &Velocities) -> f64 {
        let terms = &self.terms[line.terms.clone()];
        let rate = |term: &Term| {
            let [velocity, angular_velocity] = velocities[term.body];
            term.linear.dot(velocity) + term.angular.dot(angular_velocity)
        };
        line.bias - line.goal + terms.iter().map(rate).sum::<f64>()
    }

    /// Returns the velocities that the impulses cause.
    fn velocities(&self) -> Velocities {
        let mut velocities: Velocities =
            self.bodies.iter().map(|body| [body.velocity, body.angular_velocity]).collect();
        for (line, impulse) in self.lines.iter().zip(&self.impulses) {
            for term in &self.terms[line.terms.clone()] {
                let body = &self.bodies[term.body];
                velocities[term.body][0] += impulse / body.mass * term.linear;
                velocities[term.body][1] += body.inverse_inertia * (impulse * term.angular);
            }
        }
        velocities
    }

    /// Returns the largest impulse of friction of each first row of friction.
    fn bounds(&self) -> Vec<f64> {
        let most = |line: &Line| match line.bound {
            Bound::Disc { coefficient, normal } => coefficient * self.impulses[normal].max(0.0),
            _ => 0.0,
        };
        self.lines.iter().map(most).collect()
    }

    /// Returns the largest change of a rate, m/s, by which a law would correct an impulse.
    pub(super) fn residual(&self, velocities: &Velocities) -> f64 {
        let most = self.bounds();
        let wish = |at: usize| {
            let line = &self.lines[at];
            self.impulses[at] - self.slip(line, velocities) / line.weight
        };
        let mut worst = 0.0_f64;
        for (at, line) in self.lines.iter().enumerate().filter(|(_, line)| line.weight > 0.0) {
            let change = match line.bound {
                Bound::Second => continue,
                Bound::Disc { .. } => {
                    let wish = DVec2::new(wish(at), wish(at + 1)).clamp_length_max(most[at]);
                    (wish - DVec2::new(self.impulses[at], self.impulses[at + 1])).length()
                }
                bound => (bound.nearest(wish(at)) - self.impulses[at]).abs(),
            };
            worst = worst.max(change * line.weight / line.unit);
        }
        worst
    }
}

impl Bound {
    /// Returns the nearest impulse that the law of a single row allows.
    fn nearest(self, impulse: f64) -> f64 {
        match self {
            Bound::AtLeast(least) => impulse.max(least),
            Bound::AtMost(most) => impulse.clamp(-most, most),
            Bound::Any | Bound::Disc { .. } | Bound::Second => impulse,
        }
    }
}

impl Round<'_> {
    fn stiffness(&self, at: usize) -> f64 {
        let weight = self.island.lines[at].weight;
        if weight > 0.0 { self.stiffness / weight } else { 0.0 }
    }

    /// Returns λ₀ − ρ (rate − goal) of each line.
    fn wishes(&self, velocities: &Velocities) -> Vec<f64> {
        let lines = self.island.lines.iter().enumerate();
        lines
            .map(|(at, line)| self.first[at] - self.stiffness(at) * self.island.slip(line, velocities))
            .collect()
    }

    /// Projects the wishes onto the impulses that the laws allow.
    fn impulses(&self, wishes: &[f64]) -> Vec<f64> {
        let mut impulses = wishes.to_vec();
        for (at, line) in self.island.lines.iter().enumerate() {
            match line.bound {
                Bound::Second => {}
                Bound::Disc { .. } => {
                    let found = DVec2::new(wishes[at], wishes[at + 1]).clamp_length_max(self.most[at]);
                    (impulses[at], impulses[at + 1]) = (found.x, found.y);
                }
                bound => impulses[at] = bound.nearest(wishes[at]),
            }
        }
        impulses
    }

    /// Returns the gradient M (v − v*) − Jᵀ λ, for each body a momentum and an angular momentum.
    fn gradient(&self, velocities: &Velocities, impulses: &[f64]) -> Velocities {
        let bodies = self.island.bodies.iter().zip(velocities);
        let mut gradient: Velocities = bodies
            .map(|(body, [velocity, angular_velocity])| {
                [
                    body.mass * (*velocity - body.velocity),
                    body.inertia * (*angular_velocity - body.angular_velocity),
                ]
            })
            .collect();
        for (line, impulse) in self.island.lines.iter().zip(impulses) {
            for term in &self.island.terms[line.terms.clone()] {
                gradient[term.body][0] -= *impulse * term.linear;
                gradient[term.body][1] -= *impulse * term.angular;
            }
        }
        gradient
    }

    /// Returns the largest change of a velocity, m/s, that a gradient stands for.
    fn imbalance(&self, gradient: &Velocities) -> f64 {
        let change = |(body, [linear, angular]): (&Inert, &[DVec3; 2])| {
            let turn = (body.inverse_inertia * *angular).length() * body.size;
            (linear.length() / body.mass).max(turn)
        };
        self.island.bodies.iter().zip(gradient).map(change).fold(0.0, f64::max)
    }

    /// Finds the velocities of this round and returns their impulses; `None` if a few steps do not find them.
    fn search(
        &self,
        velocities: &mut Velocities,
        order: &[usize],
        matrix: &mut Envelope,
        tolerance: f64,
    ) -> Option<Vec<f64>> {
        let mut wishes = self.wishes(velocities);
        let mut impulses = self.impulses(&wishes);
        let mut before = f64::INFINITY;
        for step in 0.. {
            let gradient = self.gradient(velocities, &impulses);
            let imbalance = self.imbalance(&gradient);
            if imbalance <= tolerance {
                return Some(impulses);
            }
            if step >= USUAL_STEPS && imbalance > FAST_REMAINDER * before {
                break;
            }
            before = imbalance;
            self.assemble(&wishes, order, matrix);
            if !imbalance.is_finite() || !matrix.factorise() {
                return None;
            }
            let mut step = vec![0.0; 6 * order.len()];
            for (body, [linear, angular]) in gradient.iter().enumerate() {
                let at = 6 * order[body];
                step[at..at + 3].copy_from_slice(&(-*linear).to_array());
                step[at + 3..at + 6].copy_from_slice(&(-*angular).to_array());
            }
            matrix.solve(&mut step);
            let step: Velocities = order
                .iter()
                .map(|&place| {
                    [DVec3::from_slice(&step[6 * place..]), DVec3::from_slice(&step[6 * place + 3..])]
                })
                .collect();
            (wishes, impulses) = self.walk(velocities, &step, slope(&gradient, &step));
        }
        None
    }

    /// Moves the velocities along a step, or along a part of it if the sum would grow at its end. `start` is the slope at the beginning of
    /// the step. Returns the wishes and impulses at the new velocities. The slope grows along the step, since the sum is convex.
    fn walk(&self, velocities: &mut Velocities, step: &Velocities, start: f64) -> (Vec<f64>, Vec<f64>) {
        let origin = velocities.clone();
        let (mut low, mut high, mut part) = ((0.0, start), None, 1.0);
        for _ in 0..MAX_SHORTENINGS {
            for ((velocity, origin), step) in velocities.iter_mut().zip(&origin).zip(step) {
                *velocity = [origin[0] + part * step[0], origin[1] + part * step[1]];
            }
            let impulses = self.impulses(&self.wishes(velocities));
            let now = slope(&self.gradient(velocities, &impulses), step);
            if now.abs() <= LARGEST_SLOPE * start.abs() || (now < 0.0 && high.is_none()) {
                break;
            }
            if now > 0.0 {
                high = Some((part, now));
            } else {
                low = (part, now);
            }
            let Some((above, positive)) = high else { break };
            // The point at which a straight line between both slopes is zero, but not too near to one of the ends.
            let share = (-low.1 / (positive - low.1)).clamp(0.1, 0.9);
            part = low.0 + share * (above - low.0);
        }
        let wishes = self.wishes(velocities);
        let impulses = self.impulses(&wishes);
        (wishes, impulses)
    }

    /// Writes the matrix of second derivatives: M + Jᵀ G J, with the derivative G of the impulses.
    fn assemble(&self, wishes: &[f64], order: &[usize], matrix: &mut Envelope) {
        matrix.clear();
        for (body, &place) in self.island.bodies.iter().zip(order) {
            for (i, column) in body.inertia.to_cols_array_2d().iter().enumerate() {
                matrix.add(6 * place + i, 6 * place + i, body.mass);
                for (j, entry) in column.iter().enumerate().take(i + 1) {
                    matrix.add(6 * place + 3 + i, 6 * place + 3 + j, *entry);
                }
            }
        }
        for (at, line) in self.island.lines.iter().enumerate() {
            let rho = self.stiffness(at);
            let is_free = match line.bound {
                Bound::Second => continue,
                Bound::Any => true,
                // An impulse exactly at its bound still follows the rate: from a cold start, all are there.
                Bound::AtLeast(least) => wishes[at] >= least,
                Bound::AtMost(most) => wishes[at].abs() <= most,
                Bound::Disc { .. } => {
                    let wish = DVec2::new(wishes[at], wishes[at + 1]);
                    let size = wish.length();
                    if size <= self.most[at] {
                        self.add_outer(&[(at, 1.0)], rho, order, matrix);
                        self.add_outer(&[(at + 1, 1.0)], rho, order, matrix);
                    } else if self.most[at] > 0.0 {
                        let across = wish.perp() / size;
                        let rows = [(at, across.x), (at + 1, across.y)];
                        self.add_outer(&rows, rho * self.most[at] / size, order, matrix);
                    }
                    continue;
                }
            };
            if is_free {
                self.add_outer(&[(at, 1.0)], rho, order, matrix);
            }
        }
    }

    /// Adds `factor` j jᵀ to the matrix, where j is a sum of rows of the Jacobian with these factors.
    fn add_outer(&self, rows: &[(usize, f64)], factor: f64, order: &[usize], matrix: &mut Envelope) {
        let mut entries: Vec<(usize, f64)> = Vec::with_capacity(24);
        let first = &self.island.lines[rows[0].0];
        for (k, term) in self.island.terms[first.terms.clone()].iter().enumerate() {
            let (mut linear, mut angular) = (DVec3::ZERO, DVec3::ZERO);
            for (row, part) in rows {
                // The rows of one contact have the same bodies in the same order.
                let same = &self.island.terms[self.island.lines[*row].terms.start + k];
                linear += *part * same.linear;
                angular += *part * same.angular;
            }
            let at = 6 * order[term.body];
            let numbers = linear.to_array().into_iter().chain(angular.to_array());
            entries.extend(
                numbers.enumerate().filter(|(_, number)| *number != 0.0).map(|(i, number)| (at + i, number)),
            );
        }
        for &(i, a) in &entries {
            for &(j, b) in &entries {
                if j <= i {
                    matrix.add(i, j, factor * a * b);
                }
            }
        }
    }
}

/// Returns the slope along a step: the dot product of the gradient and the step.
fn slope(gradient: &Velocities, step: &Velocities) -> f64 {
    gradient
        .iter()
        .zip(step)
        .map(|(gradient, step)| gradient[0].dot(step[0]) + gradient[1].dot(step[1]))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tolerance of the search, m/s.
    const TOLERANCE: f64 = 1e-10;

    /// Adds a cube with edges of 1 m, and returns its index.
    fn add_cube(island: &mut Island, mass: f64, velocity: DVec3) -> usize {
        let inertia = DMat3::from_diagonal(DVec3::splat(mass / 6.0));
        island.bodies.push(Inert {
            mass,
            inertia,
            inverse_inertia: inertia.inverse(),
            velocity,
            angular_velocity: DVec3::ZERO,
            size: 0.5 * 3.0_f64.sqrt(),
        });
        island.bodies.len() - 1
    }

    /// Adds a row along `direction` at a point. `arms` hold, for each body, its index, its sign, and the point relative to its center.
    fn add_line(island: &mut Island, direction: DVec3, bound: Bound, arms: &[(usize, f64, DVec3)]) -> usize {
        let first = island.terms.len();
        let mut weight = 0.0;
        for &(body, sign, arm) in arms {
            let (linear, angular) = (sign * direction, sign * arm.cross(direction));
            let inert = &island.bodies[body];
            weight += linear.length_squared() / inert.mass + angular.dot(inert.inverse_inertia * angular);
            island.terms.push(Term { body, linear, angular });
        }
        let row = island.lines.len();
        let terms = first..island.terms.len();
        island.lines.push(Line { row, terms, bias: 0.0, goal: 0.0, bound, unit: 1.0, weight });
        island.impulses.push(0.0);
        row
    }

    /// Puts a cube on the floor or on another cube, with friction at its four lower corners. Returns the normal rows.
    fn put(island: &mut Island, upper: usize, lower: Option<usize>, coefficient: f64) -> Vec<usize> {
        let mut normals = Vec::new();
        for (x, z) in [(0.5, 0.5), (0.5, -0.5), (-0.5, 0.5), (-0.5, -0.5)] {
            let mut arms = vec![(upper, 1.0, DVec3::new(x, -0.5, z))];
            arms.extend(lower.map(|lower| (lower, -1.0, DVec3::new(x, 0.5, z))));
            let normal = add_line(island, DVec3::Y, Bound::AtLeast(0.0), &arms);
            add_line(island, DVec3::X, Bound::Disc { coefficient, normal }, &arms);
            add_line(island, DVec3::Z, Bound::Second, &arms);
            normals.push(normal);
        }
        normals
    }

    /// Solves an island and returns the velocities.
    fn solved(mut island: Island) -> (Island, Velocities) {
        island.even_weights();
        let residual = island.solve(TOLERANCE);
        assert!(residual <= TOLERANCE, "{residual}");
        let velocities = island.velocities();
        (island, velocities)
    }

    /// Checks a cube that slides on the floor. It falls by 1 m/s in the step, so friction takes μ × 1 m/s in the direction of the slip.
    #[test]
    fn friction_slows_what_slides_and_holds_what_is_slow() {
        for (slip, left) in [(DVec3::new(0.6, 0.0, 0.8), 0.7), (DVec3::new(0.1, 0.0, 0.2), 0.0)] {
            let mut island = Island::default();
            let cube = add_cube(&mut island, 2.0, slip - DVec3::Y);
            put(&mut island, cube, None, 0.3);
            let (_, velocities) = solved(island);
            // Friction below the center also tips the cube, which is held by the normal impulses: no body turns.
            let [velocity, turn] = velocities[0];
            assert!((velocity - left * slip).length() < 10.0 * TOLERANCE, "{velocity}");
            assert!(turn.length() < 10.0 * TOLERANCE, "{turn}");
        }
    }

    /// Checks a tower of twenty cubes with a hundredfold mass on top, from impulses of zero: everything rests, and each level carries what
    /// is above it.
    #[test]
    fn a_tall_tower_rests() {
        let mut island = Island::default();
        let mut normals = Vec::new();
        for level in 0..21 {
            let mass = if level == 20 { 100.0 } else { 1.0 };
            let cube = add_cube(&mut island, mass, -DVec3::Y);
            normals.push(put(&mut island, cube, cube.checked_sub(1), 0.5));
        }
        let (island, velocities) = solved(island);
        for [velocity, turn] in velocities {
            assert!(velocity.length() < 1e-8 && turn.length() < 1e-8, "{velocity} {turn}");
        }
        for (level, normals) in normals.iter().enumerate() {
            let carried: f64 = normals.iter().map(|&row| island.impulses[row]).sum();
            let above = 120.0 - level as f64;
            assert!((carried / above - 1.0).abs() < 1e-8, "{level}: {carried}");
        }
    }

    /// Checks a body on a rail across which it cannot move. A motor along the rail gives at most its limit.
    #[test]
    fn a_joint_holds_and_a_motor_ends_at_its_limit() {
        for (limit, left) in [(1.0, 1.5), (9.0, 0.0)] {
            let mut island = Island::default();
            let body = add_cube(&mut island, 2.0, DVec3::new(2.0, 3.0, 4.0));
            let arms = [(body, 1.0, DVec3::ZERO)];
            add_line(&mut island, DVec3::Y, Bound::Any, &arms);
            add_line(&mut island, DVec3::Z, Bound::Any, &arms);
            add_line(&mut island, DVec3::X, Bound::AtMost(limit), &arms);
            let (_, velocities) = solved(island);
            assert!((velocities[0][0] - DVec3::X * left).length() < 10.0 * TOLERANCE, "{}", velocities[0][0]);
        }
    }
}
