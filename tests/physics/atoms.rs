//! Tests of the Lennard-Jones force against closed forms and conservation laws.

use glam::DVec3;
use jabuka::physics::{BodyId, LennardJones, METHODS, RigidBody, Shape, World};

use crate::common::{ball, tolerance, worlds};

fn force(count: usize, smooth: bool) -> LennardJones {
    let bodies = (0..count).map(BodyId::new).collect();
    LennardJones { bodies, against: None, epsilon: 2.0, sigma: 0.5, cutoff: 1.25, smooth }
}

/// Checks the oscillation of two atoms about the distance 2^(1/6) σ of lowest potential, where u″ = 72 ε / (2^(1/3) σ²). With m = 1 each,
/// ω² = 2 u″. For an amplitude a, the period has a relative error of the order 10 (a/σ)², here 1e-7.
#[test]
fn two_atoms_swing_about_the_lowest_place() {
    let lowest = 0.5 * libm::pow(2.0, 1.0 / 6.0);
    let rate = (2.0 * 72.0 * 2.0 / (libm::cbrt(2.0) * 0.25)).sqrt();
    let (period, steps, amplitude) = (std::f64::consts::TAU / rate, 2000, 5e-5);
    for (method, mut world, _) in worlds(ball().with_location(DVec3::ZERO)) {
        world.add(ball().with_location((lowest + amplitude) * DVec3::X));
        world.add_force(force(2, false));
        world.set_step(period / f64::from(steps));
        // After a quarter of a period the atoms are at the distance of lowest potential, and at their highest speed.
        world.advance_to(0.25 * period);
        let distance = (world.state().location[1] - world.state().location[0]).length();
        let allowed = amplitude * (tolerance(method, std::f64::consts::TAU, steps) + 1e-3);
        assert!((distance - lowest).abs() < allowed, "{}: {:e}", method.name, distance - lowest);
    }
}

/// Returns a world with 64 atoms in a cluster, so warm that some escape.
#[allow(clippy::unwrap_used, reason = "it is part of tests")]
fn lump(method: &'static jabuka::physics::Method, step: f64, smooth: bool) -> World {
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

/// Checks that the cluster's momentum is conserved and its energy hardly drifts. With a shifted force, the drift has the order of the
/// method. With a shifted potential alone, each crossing of the cutoff costs a symplectic method an error of the order of the step, since
/// the force jumps by 0.039 ε/σ.
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
            // Locations change within a step of an Euler method, so an error in momentum appears as a torque.
            assert!(method.order == 1 || off < 1e-6, "{}: {off:e}", method.name);
            after.drift.abs()
        };
        let [smooth, sharp] = [true, false].map(|smooth| drift(0.001, smooth));
        // Explicit Euler heats the cluster until it flies apart, so its drift has no bound.
        let allowed = if method.order == 1 { 0.1 } else { 1e-3 };
        let allowed = if method.name == "explicit-euler" { f64::INFINITY } else { allowed };
        assert!(smooth < allowed && sharp < allowed, "{}: {smooth:e} {sharp:e}", method.name);
    }
}
