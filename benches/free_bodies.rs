//! Compares a step of every integration method, for 100,000 free bodies in uniform gravity, with a plain loop over the same numbers.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark stops at the first surprise, and prints"
)]

use std::hint::black_box;
use std::time::Instant;

use glam::DVec3;
use jabuka::physics::{METHODS, RigidBody, Shape, UniformGravity, World};

const BODIES: usize = 100_000;
const STEPS: u32 = 100;
const DT: f64 = 1e-3;
const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);

fn main() {
    let plain = plain_loop();
    println!("{BODIES} free bodies, {STEPS} steps, nanoseconds a body and step");
    println!("plain loop        {plain:6.2}");
    for method in METHODS {
        let mut world = World::new();
        world.set_integrator(method);
        for i in 0..BODIES {
            let body = RigidBody::new(&Shape::Sphere { radius: 0.1 }, 1.0);
            world.add(body.with_location(DVec3::splat(i as f64)));
        }
        world.add_force(UniformGravity { acceleration: GRAVITY });
        world.step(DT);
        let time = per_body_and_step(|| (0..STEPS).for_each(|_| world.step(DT)));
        println!("{:16}  {time:6.2}   {:.1} × plain", method.name, time / plain);
    }
}

/// Returns the time of a plain loop by hand: steps of Euler–Cromer for mass points.
fn plain_loop() -> f64 {
    let mut velocity = vec![DVec3::ZERO; BODIES];
    let mut location: Vec<DVec3> = (0..BODIES).map(|i| DVec3::splat(i as f64)).collect();
    let step = |location: &mut [DVec3], velocity: &mut [DVec3]| {
        for (location, velocity) in location.iter_mut().zip(velocity) {
            *velocity += GRAVITY * DT;
            *location += *velocity * DT;
        }
    };
    step(&mut location, &mut velocity);
    per_body_and_step(|| (0..STEPS).for_each(|_| step(black_box(&mut location), black_box(&mut velocity))))
}

fn per_body_and_step(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64() * 1e9 / f64::from(STEPS) / BODIES as f64
}
