//! The Lennard-Jones force.

use glam::DVec3;
use jabuka::dynamics::{BodyId, LennardJones, METHODS, RigidBody, Shape, World};

use crate::common::{ball, tolerance, worlds};

fn force(count: usize, smooth: bool) -> LennardJones {
    let bodies = (0..count).map(BodyId::new).collect();
    LennardJones { bodies, against: None, epsilon: 2.0, sigma: 0.5, cutoff: 1.25, smooth }
}

/// Two atoms swing about the distance 2^(1/6) σ, where u″ = 72 ε / (2^(1/3) σ²): with m = 1 each, ω² = 2 u″. With an amplitude a, the
/// period is off by a part of the order (a/σ)² · 10, here 1e-7.
#[test]
fn two_atoms_swing_about_the_lowest_place() {
    let lowest = 0.5 * libm::pow(2.0, 1.0 / 6.0);
    let rate = (2.0 * 72.0 * 2.0 / (libm::cbrt(2.0) * 0.25)).sqrt();
    let (period, steps, amplitude) = (std::f64::consts::TAU / rate, 2000, 5e-5);
    for (method, mut world, _) in worlds(ball().with_location(DVec3::ZERO)) {
        world.add(ball().with_location((lowest + amplitude) * DVec3::X));
        world.add_force(force(2, false));
        world.set_step(period / f64::from(steps));
        // A quarter of a period: at the lowest place, with the largest velocity.
        world.advance_to(0.25 * period);
        let distance = (world.state().location[1] - world.state().location[0]).length();
        let allowed = amplitude * (tolerance(method, std::f64::consts::TAU, steps) + 1e-3);
        assert!((distance - lowest).abs() < allowed, "{}: {:e}", method.name, distance - lowest);
    }
}

/// A lump of 64 atoms, warm enough to lose some.
#[allow(clippy::unwrap_used, reason = "it is part of tests")]
fn lump(method: &'static jabuka::dynamics::Method, step: f64, smooth: bool) -> World {
    let mut world = World::new();
    world.set_integrator(method);
    world.set_step(step);
    let part = |i: usize, k: f64| 2.0 * (i as f64 * k).fract() - 1.0;
    for i in 0..64 {
        let place = DVec3::new((i % 4) as f64, (i / 4 % 4) as f64, (i / 16) as f64);
        let velocity = DVec3::new(part(i, 0.618_033), part(i, 0.414_213), part(i, 0.732_050));
        let atom = RigidBody::new(&Shape::Sphere { radius: 0.25 }, 1.0);
        world.add(atom.with_location(0.58 * place).with_velocity(2.0 * velocity));
    }
    world.add_force(force(64, smooth));
    world
}

/// What one atom gets the other loses. With the force shifted, the drift has the order of the method; with the potential alone, each crossing of the
/// cutoff costs a symplectic method an error of the order of the step in a force of 0.039 ε/σ.
#[test]
fn momentum_and_energy_of_a_lump() {
    for method in METHODS {
        let drift = |step: f64, smooth: bool| {
            let mut world = lump(method, step, smooth);
            let before = world.balance();
            world.advance_to(1.0);
            let after = world.balance();
            let off = (after.linear_momentum - before.linear_momentum).length();
            assert!(off < 1e-11, "{}: {off:e}", method.name);
            let off = (after.angular_momentum - before.angular_momentum).length();
            // Places change within a step of Euler's, which turns what it does to momentum into a torque.
            assert!(method.order == 1 || off < 1e-6, "{}: {off:e}", method.name);
            after.drift.abs()
        };
        let [smooth, sharp] = [true, false].map(|smooth| drift(0.001, smooth));
        // Explicit Euler heats the lump until it bursts.
        let allowed = if method.order == 1 { 0.1 } else { 1e-3 };
        let allowed = if method.name == "explicit-euler" { f64::INFINITY } else { allowed };
        assert!(smooth < allowed && sharp < allowed, "{}: {smooth:e} {sharp:e}", method.name);
    }
}
