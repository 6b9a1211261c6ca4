//! Measures the orders of all methods: errors over the number of steps, and over the number of force evaluations.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DQuat, DVec3};
use jabuka::physics::{
    Accuracy, BodyId, Dynamics, Force, Gravitation, Loads, Method, Moment, RigidBody, Shape, State,
    UniformGravity, World,
};

use crate::common::{air, ball, distance, method, tether};

/// A force that has no effect and counts its evaluations.
#[derive(Clone, Default)]
pub(crate) struct Counter(Arc<AtomicU64>);

impl Counter {
    pub(crate) fn count(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

impl Force for Counter {
    fn apply(&self, _: &Moment, _: &mut Loads) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    fn potential(&self, _: &Moment) -> f64 {
        0.0
    }

    fn depends_on_motion(&self) -> bool {
        false
    }

    fn turns_bodies(&self) -> bool {
        false
    }
}

/// A problem that is solved with steps of equal length.
pub(crate) struct Problem {
    pub(crate) name: &'static str,
    pub(crate) meaning: &'static str,
    /// The durations of the problem, s: for methods up to order 8, and for methods of higher order. The errors of the latter are visible
    /// only with long steps.
    durations: [f64; 2],
    build: fn() -> World,
    /// Replaces a world's state by the exact solution at the given time.
    exact: fn(f64, &mut State),
    /// Returns the difference between two states as one number.
    off: fn(&State, &State) -> f64,
    /// True if the problem is one of planets that move around a heavy body.
    pub(crate) is_planetary: bool,
}

/// The result of a method on a problem with one number of steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    pub(crate) steps: u32,
    pub(crate) evaluations: u64,
    pub(crate) error: f64,
}

pub(crate) const PROBLEMS: &[Problem] = &[
    Problem {
        name: "oscillator",
        meaning: "x″ = −4 x in two dimensions, 1 s (`gauss-radau`: 4 s); exact: cos 2t, sin 2t",
        durations: [1.0, 4.0],
        build: oscillator,
        exact: |t, state| {
            let (sin, cos) = libm::sincos(2.0 * t);
            state.location[0] = DVec3::new(cos, sin / 2.0, 0.0);
            state.velocity[0] = DVec3::new(-2.0 * sin, cos, 0.0);
        },
        off: distance,
        is_planetary: false,
    },
    Problem {
        name: "drag",
        meaning: "x″ = g − 2 x′ in two dimensions with the work of the drag, 1 s (`gauss-radau`: 4 s); exact: e^(−2t)",
        durations: [1.0, 4.0],
        build: drag,
        exact: |t, state| {
            let decay = libm::exp(-2.0 * t);
            let (terminal, start) = (DVec3::NEG_Y, DVec3::X);
            state.velocity[0] = terminal + (start - terminal) * decay;
            state.location[0] = t * terminal + (start - terminal) * (1.0 - decay) / 2.0;
            state.accounts.work = -2.0 * (t - (1.0 - decay) + (1.0 - decay * decay) / 2.0);
        },
        off: distance,
        is_planetary: false,
    },
    Problem {
        name: "rotation",
        meaning: "a body with moments 1, 2, 3 that turns under a constant torque, 1 s (`gauss-radau`: 2 s); no closed form: \
                  compared with `gauss-radau` with 64 steps, to which `dop853` converges at its own order",
        durations: [1.0, 2.0],
        build: rotation,
        exact: |t, state| *state = finest(rotation(), t, 64),
        off: distance,
        is_planetary: false,
    },
    Problem {
        name: "Kepler",
        meaning: "a star and a planet of a thousandth of its mass, e = 0.1, 0.7 of an orbit; exact: Kepler's equation",
        durations: [0.7 * ORBIT; 2],
        build: kepler,
        exact: |t, state| {
            // Solve Kepler's equation E − e sin E = 2π t / T by Newton's method.
            let (e, mean) = (0.1_f64, std::f64::consts::TAU * t / ORBIT);
            let mut anomaly = mean;
            for _ in 0..30 {
                anomaly -= (anomaly - e * libm::sin(anomaly) - mean) / (1.0 - e * libm::cos(anomaly));
            }
            let ((sin, cos), minor) = (libm::sincos(anomaly), (1.0 - e * e).sqrt());
            let speed = std::f64::consts::TAU / ORBIT / (1.0 - e * cos);
            state.location = vec![DVec3::ZERO, DVec3::new(cos - e, minor * sin, 0.0)];
            state.velocity = vec![DVec3::ZERO, speed * DVec3::new(-sin, minor * cos, 0.0)];
        },
        off: |a, b| {
            let seen = |state: &State| {
                (state.location[1] - state.location[0], state.velocity[1] - state.velocity[0])
            };
            let ((x, v), (y, w)) = (seen(a), seen(b));
            (x - y).length().max((v - w).length())
        },
        is_planetary: true,
    },
    Problem {
        name: "planets",
        meaning: "a star and two planets of a hundredth of its mass, 20 s; compared with `gauss-radau` with 2,000 steps",
        durations: [20.0; 2],
        build: planets,
        exact: |t, state| *state = finest(planets(), t, 2000),
        off: |a, b| {
            let all = a.location.iter().zip(&b.location);
            all.map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max)
        },
        is_planetary: true,
    },
];

/// The period of the orbit, s: 2π / √1.001.
const ORBIT: f64 = 6.280_046_068_758_707;

fn oscillator() -> World {
    let mut world = World::new();
    world.add(ball().with_location(DVec3::X).with_velocity(DVec3::Y));
    world.add_force(tether(BodyId::new(0), 4.0, 0.0));
    world
}

fn drag() -> World {
    let mut world = World::new();
    world.add(ball().with_velocity(DVec3::X));
    world.add_force(UniformGravity { acceleration: DVec3::new(0.0, -2.0, 0.0) });
    world.add_force(air(BodyId::new(0), 2.0));
    world
}

fn rotation() -> World {
    let body = RigidBody::new(&Shape::Sphere { radius: 1.0 }, 1.0)
        .with_inertia(DVec3::new(1.0, 2.0, 3.0))
        .with_orientation(DQuat::from_rotation_x(1.0))
        .with_angular_velocity(DVec3::new(1.0, 1.5, -1.0))
        .with_torque(DVec3::new(1.0, -2.0, 3.0));
    let mut world = World::new();
    world.add(body);
    world
}

fn attract(world: &mut World) {
    let bodies = (0..world.len()).map(BodyId::new).collect();
    world.add_force(Gravitation {
        bodies,
        against: None,
        constant: 1.0,
        softening: 0.0,
        opening_angle: None,
    });
}

fn point(mass: f64) -> RigidBody {
    RigidBody::new(&Shape::Sphere { radius: 0.01 }, mass)
}

fn kepler() -> World {
    let mut world = World::new();
    let (e, mass) = (0.1_f64, 1e-3);
    let speed = ((1.0 + mass) * (1.0 + e) / (1.0 - e)).sqrt();
    let part = mass / (1.0 + mass);
    world.add(point(1.0).with_velocity(DVec3::NEG_Y * speed * part));
    let planet = point(mass).with_location(DVec3::X * (1.0 - e));
    world.add(planet.with_velocity(DVec3::Y * speed * (1.0 - part)));
    attract(&mut world);
    world
}

fn planets() -> World {
    let mut world = World::new();
    world.add(point(1.0));
    world.add(point(0.01).with_location(DVec3::X).with_velocity(DVec3::new(0.1, 0.95, 0.1)));
    world.add(point(0.01).with_location(DVec3::Y * -2.5).with_velocity(DVec3::new(0.6, 0.1, 0.0)));
    attract(&mut world);
    world
}

fn finest(world: World, end: f64, steps: u32) -> State {
    advanced(world, method("gauss-radau"), end, steps)
}

fn advanced(mut world: World, method: &'static Method, end: f64, steps: u32) -> State {
    world.set_integrator(method);
    world.set_step(end / f64::from(steps));
    world.advance_to(end);
    world.state().clone()
}

impl Problem {
    /// Returns the errors of a method for a series of decreasing steps.
    pub(crate) fn solve(&self, method: &'static Method) -> Vec<Point> {
        let end = self.durations[usize::from(method.order > 8)];
        let mut exact = (self.build)().state().clone();
        (self.exact)(end, &mut exact);
        let finer = if self.is_planetary { 4 } else { 1 };
        let finest = if self.is_planetary && method.order == 1 { 8 } else { 1 };
        let steps: Vec<u32> = match method.order {
            1 | 2 => (6..12).map(|k| (finer * finest) << k).collect(),
            3..=4 => (4..10).map(|k| finer << k).collect(),
            5..=8 => [4, 6, 8, 12, 16, 24, 32].map(|steps| finer * steps).to_vec(),
            _ if self.name == "planets" => vec![14, 16, 18, 20, 22, 24, 28, 32],
            _ if self.name == "drag" => vec![12, 14, 16, 20, 24, 28],
            _ => vec![3, 4, 5, 6, 8, 10],
        };
        let solve = |steps| {
            let counter = Counter::default();
            let mut world = (self.build)();
            world.add_force(counter.clone());
            let state = if method.is_planetary() {
                by_ahead(world, method, end, steps)
            } else {
                advanced(world, method, end, steps)
            };
            Point { steps, evaluations: counter.count(), error: (self.off)(&state, &exact) }
        };
        steps.into_iter().map(solve).collect()
    }
}

/// Solves a problem with the method for planets, which takes all its steps in a row. Its symplectic corrector is applied before the first
/// step and after the last. Returns the final state.
fn by_ahead(mut world: World, method: &'static Method, end: f64, steps: u32) -> State {
    let mut state = world.state().clone();
    world.set_integrator(method);
    world.set_step(end / f64::from(steps));
    if let Some(ahead) = method.take_over {
        let mut run: Box<dyn Dynamics> = ahead(world, Accuracy { tolerance: 0.0, end });
        if run.advance(end, &[], &mut |_| {}).is_ok()
            && let Ok(snapshot) = run.snapshot()
        {
            state.location = snapshot.bodies.iter().map(|body| body.location).collect();
            state.velocity = snapshot.bodies.iter().map(|body| body.velocity).collect();
        }
    }
    state
}

/// Returns the measured order: the slope of the errors' logarithms over those of the steps, by least squares. It uses the errors of the
/// shortest steps that are above rounding. `None` if fewer than two errors are above rounding.
pub(crate) fn order(points: &[Point]) -> Option<f64> {
    // Rotations have the largest rounding errors.
    const ROUNDING: f64 = 4e-14;
    let seen: Vec<_> = points.iter().filter(|point| point.error > ROUNDING && point.error < 0.2).collect();
    let last = &seen[seen.len().saturating_sub(4)..];
    if last.len() < 2 {
        return None;
    }
    let of = |point: &&Point| (libm::log(f64::from(point.steps)), libm::log(point.error));
    let count = last.len() as f64;
    let (x, y) = last.iter().map(of).fold((0.0, 0.0), |sum, (x, y)| (sum.0 + x / count, sum.1 + y / count));
    let (above, below) = last
        .iter()
        .map(of)
        .fold((0.0, 0.0), |sum, (a, b)| (sum.0 + (a - x) * (b - y), sum.1 + (a - x) * (a - x)));
    Some(-above / below)
}

/// Returns the order that a method must show on a problem: that of its table, minus 0.2. The Gauss–Radau method reaches rounding so early
/// that only 13 is required. On an ellipse nothing is required of this method and of `dop853`, because the sign of their errors depends on
/// the step, and nothing of the method for planets, which is exact there.
pub(crate) fn required(problem: &Problem, method: &Method) -> Option<f64> {
    match (problem.name, method.order) {
        ("Kepler", 5..) => None,
        ("Kepler", _) if method.is_planetary() => None,
        // A first-order method leaves the orbits unless its steps are shorter than those used here.
        ("planets", 1) => None,
        // Between two steps, the order rises from 7.4 to 7.8 before the errors reach rounding.
        ("rotation", 8) => Some(7.6),
        (_, 9..) => Some(13.0),
        (_, order) => Some(f64::from(order) - 0.2),
    }
}
