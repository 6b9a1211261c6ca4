//! Tests of orbits under Newton's law of gravitation.

use glam::DVec3;
use jabuka::physics::{Gravitation, METHODS, Method, RigidBody, Shape, State, World};

use crate::common::method;

/// Returns a world with small bodies of the given masses, locations and velocities that attract each other with G = 1.
fn attracting(method: &'static Method, bodies: &[(f64, DVec3, DVec3)]) -> World {
    let mut world = World::new();
    world.set_integrator(method);
    let add = |&(mass, location, velocity): &(f64, DVec3, DVec3)| {
        let body = RigidBody::new(&Shape::Sphere { radius: 0.01 }, mass);
        world.add(body.with_location(location).with_velocity(velocity))
    };
    let bodies = bodies.iter().map(add).collect();
    world.add_force(Gravitation {
        bodies,
        against: None,
        constant: 1.0,
        softening: 0.0,
        opening_angle: None,
    });
    world
}

fn vector([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x, y, 0.0)
}

/// Returns the solution of Kepler's equation E − e sin E = M, by Newton's method.
fn eccentric_anomaly(mean: f64, eccentricity: f64) -> f64 {
    let mut anomaly = mean;
    for _ in 0..20 {
        let (sin, cos) = libm::sincos(anomaly);
        anomaly -= (anomaly - eccentricity * sin - mean) / (1.0 - eccentricity * cos);
    }
    anomaly
}

/// Simulates two bodies of masses ¼ and ¾ on ellipses with a = 1 and e = 0.3 about their common center, from the perihelion, for 1 s. The
/// mean motion is √(G M / a³) = 1 rad/s.
fn two_bodies(method: &'static Method, steps: u32) -> World {
    let speed = f64::sqrt(1.3 / 0.7);
    let (at, velocity) = (0.7 * DVec3::X, speed * DVec3::Y);
    let mut world =
        attracting(method, &[(0.25, 0.75 * at, 0.75 * velocity), (0.75, -0.25 * at, -0.25 * velocity)]);
    world.set_step(1.0 / f64::from(steps));
    world.advance_to(1.0);
    world
}

/// Asserts that the error falls with the order of the method. The tolerance of the slope is that of `order.rs`, since rates are at most
/// √(G M / 0.7³) = 1.7 /s.
fn assert_order(method: &Method, coarse: f64, fine: f64) {
    let slope = libm::log2(coarse / fine);
    assert!(
        (slope - f64::from(method.order)).abs() < 0.1,
        "{}: order {slope}, {coarse:e}, {fine:e}",
        method.name
    );
}

#[test]
fn two_bodies_go_round_as_kepler_says() {
    let anomaly = eccentric_anomaly(1.0, 0.3);
    let (sin, cos) = libm::sincos(anomaly);
    let exact = DVec3::new(cos - 0.3, f64::sqrt(1.0 - 0.09) * sin, 0.0);
    for method in METHODS {
        let off = |steps| {
            let state: State = two_bodies(method, steps).state().clone();
            assert!(
                (0.25 * state.location[0] + 0.75 * state.location[1]).length() < 1e-13,
                "the centre stays"
            );
            (state.location[0] - state.location[1] - exact).length()
        };
        assert_order(method, off(256), off(512));
    }
}

/// Checks that the drift falls with the order of the method, so that the potential belongs to the force.
#[test]
fn the_drift_of_an_orbit_is_of_the_methods_order() {
    for method in METHODS {
        let drift = |steps| two_bodies(method, steps).balance().drift.abs();
        assert_order(method, drift(256), drift(512));
    }
}

/// Checks that three bodies on a figure-eight orbit return to their start after a period. Source: A. Chenciner & R. Montgomery, Ann. Math.
/// 152 (2000) 881.
///
/// The published start and period have eight decimals, which limits each coordinate's error to 3e-8 (one digit). The error of RK4 in
/// 20,000 steps of rate × dt = 2 · 3e-4 is about 13 · (6e-4)⁴ = 2e-12.
#[test]
fn three_bodies_on_a_figure_of_eight_return() {
    let (at, velocity) = (vector([0.970_004_36, -0.243_087_53]), vector([0.466_203_685, 0.432_365_73]));
    let bodies = [(1.0, at, velocity), (1.0, -at, velocity), (1.0, DVec3::ZERO, -2.0 * velocity)];
    let mut world = attracting(method("rk4"), &bodies);
    assert!((world.balance().total + 1.287_141_991_766_33).abs() < 1e-14);
    let period = 6.325_913_98;
    world.set_step(period / 20_000.0);
    world.advance_to(period);
    for (now, (_, start, _)) in world.state().location.iter().zip(bodies) {
        let off = (*now - start).abs().max_element();
        assert!(off < 3.5e-8, "{off:e}");
    }
    assert!(world.balance().drift.abs() < 1e-11);
}

/// Checks seven masses in a plane, with close encounters, up to t = 3. Source: IVP Test Set, problem PLEI; Hairer, Nørsett & Wanner,
/// *Solving Ordinary Differential Equations I*, II.10.
///
/// No bound is known beforehand, but the error falls with the fourth power of the step, down to 1e-7.
#[test]
#[allow(clippy::excessive_precision, reason = "as they are published")]
fn the_pleiades() {
    let x = [3.0, 3.0, -1.0, -3.0, 2.0, -2.0, 2.0];
    let y = [3.0, -3.0, 2.0, 0.0, 0.0, -4.0, 4.0];
    let u = [0.0, 0.0, 0.0, 0.0, 0.0, 1.75, -1.5];
    let v = [0.0, 0.0, 0.0, -1.25, 1.0, 0.0, 0.0];
    let end = [
        [0.370_613_914_397_050_2, -3.943_437_585_517_392],
        [3.237_284_092_057_233, -3.271_380_973_972_550],
        [-3.222_559_032_418_324, 5.225_081_843_456_543],
        [0.659_709_145_577_531_0, -2.590_612_434_977_470],
        [0.342_558_170_715_658_4, 1.198_213_693_392_275],
        [1.562_172_101_400_631, -0.242_968_234_493_582_4],
        [-0.700_309_292_221_249_5, 1.091_449_240_428_980],
    ];
    let bodies: Vec<_> =
        (0..7).map(|i| ((i + 1) as f64, vector([x[i], y[i]]), vector([u[i], v[i]]))).collect();
    let off = |steps: u32| {
        let mut world = attracting(method("rk4"), &bodies);
        world.set_step(3.0 / f64::from(steps));
        world.advance_to(3.0);
        let off = world.state().location.iter().zip(end).map(|(at, end)| (*at - vector(end)).length());
        off.fold(0.0, f64::max)
    };
    let (coarse, fine) = (off(40_000), off(80_000));
    assert!(fine < 1e-7, "{fine:e}");
    // Close encounters have rates of 100 /s, so at these steps the error does not yet fall exactly with the fourth power.
    let slope = libm::log2(coarse / fine);
    assert!((slope - 4.0).abs() < 0.5, "order {slope}, {coarse:e}, {fine:e}");
}

/// Checks the energy drift of a collapsing cluster of 400 stars, whose forces are computed by a tree. The forces have errors of up to 1e-3
/// in any direction. The drift is of the same size after a time in which each star has passed through the center once.
#[test]
fn a_cluster_by_a_tree_hardly_drifts() {
    let mut world = World::new();
    world.set_integrator(method("yoshida4"));
    let part = |i: u32, k: f64| (f64::from(i) * k).fract();
    for i in 0..400 {
        let at = 2.0 * DVec3::new(part(i, 0.618_033), part(i, 0.414_213), part(i, 0.732_050)) - 1.0;
        let star = RigidBody::new(&Shape::Sphere { radius: 0.01 }, (0.5 + part(i, 0.236_067)) / 400.0);
        world.add(star.with_location(at).with_velocity(0.3 * DVec3::Y.cross(at)));
    }
    let bodies = (0..400).map(jabuka::physics::BodyId::new).collect();
    let opening_angle = Some(0.5);
    world.add_force(Gravitation { bodies, against: None, constant: 1.0, softening: 0.1, opening_angle });
    world.set_step(0.02);
    let sum = |world: &World, of: &dyn Fn(DVec3, DVec3) -> DVec3| -> DVec3 {
        let (state, mass) = (world.state(), world.model().mass());
        (0..400).map(|i| mass[i] * of(state.location[i], state.velocity[i])).sum()
    };
    let momentum = |world: &World| sum(world, &|_, velocity| velocity);
    let turning = |world: &World| sum(world, &|at, velocity| at.cross(velocity));
    let (before, turning_before) = (momentum(&world), turning(&world));
    world.advance_to(3.0);
    let drift = world.balance().drift.abs();
    let lost = (momentum(&world) - before).length();
    let turned = (turning(&world) - turning_before).length() / turning_before.length();
    assert!(drift > 1e-9 && drift < 1e-3, "energy: {drift:e}");
    assert!(lost > 1e-9 && lost < 1e-3, "momentum, of a whole mass of 1 at speeds of 1: {lost:e}");
    assert!(turned > 1e-9 && turned < 1e-3, "angular momentum: {turned:e}");
}
