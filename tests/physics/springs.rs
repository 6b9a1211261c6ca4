//! Tests of springs that are attached to points of bodies, and so exert torques.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DQuat, DVec3};
use jabuka::physics::{
    Anchor, BodyId, Compound, METHODS, Method, Part, RigidBody, Shape, Spring, UniformGravity, World,
};

use crate::common::{method, tolerance};

/// The distance A of the springs' points from the center of the body, m, and the distance P of the posts from the origin.
///
/// In the following tests, two springs of rest length 0 connect points at ±A on the body's x axis with posts at ±P on the world's x axis.
/// Their potential is ½ k (|x + R a − p|² + |x − R a + p|²) = k |x|² + k |R a − p|². The first term moves the body as an oscillator; the
/// second turns it about z as a pendulum: I θ'' = −2 k A P sin θ. The two motions are independent at any amplitude.
const A: f64 = 0.5;
const P: f64 = 2.0;
/// The initial angle of the pendulum, at rest, rad.
const THETA: f64 = 1.2;

/// Returns a flat compound body that is symmetric only about its plane z = 0, so that only z is one of its principal axes. Its center of
/// mass is at the origin, wherever its parts are.
fn crooked() -> Shape {
    let ball = |radius: f64, x: f64, y: f64| Part {
        shape: Shape::Sphere { radius },
        location: DVec3::new(x, y, 0.0),
        orientation: DQuat::IDENTITY,
    };
    Shape::Compound(Compound::new(vec![ball(0.3, 0.0, 0.0), ball(0.2, 0.6, 0.4), ball(0.15, -0.2, 0.7)]))
}

/// Returns a world with the body between its posts, displaced by `aside` (m). The springs are so stiff that a quarter of a small
/// oscillation takes `quarter` seconds.
fn pendulum(method: &'static Method, quarter: f64, aside: DVec3) -> (World, BodyId) {
    let body =
        RigidBody::new(&crooked(), 2.0).with_location(aside).with_orientation(DQuat::from_rotation_z(THETA));
    // The body's x axis is not a principal axis, so the test notices if points are given in the wrong axes.
    let x = body.principal_axes.conjugate() * DVec3::X;
    assert!(x.abs().max_element() < 0.95, "{x}");
    let rate = FRAC_PI_2 / quarter;
    let stiffness = rate * rate * moment_about_z(&body) / (2.0 * A * P);
    let mut world = World::new();
    world.set_integrator(method);
    let id = world.add(body);
    for sign in [1.0, -1.0] {
        let at = sign * A * DVec3::X;
        let between = [Anchor::Point(sign * P * DVec3::X), Anchor::Body { id, at }];
        world.add_force(Spring { between, stiffness, damping: 0.0, rest_length: 0.0 });
    }
    (world, id)
}

/// Returns the moment of inertia about the body's z axis, kg m².
fn moment_about_z(body: &RigidBody) -> f64 {
    let z = body.principal_axes.conjugate() * DVec3::Z;
    (body.inertia * z).dot(z)
}

/// Returns the angle of the body about z, rad.
fn angle(world: &World, id: BodyId) -> f64 {
    let x = world.orientation(id) * DVec3::X;
    libm::atan2(x.y, x.x)
}

/// Returns the ratio of the period at an amplitude θ to that of a small oscillation: (2/π) K(sin θ/2) = 1 / agm(1, cos θ/2), by Gauss.
fn slower(amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0, libm::cos(amplitude / 2.0));
    for _ in 0..6 {
        (a, b) = (f64::midpoint(a, b), f64::sqrt(a * b));
    }
    1.0 / a
}

/// Checks the state after one and a quarter periods: the body passes its equilibrium angle with ω = −2 ω₀ sin θ₀/2, by its energy, and its
/// center of mass has moved as the oscillator x'' = −2 k/m x.
#[test]
fn a_body_between_two_springs_is_an_exact_pendulum() {
    let aside = DVec3::new(0.3, -0.2, 0.4);
    for method in METHODS {
        let quarter = 0.5;
        let (mut world, id) = pendulum(method, quarter, aside);
        let (time, steps) = (5.0 * quarter * slower(THETA), 4000);
        world.set_step(time / f64::from(steps));
        world.advance_to(time);

        let rate = FRAC_PI_2 / quarter;
        let speed = 2.0 * rate * libm::sin(THETA / 2.0);
        let allowed = tolerance(method, rate * time, steps);
        let off = angle(&world, id).abs();
        assert!(off < speed / rate * allowed, "{}: {off:e} > {allowed:e}", method.name);
        let off = (world.angular_velocity(id) + speed * DVec3::Z).length();
        assert!(off < speed * allowed, "{}: {off:e} > {allowed:e}", method.name);

        let inertia = moment_about_z(&world.body(id));
        let swing = f64::sqrt(rate * rate * inertia / (A * P) / world.body(id).mass);
        let off = (world.location(id) - aside * libm::cos(swing * time)).length();
        let allowed = aside.length() * tolerance(method, swing * time, steps);
        assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
    }
}

/// Checks the energy error of Verlet. Up to higher orders, Verlet conserves H + h² (V'' L² / 12 I² − V'² / 24 I) (Hairer, Lubich & Wanner,
/// *Geometric Numerical Integration*, IX.4). With V = −κ cos θ and z = ω₀ h, H itself varies by κ z² (sin² θ / 24 − cos θ (cos θ − cos θ₀)
/// / 6). The largest kinetic energy is κ (1 − cos θ₀).
#[test]
fn verlet_keeps_the_energy_of_the_pendulum() {
    let (mut world, _) = pendulum(method("velocity-verlet"), 0.5, DVec3::ZERO);
    let (step, mut largest) = (0.01, 0.0_f64);
    // Drifts are relative to the largest kinetic energy so far. Skip more than one period, in which this is reached.
    for count in 0..10_000 {
        world.step(step);
        let drift = world.balance().drift.abs();
        if count > 300 {
            largest = largest.max(drift);
        }
    }
    let off = |theta: f64| {
        let cosine = libm::cos(theta);
        (1.0 - cosine * cosine) / 24.0 - cosine * (cosine - libm::cos(THETA)) / 6.0
    };
    let least = (0..=1000).map(|k| off(THETA * f64::from(k) / 1000.0)).fold(f64::MAX, f64::min);
    let spread = off(THETA) - least;
    let z = PI * step;
    let bound = z * z * spread / (1.0 - libm::cos(THETA));
    assert!(largest < 1.03 * bound && largest > 0.97 * bound, "{largest:e} {bound:e}");
}

/// Checks a plank on two vertical springs at its ends: it bounces with ω² = 2k/m and rocks with ω² = 2k a²/I, √3 times as fast if the
/// plank is thin. The springs tilt by an amount of second order in the angle, 0.01, and so does their effect.
#[test]
fn a_plank_rocks_as_its_springs_make_it() {
    let (half, stiffness, gravity) = (1.0, 100.0, 9.81);
    let shape = Shape::Box { size: DVec3::new(2.0 * half, 0.02, 0.02) };
    let mut world = World::new();
    world.set_integrator(method("velocity-verlet"));
    let plank = RigidBody::new(&shape, 1.0).with_orientation(DQuat::from_rotation_z(0.01));
    let rocking = f64::sqrt(2.0 * stiffness * half * half / moment_about_z(&plank));
    assert!((rocking / f64::sqrt(2.0 * stiffness) - f64::sqrt(3.0)).abs() < 1e-3);
    let id = world.add(plank);
    for x in [-half, half] {
        let between = [Anchor::Point(DVec3::new(x, 2.0, 0.0)), Anchor::Body { id, at: x * DVec3::X }];
        // In equilibrium, each spring carries half the weight.
        let rest_length = 2.0 - gravity / 2.0 / stiffness;
        world.add_force(Spring { between, stiffness, damping: 0.0, rest_length });
    }
    world.add_force(UniformGravity { acceleration: -gravity * DVec3::Y });
    world.set_step(1e-3);
    let swings = 5.0;
    world.advance_to(swings * 2.0 * PI / rocking);
    let off = (angle(&world, id) / 0.01 - 1.0).abs();
    // The phase has an error of second order in the angle, and a relative error of (ω h)² / 24. The error of the cosine is half the square
    // of that of the phase.
    let phase = swings * 2.0 * PI * (1e-4 + 1e-6 * rocking * rocking / 24.0);
    assert!(off < phase * phase, "{off:e}");
}
