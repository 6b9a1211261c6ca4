//! Tests of guided bodies, whose motion is prescribed, and of their effect on other bodies.

use glam::{DQuat, DVec3};
use jabuka::physics::{
    Anchor, BodyId, Kinematics, METHODS, Method, Motion, Shape, Spring, UniformGravity, World,
};

use crate::common::ball;

/// A prescribed motion: x = sin 3t along x, with rotation about y.
struct Shaken;

impl Motion for Shaken {
    fn at(&self, t: f64) -> Kinematics {
        let (sin, cos) = libm::sincos(3.0 * t);
        Kinematics {
            location: DVec3::X * sin,
            velocity: DVec3::X * (3.0 * cos),
            acceleration: DVec3::X * (-9.0 * sin),
            orientation: DQuat::from_rotation_y(2.0 * t),
            angular_velocity: DVec3::Y * 2.0,
        }
    }

    fn angular_acceleration(&self, _: f64) -> DVec3 {
        DVec3::ZERO
    }
}

/// Returns a world with a free ball of 1 kg on a spring of 4 N/m, whose other end is a guided body, after 1 s in this number of steps.
fn driven(method: &'static Method, steps: u32) -> World {
    let mut world = World::new();
    world.set_integrator(method);
    world.set_step(1.0 / f64::from(steps));
    let hand = world.add(ball());
    let free = world.add(ball());
    world.drive(hand, Shaken);
    let between = [Anchor::centre(hand), Anchor::centre(free)];
    world.add_force(Spring { between, stiffness: 4.0, damping: 0.0, rest_length: 0.0 });
    world.advance_to(1.0);
    world
}

/// Returns location and velocity of the free ball at the time t. It solves x'' = 4 (sin 3t − x) from rest: x = a sin 3t + b sin 2t with a
/// = 4 / (4 − 9) and b = −3a / 2.
fn exact(t: f64) -> (f64, f64) {
    let a = 4.0 / (4.0 - 9.0);
    let b = -1.5 * a;
    let (sin3, cos3) = libm::sincos(3.0 * t);
    let (sin2, cos2) = libm::sincos(2.0 * t);
    (a * sin3 + b * sin2, 3.0 * a * cos3 + 2.0 * b * cos2)
}

/// Checks the order of the methods for a driven oscillator. The order is lost unless the guided body is moved to each time at which a
/// method evaluates the force.
#[test]
fn a_driven_oscillator_is_solved_with_the_order_of_the_method() {
    let (x, v) = exact(1.0);
    for method in METHODS {
        let error = |steps| {
            let state = driven(method, steps).state().clone();
            (state.location[1].x - x).abs().max((state.velocity[1].x - v).abs())
        };
        let errors = (error(128), error(256));
        let slope = libm::log2(errors.0 / errors.1);
        // The tolerance is derived as in `order.rs`, with a rate of 3 /s.
        assert!((slope - f64::from(method.order)).abs() < 0.15, "{}: {slope} {errors:?}", method.name);
    }
}

/// Checks that the work of the guided body is accounted for, so that the drift is the error of the method alone.
#[test]
fn the_work_of_what_guides_a_body_is_counted() {
    for method in METHODS {
        let error = |steps| driven(method, steps).balance().drift.abs();
        let (coarse, fine) = (error(128), error(256));
        let ratio = coarse / fine;
        // The accounts have at least the order of the method.
        assert!(ratio > libm::exp2(f64::from(method.order)) * 0.8, "{}: {coarse} {fine}", method.name);
    }
    let mut world = driven(Method::by_name("rk4").unwrap(), 1000);
    let balance = world.balance();
    assert!(balance.drift.abs() < 1e-9 && balance.accounts.work.abs() > 0.5, "{balance:?}");
    // The balance holds the energy and the momentum of the free ball only.
    let v = exact(1.0).1;
    assert!((balance.kinetic - v * v / 2.0).abs() < 1e-9, "{balance:?}");
    assert!((balance.linear_momentum.x - v).abs() < 1e-9);
}

#[test]
fn it_is_where_its_motion_says_whatever_pulls_at_it() {
    for method in METHODS {
        let mut world = World::new();
        world.set_integrator(method);
        let brick = jabuka::physics::RigidBody::new(&Shape::Box { size: DVec3::new(1.0, 2.0, 3.0) }, 5.0);
        let id = world.add(brick.with_force(DVec3::Z).with_torque(DVec3::ONE));
        world.drive(id, Shaken);
        world.add_force(UniformGravity { acceleration: DVec3::NEG_Y });
        for t in [0.1, 0.35, 1.7] {
            world.advance_to(t);
            let pose = Shaken.at(t);
            assert_eq!((world.location(id), world.velocity(id)), (pose.location, pose.velocity));
            assert!(world.orientation(id).abs_diff_eq(pose.orientation, 1e-15));
            let turning = world.angular_velocity(id);
            assert!(turning.abs_diff_eq(pose.angular_velocity, 1e-14), "{turning}");
            assert_eq!(world.forces()[id.index()], 5.0 * pose.acceleration, "what guides it sees to that");
            // The constraint that guides the body carries its weight, force and torque; they must not appear as an energy error.
            assert_eq!(world.balance().kinetic, 0.0);
        }
        assert_eq!(BodyId::index(id), 0);
    }
}
