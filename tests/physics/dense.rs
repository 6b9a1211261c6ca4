//! Tests that locations and velocities within a step are as accurate as those at its ends.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use glam::{DQuat, DVec3};
use jabuka::physics::{
    Anchor, Dynamics, Kinematics, METHODS, Method, Motion, RigidBody, Shape, Snapshot, Spring,
    UniformGravity, World,
};

/// Returns a world with a ball on a spring, and a brick that tumbles under a torque.
fn build(method: &'static Method, step: f64) -> World {
    let mut world = World::new();
    world.set_integrator(method);
    world.set_step(step);
    let ball = world
        .add(RigidBody::new(&Shape::Sphere { radius: 0.5 }, 1.0).with_location(DVec3::new(2.0, 0.0, 0.0)));
    world.add(
        RigidBody::new(&Shape::Box { size: DVec3::new(3.0, 1.0, 2.0) }, 1.0)
            .with_angular_velocity(DVec3::new(0.3, 0.2, 2.0))
            .with_torque(DVec3::new(0.2, 0.0, 0.1)),
    );
    let between = [Anchor::centre(ball), Anchor::Point(DVec3::ZERO)];
    world.add_force(Spring { between, stiffness: 4.0, damping: 0.0, rest_length: 1.0 });
    world.add_force(UniformGravity { acceleration: DVec3::new(0.0, 0.0, -1.0) });
    world
}

/// Returns snapshots of the world at moments within steps.
fn seen(method: &'static Method, step: f64, moments: &[f64]) -> Vec<Snapshot> {
    let (mut world, mut seen) = (build(method, step), Vec::new());
    world.advance(1.0, moments, &mut |moment| seen.push(moment)).unwrap();
    seen
}

fn error(one: &[Snapshot], other: &[Snapshot]) -> [f64; 2] {
    let mut errors = [0.0f64; 2];
    for (one, other) in one.iter().zip(other) {
        for (a, b) in one.bodies.iter().zip(&other.bodies) {
            let turned = (a.orientation * b.orientation.conjugate()).to_scaled_axis().length();
            let turned = turned.min(std::f64::consts::TAU - turned);
            errors[0] = errors[0].max((a.location - b.location).length().max(turned));
            let velocity = (a.velocity - b.velocity).length();
            errors[1] = errors[1].max(velocity.max((a.angular_velocity - b.angular_velocity).length()));
        }
    }
    errors
}

/// Checks that halving the step divides the error within steps by 2ᵖ for a method of order p, as at the ends of steps.
#[test]
fn what_is_seen_within_a_step_has_the_order_of_the_method() {
    let moments = [0.313, 0.517, 0.771, 0.963];
    let exact = seen(Method::by_name("rk4").unwrap(), 1e-4, &moments);
    for method in METHODS {
        let errors = [1.0 / 64.0, 1.0 / 128.0].map(|step| error(&seen(method, step, &moments), &exact));
        for what in 0..2 {
            let order = libm::log2(errors[0][what] / errors[1][what]);
            // With a finer step a moment falls on another part of a step, so the measured orders scatter.
            assert!(order > f64::from(method.order) - 0.6, "{} {what}: {order} {errors:?}", method.name);
        }
    }
}

/// Checks that velocities are the derivatives of locations, by difference quotients over 2e-5 s within one step of 1/64 s. Methods whose
/// velocity belongs to the whole step are left out.
#[test]
fn velocities_are_the_derivatives_of_places() {
    for name in ["euler-cromer", "velocity-verlet", "rk4"] {
        let method = Method::by_name(name).unwrap();
        let moments = [0.508 - 1e-5, 0.508, 0.508 + 1e-5];
        let found = seen(method, 1.0 / 64.0, &moments);
        for body in 0..2 {
            let [before, here, after] = [0, 1, 2].map(|moment| found[moment].bodies[body]);
            let velocity = (after.location - before.location) / 2e-5;
            assert!(velocity.abs_diff_eq(here.velocity, 1e-8), "{name}: {velocity} {}", here.velocity);
            let turned = (after.orientation * before.orientation.conjugate()).to_scaled_axis() / 2e-5;
            let off = (turned - here.angular_velocity).length();
            // The angular velocity follows from the conserved angular momentum; the orientation has the error of the method.
            let tolerance = 3.0 * libm::pow(1.0 / 64.0, f64::from(method.order));
            assert!(off < tolerance, "{name}: {turned} {}", here.angular_velocity);
        }
    }
}

/// Checks that observing moments within steps changes neither the states, nor the number of steps, nor the drift.
#[test]
fn to_look_within_steps_changes_nothing() {
    for method in METHODS {
        let (mut plain, mut watched) = (build(method, 0.007), build(method, 0.007));
        let mut count = 0;
        for frame in 1..10 {
            let t = f64::from(frame) * 0.1;
            plain.advance_to(t);
            let moments = [t - 0.0999, t - 0.05, t - 0.0499, t];
            watched.advance(t, &moments, &mut |moment| count += usize::from(moment.time <= t)).unwrap();
            assert_eq!(plain.snapshot(), watched.snapshot(), "{}", method.name);
        }
        assert_eq!((count, plain.steps()), (36, watched.steps()));
    }
}

/// Checks that a guided body is at its prescribed location within steps, up to rounding.
#[test]
fn guided_bodies_are_exact_within_steps() {
    struct Circle;
    impl Motion for Circle {
        fn at(&self, t: f64) -> Kinematics {
            Kinematics {
                location: DVec3::new(libm::cos(t), libm::sin(t), 0.0),
                velocity: DVec3::new(-libm::sin(t), libm::cos(t), 0.0),
                acceleration: DVec3::new(-libm::cos(t), -libm::sin(t), 0.0),
                orientation: DQuat::from_rotation_z(t),
                angular_velocity: DVec3::Z,
            }
        }

        fn angular_acceleration(&self, _: f64) -> DVec3 {
            DVec3::ZERO
        }
    }
    for method in METHODS {
        let mut world = build(method, 0.1);
        let guided = world.add(RigidBody::new(&Shape::Sphere { radius: 0.5 }, 1.0));
        world.drive(guided, Circle);
        world
            .advance(1.0, &[0.123, 0.777], &mut |moment| {
                let body = moment.bodies[guided.index()];
                assert_eq!(body.location, Circle.at(moment.time).location);
                assert_eq!(body.force, Circle.at(moment.time).acceleration);
            })
            .unwrap();
    }
}
