//! Measures a planet on an orbit of eccentricity 0.9 for a hundred orbits: the errors of its energy and its position at the end, and the
//! time that the run takes.
//!
//! The errors of a single run come from rounding, so they are random. Therefore the benchmark makes twenty runs, each with a differently
//! rotated orbit, and prints the root mean square of their errors. `benches/peers/kepler.py` does the same with another program.
//!
//! `cargo bench --bench kepler [METHOD TOLERANCE]`

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark stops at the first surprise, and prints"
)]

mod processor;

use glam::{DQuat, DVec3};
use jabuka::physics::{Accuracy, BodyId, Dynamics, Gravitation, Method, RigidBody, Shape, World};

const ECCENTRICITY: f64 = 0.9;
const ORBITS: f64 = 100.0;
const COPIES: u32 = 20;
/// The number of repetitions of each run. The fastest one counts.
const REPEATS: u32 = 5;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    println!(
        "{COPIES} copies, root mean square: error of the energy, of the place; CPU milliseconds a run, steps"
    );
    if let [name, tolerance] = arguments.as_slice() {
        return measure(name, tolerance.parse().unwrap());
    }
    for (name, tolerance) in [("gauss-radau", 1e-9), ("dop853", 1e-9), ("dop853", 1e-12)] {
        measure(name, tolerance);
    }
}

fn measure(name: &str, tolerance: f64) {
    let Some(method) = Method::by_name(name) else { return println!("{name}: no such method") };
    let (mut energy, mut place, mut time, mut steps) = (0.0, 0.0, 0.0, 0);
    for copy in 0..COPIES {
        let mut quickest = f64::INFINITY;
        let mut errors = (0.0, 0.0);
        for _ in 0..REPEATS {
            let (start, mut run) = begin(method, tolerance, turn(copy));
            let before = processor::seconds();
            run.advance(ORBITS * std::f64::consts::TAU, &[], &mut |_| {}).unwrap();
            quickest = quickest.min(processor::seconds() - before);
            steps = run.steps();
            let end = run.snapshot().unwrap().bodies;
            let (at, velocity) = (end[1].location - end[0].location, end[1].velocity - end[0].velocity);
            let now = 0.5 * velocity.length_squared() - 1.0 / at.length();
            errors = ((now + 0.5) / 0.5, (at - start).length());
        }
        energy += errors.0 * errors.0;
        place += errors.1 * errors.1;
        time += quickest;
    }
    let copies = f64::from(COPIES);
    let (energy, place) = (f64::sqrt(energy / copies), f64::sqrt(place / copies));
    println!("{name:12} {tolerance:5.0e}  {energy:.2e}  {place:.2e}  {:7.2}  {steps}", time / copies * 1e3);
}

/// Returns the rotation of the orbit in run `copy`.
fn turn(copy: u32) -> DQuat {
    let part = |root: f64| (f64::from(copy + 1) * root.sqrt()).fract() - 0.5;
    DQuat::from_xyzw(part(2.0), part(3.0), part(5.0), part(7.0)).normalize()
}

/// Prepares a run with the planet at its perihelion, and returns its location (m) as well. The mass of the planet is negligible.
fn begin(method: &'static Method, tolerance: f64, turn: DQuat) -> (DVec3, Box<dyn Dynamics>) {
    let mut world = World::new();
    world.set_integrator(method);
    let sphere = Shape::Sphere { radius: 0.01 };
    let at = turn * DVec3::new(1.0 - ECCENTRICITY, 0.0, 0.0);
    let velocity = turn * DVec3::new(0.0, ((1.0 + ECCENTRICITY) / (1.0 - ECCENTRICITY)).sqrt(), 0.0);
    world.add(RigidBody::new(&sphere, 1.0));
    world.add(RigidBody::new(&sphere, 1e-20).with_location(at).with_velocity(velocity));
    let bodies = vec![BodyId::new(0), BodyId::new(1)];
    world.add_force(Gravitation {
        bodies,
        against: None,
        constant: 1.0,
        softening: 0.0,
        opening_angle: None,
    });
    let end = ORBITS * std::f64::consts::TAU;
    (at, method.take_over.unwrap()(world, Accuracy { tolerance, end }))
}
