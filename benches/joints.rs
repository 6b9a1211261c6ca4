//! Measures the cost of constraints: a pendulum on a rod against a free body, and the growth of the time of a step with the links of a
//! chain.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark stops at the first surprise, and prints"
)]

use std::time::Instant;

use glam::DVec3;
use jabuka::physics::{Anchor, METHODS, Method, RigidBody, Rod, Shape, UniformGravity, World};

fn main() {
    println!("microseconds a step");
    for method in METHODS {
        let (free, held) = (chain(method, 1, false), chain(method, 1, true));
        let (free, held) = (time(free, 200_000), time(held, 200_000));
        let (short, long) = (time(chain(method, 100, true), 2_000), time(chain(method, 1000, true), 200));
        println!(
            "{:16} free body {free:.3}, on a rod {held:.3}, {:.2} ×; chain of 100 {short:.0}, of 1000 {long:.0}, {:.1} ×",
            method.name,
            held / free,
            long / short,
        );
    }
}

/// Returns a horizontal row of balls. If `is_held` is true, a rod holds each ball to the previous one, and the first ball to a fixed
/// point.
fn chain(method: &'static Method, links: u32, is_held: bool) -> World {
    let mut world = World::new();
    world.set_integrator(method);
    world.add_force(UniformGravity { acceleration: DVec3::NEG_Y });
    let mut last = Anchor::Point(DVec3::ZERO);
    for i in 1..=links {
        let ball = RigidBody::new(&Shape::Sphere { radius: 0.1 }, 1.0);
        let ball = Anchor::centre(world.add(ball.with_location(DVec3::X * f64::from(i))));
        if is_held {
            world.add_constraint(Rod { between: [last, ball], length: 1.0 });
        }
        last = ball;
    }
    world
}

/// Returns the time of a step in the fastest of five runs, µs.
fn time(mut world: World, steps: u32) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        (0..steps / 5).for_each(|_| world.step(1e-4));
        best = best.min(start.elapsed().as_secs_f64() * 1e6 / f64::from(steps / 5));
    }
    best
}
