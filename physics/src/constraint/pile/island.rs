//! The impulses of an island: Gauss–Seidel sweeps, and Newton's method where these do not find them.

use glam::{DMat3, DVec2, DVec3};

use super::super::anderson::Anderson;
use super::super::newton::{self, Bound, Inert, Line, Term};
use super::super::refine::{MAX_NEWTON_REMAINDER, MAX_SWEEP_RESIDUAL};
use super::super::sweep::{MAX_SWEEPS, Purpose, Stopping, adds_energy};
use super::point::{Point, Roll};
use super::{Island, Pile};

/// The largest number of contact points in a small island.
const SMALL_ISLAND_POINTS: usize = 60;

/// Where many bodies flow, sweeps for forces end at a tolerance that is coarser by this factor: 1e-5 of the largest rate. Impacts have this
/// tolerance in every island.
const COARSER_BY: f64 = 100.0;

/// Where many bodies rest, sweeps end at a tolerance that is finer by this factor. In a tower, a sweep can change little while much is left.
const FINER_BY: f64 = 0.01;

/// In an island at rest, sweeps and Newton's method take turns, at most this many times.
const ROUNDS_AT_REST: usize = 3;

/// The sizes that decide when the search for impulses ends, m/s.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// The largest rate before the impulses.
    pub(super) largest: f64,
    /// The change of a rate in one sweep below which no further sweep is needed.
    pub(super) tolerance: f64,
}

/// The laws that sweeps solve.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Rows {
    /// The normal laws, friction and rolling friction.
    All,
    /// The normal laws alone.
    Normals,
}

/// How an island moves, which decides how its impulses are found.
#[derive(Clone, Copy, PartialEq)]
enum Motion {
    /// Few bodies touch. Newton's method helps if many sweeps leave much.
    OfFew,
    /// Many bodies rest on each other: the loads change the rates at their points by more than these rates. Newton's method finds what a
    /// few sweeps have not found.
    ManyRest,
    /// Many bodies flow. Newton's method seldom helps, and the sweeps end at a coarser tolerance.
    ManyFlow,
}

impl Pile {
    /// Finds the impulses of an island, and applies them to the velocities of its bodies.
    pub(super) fn find(&mut self, island: &Island, purpose: Purpose, limits: Limits) {
        let motion = self.motion(island, purpose);
        let factor = match (motion, purpose) {
            (Motion::ManyRest, _) => FINER_BY,
            (Motion::ManyFlow, Purpose::Forces(_)) => COARSER_BY,
            _ => 1.0,
        };
        let limits = Limits { tolerance: factor * limits.tolerance, ..limits };
        self.sweep_warmly(island, motion, purpose, limits);
        let mut is_cold = false;
        if matches!(purpose, Purpose::Forces(_)) && self.opening_adds_energy(island, limits) {
            // A contact that opens in the first half of a substep was made to open on in the second. It may close again instead.
            for point in &mut self.points[island.points.clone()] {
                point.goal.x = point.goal.x.min(0.0);
            }
            self.sweep_warmly(island, motion, purpose, limits);
            if self.opening_adds_energy(island, limits) {
                // Friction can also jam bodies that part, and then adds energy. Without impulses at the start, they part.
                self.sweep_coldly(island, limits);
                is_cold = true;
            }
        }
        // In the second phase of an impact, contacts give back a part of the energy that the first phase has taken.
        let is_first_phase = self.points[island.points.clone()].iter().all(|point| point.least == 0.0);
        if is_first_phase && !is_cold && self.impulses_add_energy(island, limits) {
            self.sweep_coldly(island, limits);
        }
    }

    /// Sweeps from zero, and without acceleration: each step of a sweep brings the energy nearer to its least value.
    fn sweep_coldly(&mut self, island: &Island, limits: Limits) {
        self.start(island, |_| (DVec3::ZERO, DVec2::ZERO));
        self.sweep(island, Stopping::patient(limits.tolerance), Rows::All);
    }

    /// Sweeps with acceleration, and with Newton's method where this does not converge. Forces start from those of the last substep.
    fn sweep_warmly(&mut self, island: &Island, motion: Motion, purpose: Purpose, limits: Limits) {
        match purpose {
            Purpose::Forces(time) => {
                let known: Vec<_> =
                    island.points.clone().map(|point| self.known_impulse(point, time)).collect();
                self.start(island, |point| known[point - island.points.start]);
            }
            Purpose::Impact => self.start(island, |_| (DVec3::ZERO, DVec2::ZERO)),
        }
        let (rounds, most, enough) = match motion {
            Motion::ManyRest => (ROUNDS_AT_REST, MAX_SWEEPS / ROUNDS_AT_REST, limits.tolerance),
            Motion::OfFew => (1, MAX_SWEEPS, MAX_SWEEP_RESIDUAL * limits.largest),
            Motion::ManyFlow => (1, MAX_SWEEPS, f64::INFINITY),
        };
        for _ in 0..rounds {
            let stopping = Stopping::fast(limits.tolerance).at_most(most);
            let is_found = self.sweep(island, stopping, Rows::All) <= enough;
            if is_found || !self.pause.goes_on() && self.refine(island, enough, limits) {
                return;
            }
        }
    }

    fn motion(&self, island: &Island, purpose: Purpose) -> Motion {
        let (mut fastest, mut changed) = (0.0_f64, 0.0_f64);
        for point in &self.points[island.points.clone()] {
            fastest = fastest.max(point.rate_before.length());
            changed = changed.max((point.free_rate(&self.bodies) - point.rate_before).length());
        }
        match purpose {
            _ if island.points.len() <= SMALL_ISLAND_POINTS => Motion::OfFew,
            Purpose::Forces(_) if fastest <= changed => Motion::ManyRest,
            _ => Motion::ManyFlow,
        }
    }

    /// Returns the impulse and the rolling moment that the last forces of a point cause in `time` seconds.
    fn known_impulse(&self, point: usize, time: f64) -> (DVec3, DVec2) {
        let point = &self.points[point];
        let contact = &self.contacts[point.contact];
        let force = point.components(contact.friction);
        let rolling = point.components(contact.rolling);
        (time * DVec3::new(contact.push, force.y, force.z), time * DVec2::new(rolling.y, rolling.z))
    }

    /// Sets the impulses of an island, which `impulse` returns for each point with its rolling moment, and the velocities that they cause.
    fn start(&mut self, island: &Island, impulse: impl Fn(usize) -> (DVec3, DVec2)) {
        let Pile { points, rolls, impulses, bodies, .. } = self;
        for body in &mut bodies[island.bodies.clone()] {
            [body.velocity, body.angular_velocity] = body.free;
        }
        for number in island.points.clone() {
            let impulse = impulse(number).0;
            impulses[number] = impulse.to_array();
            if impulse != DVec3::ZERO {
                points[number].push(impulse, bodies);
            }
        }
        for roll in &mut rolls[island.rolls.clone()] {
            roll.impulse = impulse(roll.point).1;
            roll.push(roll.impulse, &points[roll.point], bodies);
        }
    }

    /// Repeats Gauss–Seidel sweeps over an island. Returns the largest change of a rate in the last one, m/s.
    pub(super) fn sweep(&mut self, island: &Island, stopping: Stopping, rows: Rows) -> f64 {
        let Pile { points, rolls, impulses, bodies, .. } = self;
        let (points, impulses) = (&points[island.points.clone()], &mut impulses[island.points.clone()]);
        let first = island.points.start;
        let rolls = if rows == Rows::All { &mut rolls[island.rolls.clone()] } else { &mut [] };
        let mut values = Vec::new();
        let mut anderson = stopping
            .is_fast
            .then(|| Anderson::from(values_of(impulses, rolls, &mut values), &weights(points, rolls)));
        for number in 1.. {
            let mut change = 0.0_f64;
            for (point, impulse) in points.iter().zip(&mut *impulses) {
                change = change.max(match rows {
                    Rows::All => point.solve(impulse, bodies),
                    Rows::Normals => point.solve_normal(impulse, bodies),
                });
            }
            for roll in &mut *rolls {
                let (point, [normal, ..]) = (&points[roll.point - first], impulses[roll.point - first]);
                change = change.max(roll.solve(point, normal, bodies) * island.length);
            }
            if stopping.ends(number, change) {
                return change;
            }
            let Some(anderson) = &mut anderson else { continue };
            let further = anderson.go_further(values_of(impulses, rolls, &mut values));
            let (triples, rest) = further.split_at(3 * points.len());
            for ((point, impulse), further) in
                points.iter().zip(&mut *impulses).zip(triples.as_chunks::<3>().0)
            {
                let further = DVec3::from_array(*further);
                if further != DVec3::ZERO {
                    *impulse = (DVec3::from_array(*impulse) + further).to_array();
                    point.push(further, bodies);
                }
            }
            for (roll, further) in rolls.iter_mut().zip(rest.as_chunks::<2>().0) {
                let further = DVec2::from_array(*further);
                roll.impulse += further;
                roll.push(further, &points[roll.point - first], bodies);
            }
        }
        0.0
    }

    /// Returns true if contacts that open add energy to the motion. Forces act twice in a substep, at the same velocities.
    fn opening_adds_energy(&self, island: &Island, limits: Limits) -> bool {
        let of_points = self
            .pushed(island)
            .map(|(point, impulse)| (impulse.dot(point.rate(&self.bodies)), impulse.abs().element_sum()));
        let of_rolls = self.rolls[island.rolls.clone()].iter().map(|roll| {
            let rate = roll.rate(&self.points[roll.point], &self.bodies, |body| body.angular_velocity);
            (roll.impulse.dot(rate), roll.impulse.abs().element_sum() / island.length)
        });
        adds_energy(of_points.chain(of_rolls), limits.tolerance)
    }

    /// Returns true if the impulses add energy to the motion relative to the goals, which no contact can.
    fn impulses_add_energy(&self, island: &Island, limits: Limits) -> bool {
        let of_points = self.pushed(island).map(|(point, impulse)| {
            let mean = 0.5 * (point.free_rate(&self.bodies) + point.rate(&self.bodies));
            (impulse.dot(mean - point.goal), impulse.abs().element_sum())
        });
        let of_rolls = self.rolls[island.rolls.clone()].iter().map(|roll| {
            let point = &self.points[roll.point];
            let before = roll.rate(point, &self.bodies, |body| body.free[1]);
            let after = roll.rate(point, &self.bodies, |body| body.angular_velocity);
            let work = roll.impulse.dot(0.5 * (before + after) - roll.goal);
            (work, roll.impulse.abs().element_sum() / island.length)
        });
        adds_energy(of_points.chain(of_rolls), limits.tolerance)
    }

    /// Improves the impulses of an island by Newton's method, unless they leave a residual of at most `enough`, m/s. Returns true if they
    /// leave no more at the end.
    fn refine(&mut self, island: &Island, enough: f64, limits: Limits) -> bool {
        let mut equations = self.equations(island);
        let numbers = island.bodies.clone().filter(|&body| self.bodies[body].moves());
        let velocities =
            numbers.map(|body| [self.bodies[body].velocity, self.bodies[body].angular_velocity]).collect();
        let residual = equations.residual(&velocities);
        if residual <= enough {
            return true;
        }
        let left = equations.solve(limits.tolerance);
        let has_helped = left < MAX_NEWTON_REMAINDER * residual;
        self.pause.note(has_helped);
        if has_helped {
            let (of_points, of_rolls) = equations.impulses.split_at(3 * island.points.len());
            let (first, triples) = (island.points.start, of_points.as_chunks::<3>().0);
            let moments: Vec<DVec2> =
                of_rolls.as_chunks::<2>().0.iter().map(|moment| DVec2::from_array(*moment)).collect();
            let owners: Vec<usize> = self.rolls[island.rolls.clone()].iter().map(|roll| roll.point).collect();
            self.start(island, |point| {
                let roll = owners.iter().position(|owner| *owner == point);
                let moment = roll.map_or(DVec2::ZERO, |roll| moments[roll]);
                (DVec3::from_array(triples[point - first]), moment)
            });
        }
        left <= enough
    }

    /// Writes the equations of an island for Newton's method: three lines for each point, and two for each rolling friction.
    fn equations(&self, island: &Island) -> newton::Island {
        let mut equations = newton::Island::default();
        let mut number = vec![0; island.bodies.len()];
        for (at, body) in
            self.bodies[island.bodies.clone()].iter().enumerate().filter(|(_, body)| body.moves())
        {
            number[at] = equations.bodies.len();
            let turns = body.inverse_inertia.determinant() > 0.0;
            equations.bodies.push(Inert {
                mass: body.inverse_mass.recip(),
                inertia: if turns { body.inverse_inertia.inverse() } else { DMat3::IDENTITY },
                inverse_inertia: if turns { body.inverse_inertia } else { DMat3::ZERO },
                velocity: body.free[0],
                angular_velocity: body.free[1],
                size: body.size,
            });
        }
        let number = |body: u32| number[body as usize - island.bodies.start];
        for (at, (point, impulse)) in self.pushed(island).enumerate() {
            let disc = Bound::Disc { coefficient: point.friction(), normal: 3 * at };
            let bounds = [Bound::AtLeast(point.least), disc, Bound::Second];
            let weights = point.weights();
            for (row, (axis, bound)) in point.axes().into_iter().zip(bounds).enumerate() {
                let along = [-axis, axis].into_iter().zip(point.arms());
                let along = along.map(|(axis, arm)| [axis, arm.cross(axis)]);
                // Two rows of friction have the sum of their weights.
                let weight = if row == 0 { weights[0] } else { weights[1] + weights[2] };
                let line = (point.goal[row], bound, 1.0, weight);
                self.push_line(&mut equations, point, along, line, number);
            }
            equations.impulses.extend(impulse.to_array());
        }
        for roll in &self.rolls[island.rolls.clone()] {
            let point = &self.points[roll.point];
            let normal = 3 * (roll.point - island.points.start);
            let bounds = [Bound::Disc { coefficient: roll.coefficient(), normal }, Bound::Second];
            for (row, (axis, bound)) in point.axes()[1..].iter().zip(bounds).enumerate() {
                let along = [-*axis, *axis].into_iter().map(|axis| [DVec3::ZERO, axis]);
                let line = (roll.goal[row], bound, island.length.recip(), 2.0 * roll.weight());
                self.push_line(&mut equations, point, along, line, number);
            }
            equations.impulses.extend(roll.impulse.to_array());
        }
        equations
    }

    /// Appends a line to the equations. `along` holds, for each of its two bodies, the derivatives of the rate by the velocity and by the
    /// angular velocity.
    fn push_line(
        &self,
        equations: &mut newton::Island,
        point: &Point,
        along: impl Iterator<Item = [DVec3; 2]>,
        (goal, bound, unit, weight): (f64, Bound, f64, f64),
        number: impl Fn(u32) -> usize,
    ) {
        let (mut bias, first) = (0.0, equations.terms.len());
        for (body, [linear, angular]) in point.bodies.into_iter().zip(along) {
            let of = &self.bodies[body as usize];
            if of.moves() {
                let angular = if of.inverse_inertia == DMat3::ZERO { DVec3::ZERO } else { angular };
                equations.terms.push(Term { body: number(body), linear, angular });
            } else {
                bias += linear.dot(of.free[0]) + angular.dot(of.free[1]);
            }
        }
        let row = equations.lines.len();
        let terms = first..equations.terms.len();
        equations.lines.push(Line { row, terms, bias, goal, bound, unit, weight });
    }
}

/// Returns the impulses of points, then the moments of rolling frictions, in one list.
fn values_of<'a>(impulses: &'a [[f64; 3]], rolls: &[Roll], values: &'a mut Vec<f64>) -> &'a [f64] {
    if rolls.is_empty() {
        return impulses.as_flattened();
    }
    values.clear();
    values.extend_from_slice(impulses.as_flattened());
    values.extend(rolls.iter().flat_map(|roll| roll.impulse.to_array()));
    values
}

fn weights(points: &[Point], rolls: &[Roll]) -> Vec<f64> {
    let of_points = points.iter().flat_map(Point::weights);
    of_points.chain(rolls.iter().flat_map(|roll| [roll.weight(); 2])).collect()
}
