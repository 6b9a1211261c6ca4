//! Tests of charged bodies: Coulomb and Lorentz forces against closed forms.

use glam::DVec3;
use jabuka::physics::{Coulomb, Lorentz, METHODS, Method, World};

use crate::common::{ball, tolerance, worlds};

/// Checks two equal charges of 1 kg, released at the distance r₀ = 1. With the relative acceleration 2 k q² / r² = 2 / r², the energy
/// gives r'² = 4 (1 − 1/r). The distance s r₀ is reached at the time t = ½ (√(s (s − 1)) + ln(√s + √(s − 1))).
#[test]
fn two_equal_charges_fly_apart() {
    let (distance, steps) = (4.0_f64, 2000);
    let (root, less) = (distance.sqrt(), (distance - 1.0).sqrt());
    let time = 0.5 * (root * less + libm::log(root + less));
    for (method, mut world, one) in worlds(ball().with_charge(1e-3).with_location(0.5 * DVec3::X)) {
        let two = world.add(ball().with_charge(1e-3).with_location(-0.5 * DVec3::X));
        world.add_force(Coulomb { bodies: vec![one, two], against: None, constant: 1e6, softening: 0.0 });
        world.set_step(time / f64::from(steps));
        world.advance_to(time);
        let off = ((world.location(one) - world.location(two)).length() - distance).abs();
        // The rate √(2 · 2 k q² / r³) is 2 /s at the start, and falls.
        let allowed = distance * tolerance(method, 2.0 * time, steps);
        assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
    }
}

/// Returns the error and the drift after 1 s of a charge with q = m = 1 in B = 2 z and E = (0, 1, 0), from rest at the origin. It moves on
/// a clockwise circle with ω = q B / m = 2 that drifts with u = E × B / B² = (½, 0, 0). The path is a cycloid: x = u (t − sin ωt / ω), y =
/// u (1 − cos ωt) / ω.
fn cycloid(method: &'static Method, steps: u32) -> (f64, f64) {
    let mut world = World::new();
    world.set_integrator(method);
    let id = world.add(ball().with_charge(1.0));
    world.add_force(Lorentz { bodies: vec![id], electric: DVec3::Y, magnetic: 2.0 * DVec3::Z });
    world.set_step(1.0 / f64::from(steps));
    world.advance_to(1.0);
    let (sin, cos) = libm::sincos(2.0);
    let exact = DVec3::new(0.5 * (1.0 - 0.5 * sin), 0.25 * (1.0 - cos), 0.0);
    ((world.location(id) - exact).length(), world.balance().drift.abs())
}

/// Checks that error and energy drift fall with the order of the method. The tolerance of the slope is that of `order.rs`, where rates are
/// the same.
#[test]
fn a_charge_in_crossed_fields_drifts_across_both() {
    for method in METHODS {
        let (coarse, fine) = (cycloid(method, 128), cycloid(method, 256));
        let slope = libm::log2(coarse.0 / fine.0);
        assert!((slope - f64::from(method.order)).abs() < 0.1, "{}: order {slope}", method.name);
        let slope = libm::log2(coarse.1 / fine.1);
        // Yoshida's method applies the force at the mean velocity, so the magnetic force does exactly no work.
        let is_exact = coarse.1.max(fine.1) < 1e-13;
        assert!(is_exact || slope > f64::from(method.order) - 0.1, "{}: drift of order {slope}", method.name);
    }
}

/// Checks the radius m v / (q B) and the period 2π m / (q B) of a charge in a magnetic field: after half a period it is on the opposite
/// side, after a whole period at its start.
#[test]
fn a_charge_goes_round_in_a_cyclotron() {
    let (mass, charge, field, speed, steps) = (1.0, 0.5, 4.0, 3.0, 1000);
    let (radius, half) = (mass * speed / (charge * field), std::f64::consts::PI * mass / (charge * field));
    for (method, mut world, id) in worlds(ball().with_charge(charge).with_velocity(speed * DVec3::X)) {
        world.add_force(Lorentz { bodies: vec![id], electric: DVec3::ZERO, magnetic: field * DVec3::Z });
        world.set_step(half / f64::from(steps));
        for (turns, y) in [(1_u32, -2.0 * radius), (2, 0.0)] {
            world.advance_to(half * f64::from(turns));
            let angle = std::f64::consts::PI * f64::from(turns);
            let off = (world.location(id) - y * DVec3::Y).length();
            let allowed = 2.0 * radius * tolerance(method, angle, turns * steps);
            assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
        }
    }
}
