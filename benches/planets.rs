//! Measures the Sun and ten planets for a thousand years: the errors of the energy and of Mercury's position at the end, and the processor
//! time of the run.
//!
//! The reference for the position of Mercury is `gauss-radau` with a hundredth of its tolerance. `benches/peers/planets.py` does the same
//! with another program.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark stops at the first surprise, and prints"
)]

mod processor;

use glam::DVec3;
use jabuka::physics::{Accuracy, BodyId, Dynamics, Gravitation, Method, RigidBody, Shape, Snapshot, World};

const YEARS: f64 = 1000.0;
const STEP: f64 = 0.01;
/// The semi-major axis of each planet's orbit, AU; its eccentricity; the planet's mass in solar masses.
const PLANETS: [[f64; 3]; 10] = [
    [0.387_098, 0.205_63, 1.66e-7],
    [0.723_332, 0.006_77, 2.448e-6],
    [1.0, 0.016_71, 3.003e-6],
    [1.523_68, 0.093_4, 3.227e-7],
    [2.767, 0.075_8, 4.7e-10],
    [5.204_4, 0.048_9, 9.548e-4],
    [9.582_6, 0.056_5, 2.859e-4],
    [19.218_4, 0.046_38, 4.366e-5],
    [30.110_39, 0.009_46, 5.151e-5],
    [39.482, 0.248_8, 6.55e-9],
];

fn main() {
    println!("{YEARS} years: error of the energy, of Mercury's place (AU); CPU seconds, steps");
    let reference = run("gauss-radau", 1e-11).0;
    for (name, tolerance) in [("wisdom-holman", 1e-9), ("gauss-radau", 1e-9), ("dop853", 1e-12)] {
        if Method::by_name(name).is_none() {
            continue;
        }
        let (end, took, steps) = run(name, tolerance);
        let seen = |snapshot: &Snapshot| snapshot.bodies[1].location - snapshot.bodies[0].location;
        let off = (seen(&end) - seen(&reference)).length();
        println!("{name:13}  {:.1e}  {off:.1e}  {took:.2}  {steps}", end.balance.drift);
    }
}

fn run(name: &str, tolerance: f64) -> (Snapshot, f64, u64) {
    let mut run = begin(Method::by_name(name).unwrap(), tolerance);
    let before = processor::seconds();
    run.advance(YEARS, &[], &mut |_| {}).unwrap();
    let took = processor::seconds() - before;
    (run.snapshot().unwrap(), took, run.steps())
}

/// Prepares a run with all planets at their perihelia. The perihelia lie in different directions, and the orbits are inclined by up to a
/// few degrees.
fn begin(method: &'static Method, tolerance: f64) -> Box<dyn Dynamics> {
    let mut world = World::new();
    world.set_integrator(method);
    world.set_step(STEP);
    let constant = 4.0 * std::f64::consts::PI * std::f64::consts::PI;
    let shape = Shape::Sphere { radius: 1e-4 };
    let mut bodies = vec![RigidBody::new(&shape, 1.0)];
    for (k, [axis, eccentricity, mass]) in PLANETS.into_iter().enumerate() {
        let (sin, cos) = libm::sincos(2.4 * k as f64);
        let (tilt, upright) = libm::sincos(0.02 * (k % 4) as f64);
        let speed = (constant / axis * (1.0 + eccentricity) / (1.0 - eccentricity)).sqrt();
        let at = axis * (1.0 - eccentricity) * DVec3::new(cos, sin * upright, sin * tilt);
        let velocity = speed * DVec3::new(-sin, cos * upright, cos * tilt);
        bodies.push(RigidBody::new(&shape, mass).with_location(at).with_velocity(velocity));
    }
    // The common centre of mass is brought to rest.
    let mass: f64 = bodies.iter().map(|body| body.mass).sum();
    let at = bodies.iter().map(|body| body.mass * body.location).sum::<DVec3>() / mass;
    let motion = bodies.iter().map(|body| body.mass * body.velocity).sum::<DVec3>() / mass;
    for body in &bodies {
        world.add(body.with_location(body.location - at).with_velocity(body.velocity - motion));
    }
    let bodies = (0..bodies.len()).map(BodyId::new).collect();
    world.add_force(Gravitation { bodies, against: None, constant, softening: 0.0, opening_angle: None });
    method.take_over.unwrap()(world, Accuracy { tolerance, end: YEARS })
}
