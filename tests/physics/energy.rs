//! Tests of the energy: how well the methods conserve it, and whether its accounts are right.

use glam::{DQuat, DVec3};
use jabuka::physics::{Anchor, Drag, METHODS, Method, RigidBody, Shape, Spring, World};

use crate::common::{air, ball, method, tether};

/// Returns a world with an oscillator with ω = 2 rad/s and E = 2 J at its turning point.
fn oscillator(method: &'static Method) -> World {
    let mut world = World::new();
    world.set_integrator(method);
    let id = world.add(ball().with_location(DVec3::X));
    world.add_force(tether(id, 4.0, 0.0));
    world
}

/// Returns the oscillator's largest energy drift in 10,000 steps of 0.01 s, which are 32 periods. Every step is observed.
fn largest_drift(method: &'static Method) -> f64 {
    let mut world = oscillator(method);
    // Drifts are relative to the largest kinetic energy so far. Skip more than one period, after which this is E within 2 %.
    let mut largest: f64 = 0.0;
    for step in 0..10_000 {
        world.step(0.01);
        let drift = world.balance().drift.abs();
        if step > 400 {
            largest = largest.max(drift);
        }
    }
    largest
}

/// Checks the bounds of the drift of symplectic methods. Each of them conserves a modified energy near the true energy H exactly (Hairer,
/// Lubich & Wanner, *Geometric Numerical Integration*, I.5 and IX.3). Let z = ωh = 0.02. Euler–Cromer conserves H − ½ h ω² x v, which
/// deviates from H by ½ z E at most; it does not deviate at the turning point where the run begins, so the bound is 0.01 E. Verlet
/// conserves H − ⅛ z² ω² x², so the bound is ¼ z² E = 1e-4 E. The 2 % below allow for the measured kinetic energy.
#[test]
fn symplectic_methods_have_bounded_drift() {
    for (name, bound) in [("euler-cromer", 0.01), ("velocity-verlet", 1e-4)] {
        let drift = largest_drift(method(name));
        // The drift must also reach the bound, which shows that it is really measured.
        assert!(drift < 1.02 * bound && drift > 0.98 * bound, "{name}: {drift:e}");
    }
}

/// Checks the bound of the drift of Yoshida's method for an oscillator. Half a drift, a kick and half a drift of length h together are the
/// matrix [1 − z²/2, h (1 − z²/4); −h ω², 1 − z²/2] for (x, v). Yoshida's step is a product of three such matrices, [a, b; c, a] with a² −
/// b c = 1, which conserves v² − (c/b) x² exactly. Starting at the turning point, where v = 0, the relative energy error at x = 0 is ω²
/// b/c + 1.
#[test]
fn yoshidas_method_has_bounded_drift() {
    let leap = |h: f64| {
        let z2 = 4.0 * h * h;
        [[1.0 - z2 / 2.0, h * (1.0 - z2 / 4.0)], [-4.0 * h, 1.0 - z2 / 2.0]]
    };
    let product = |a: [[f64; 2]; 2], b: [[f64; 2]; 2]| {
        [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
    };
    let outer = 0.01 / (2.0 - libm::cbrt(2.0));
    let step = product(leap(outer), product(leap(0.01 - 2.0 * outer), leap(outer)));
    let bound = (4.0 * step[0][1] / step[1][0] + 1.0).abs();
    assert!(bound > 1e-9 && bound < 1e-7, "{bound:e}");
    let drift = largest_drift(method("yoshida4"));
    assert!(drift < 1.02 * bound && drift > 0.98 * bound, "{drift:e} {bound:e}");
}

/// Checks that Yoshida's method accounts for the work of drag up to rounding. In a kick, the force times the mean of the velocities before
/// and after is exactly the change of the kinetic energy.
#[test]
fn yoshidas_method_books_the_work_of_drag_exactly() {
    let mut world = World::new();
    world.set_integrator(method("yoshida4"));
    let id = world.add(ball().with_velocity(DVec3::new(3.0, 4.0, 0.0)));
    world.add_force(Drag { quadratic: 0.3, ..air(id, 1.0) });
    world.set_step(0.05);
    world.advance_to(2.0);
    let balance = world.balance();
    assert!(balance.accounts.work < -10.0, "{}", balance.accounts.work);
    assert!(balance.drift.abs() < 1e-14, "{:e}", balance.drift);
}

/// Checks that each step of explicit Euler multiplies the energy of an oscillator by exactly 1 + ω² h², which is 54.5-fold after 10,000
/// steps. Rounding is 10,000 times 1e-16.
#[test]
fn explicit_euler_gains_energy() {
    let mut world = oscillator(method("explicit-euler"));
    for n in 1..=10_000 {
        world.step(0.01);
        if n % 1000 == 0 {
            let gain = libm::pow(1.0 + 4.0 * 0.01 * 0.01, f64::from(n));
            let total = world.balance().total / 2.0;
            assert!((total / gain - 1.0).abs() < 1e-11, "{total} {gain}");
        }
    }
}

/// Checks that each step of RK4 multiplies the energy of an oscillator by |R(iz)|² = 1 − z⁶/72 + z⁸/576 (Hairer & Wanner, *Solving
/// Ordinary Differential Equations II*, IV.2), a loss of 1e-8 in all. The formula is exact, so only rounding remains.
#[test]
fn rk4_loses_energy_slowly() {
    let mut world = oscillator(method("rk4"));
    let start = world.balance().total;
    for _ in 0..10_000 {
        world.step(0.01);
    }
    let z2 = 0.02 * 0.02;
    let loss = 10_000.0 * z2 * z2 * z2 / 72.0 * (1.0 - z2 / 8.0);
    let measured = 1.0 - world.balance().total / start;
    assert!((measured - loss).abs() < 1e-3 * loss, "{measured:e} {loss:e}");
}

/// Asserts that the drift falls with the order of the method, or faster, although forces without a potential do work. The tolerance of the
/// slope is that of `order.rs`. If the work were not accounted for, the drift would not fall at all. A method with exact accounts has a
/// drift of rounding only.
fn assert_drift_is_of_the_methods_order(build: impl Fn() -> World) {
    for method in METHODS {
        let run = |steps: u32| {
            let mut world = build();
            world.set_integrator(method);
            world.set_step(1.0 / f64::from(steps));
            world.advance_to(1.0);
            world.balance()
        };
        let (coarse, fine) = (run(128), run(256));
        assert!(fine.accounts.work.abs() > 0.5, "{}: {}", method.name, fine.accounts.work);
        let slope = libm::log2(coarse.drift / fine.drift);
        let is_exact = coarse.drift.abs().max(fine.drift.abs()) < 1e-13;
        assert!(
            is_exact || slope > f64::from(method.order) - 0.1,
            "{}: order {slope}, drifts {:e}, {:e}",
            method.name,
            coarse.drift,
            fine.drift
        );
    }
}

#[test]
fn the_work_of_drag_is_booked() {
    assert_drift_is_of_the_methods_order(|| {
        let mut world = World::new();
        let id = world.add(ball().with_velocity(DVec3::new(3.0, 4.0, 0.0)));
        let wind = DVec3::new(1.0, -1.0, 2.0);
        world.add_force(Drag { quadratic: 0.3, wind, ..air(id, 1.0) });
        world
    });
}

#[test]
fn the_work_of_a_torque_is_booked() {
    assert_drift_is_of_the_methods_order(|| {
        let mut world = World::new();
        let body = RigidBody::new(&Shape::Sphere { radius: 1.0 }, 1.0)
            .with_inertia(DVec3::new(1.0, 2.0, 3.0))
            .with_orientation(DQuat::from_rotation_x(1.0))
            .with_angular_velocity(DVec3::new(1.0, 1.5, -1.0))
            .with_torque(DVec3::new(1.0, -2.0, 3.0));
        world.add(body);
        world
    });
}

#[test]
fn the_work_of_a_damper_between_points_of_bodies_is_booked() {
    assert_drift_is_of_the_methods_order(|| {
        let mut world = World::new();
        let body = RigidBody::new(&Shape::Sphere { radius: 1.0 }, 1.0)
            .with_inertia(DVec3::new(1.0, 2.0, 3.0))
            .with_orientation(DQuat::from_rotation_x(1.0))
            .with_angular_velocity(DVec3::new(1.0, 1.5, -1.0));
        let ids = [0.0, 2.0].map(|x| world.add(body.with_location(x * DVec3::X)));
        let between = ids.map(|id| Anchor::Body { id, at: DVec3::new(0.5, 0.8, -0.3) });
        world.add_force(Spring { between, stiffness: 3.0, damping: 2.0, rest_length: 1.0 });
        world.add_force(Spring {
            between: [Anchor::Point(DVec3::new(0.0, 3.0, 1.0)), between[1]],
            stiffness: 3.0,
            damping: 2.0,
            rest_length: 1.0,
        });
        world
    });
}
