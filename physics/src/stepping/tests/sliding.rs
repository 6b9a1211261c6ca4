//! Tests of sliding friction in time-stepping.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::super::super::*;
use super::{GRAVITY, STEP, Scene, cube, run};

/// A block rests on an incline. The slope is just below the friction angle, where the block must stay, and just above it, where the block
/// must slide.
#[test]
fn friction_holds_up_to_its_angle() {
    let friction = 0.5_f64;
    for (part, holds) in [(0.99, true), (1.01, false)] {
        let tilt = part * libm::atan(friction);
        let mut scene = Scene::default().with_ground(tilt);
        let turn = DQuat::from_rotation_z(tilt);
        let block = scene.add(Shape::Box { size: DVec3::new(1.0, 0.4, 1.0) }, |body| {
            body.with_orientation(turn).with_location(turn * DVec3::new(0.0, 0.2, 0.0))
        });
        let mut stepping = scene.stepping();
        let end = run(&mut stepping, 4.0).bodies[block.index()];
        let way = -(turn.conjugate() * end.location).x;
        let free = GRAVITY * (libm::sin(tilt) - friction * libm::cos(tilt));
        let expected = if holds { 0.0 } else { 0.5 * free * 16.0 };
        println!("{part}: slid {way} m, expected {expected} m");
        assert!((way - expected).abs() < 0.03 * expected.abs() + 1e-3, "{way} {expected}");
    }
}

/// A sliding block stops after v²/(2 μ g), where friction has taken its whole kinetic energy ½ m v².
#[test]
fn what_friction_takes_is_booked() {
    let mut scene = Scene::default().with_ground(0.0);
    let block = scene.add(Shape::Box { size: DVec3::new(1.0, 0.2, 1.0) }, |body| {
        body.with_location(0.1 * DVec3::Y).with_velocity(3.0 * DVec3::X)
    });
    let mut stepping = scene.stepping();
    let end = run(&mut stepping, 2.0);
    let expected = 9.0 / (2.0 * 0.5 * GRAVITY);
    let way = end.bodies[block.index()].location.x;
    println!("slid {way} m, expected {expected} m; {:?} drift {}", end.balance.accounts, end.balance.drift);
    assert!((way / expected - 1.0).abs() < 0.01);
    assert!((end.balance.accounts.friction / -4.5 - 1.0).abs() < 0.01);
    assert!(end.balance.drift.abs() < 0.01);
}

/// A plank that slides obliquely stops on a straight line after v²/(2 μ g). Friction at its base makes it yield more across its length than along
/// it. This must not turn the friction aside.
#[test]
fn what_slides_obliquely_stays_on_its_line() {
    let (speed, friction) = (1.5, 0.5);
    // Euler–Cromer brakes half a step too early.
    let expected = speed * speed / (2.0 * friction * GRAVITY) - 0.5 * STEP * speed;
    for k in 0..6 {
        let mut scene = Scene::default().with_ground(0.0);
        let turn = DQuat::from_rotation_y(f64::from(k) * std::f64::consts::FRAC_PI_6);
        let plank = scene.add(Shape::Box { size: DVec3::new(1.0, 0.2, 0.15) }, |body| {
            body.with_location(0.1 * DVec3::Y).with_orientation(turn).with_velocity(speed * DVec3::X)
        });
        let end = run(&mut scene.stepping(), 1.0).bodies[plank.index()];
        println!("{k}: stopped at {}, expected {expected} m", end.location);
        assert!((end.location.x / expected - 1.0).abs() < 0.01, "{k} {}", end.location);
        assert!(end.location.z.abs() < 0.01 * expected, "{k} {}", end.location);
    }
}

/// A table rotates about the vertical axis at a constant angular velocity.
struct Turntable(f64);

impl Motion for Turntable {
    fn at(&self, t: f64) -> Kinematics {
        Kinematics {
            location: -0.05 * DVec3::Y,
            velocity: DVec3::ZERO,
            acceleration: DVec3::ZERO,
            orientation: DQuat::from_rotation_y(self.0 * t),
            angular_velocity: self.0 * DVec3::Y,
        }
    }

    fn angular_acceleration(&self, _: f64) -> DVec3 {
        DVec3::ZERO
    }
}

/// A coin and a cube lie on a turntable. Friction is stronger than the centrifugal force, so they must keep their distance from the axis.
#[test]
fn what_friction_holds_stays_on_a_turntable() {
    let (turning, distance) = (4.0, 0.2);
    for (shape, height) in [(Shape::Cylinder { radius: 0.05, height: 0.02 }, 0.02), (cube(0.1), 0.1)] {
        let mut scene = Scene::default();
        let table = scene.add(Shape::Cylinder { radius: 1.0, height: 0.1 }, |body| body);
        let held = scene.add(shape, |body| {
            body.with_location(DVec3::new(distance, 0.5 * height, 0.0))
                .with_velocity(-turning * distance * DVec3::Z)
                .with_angular_velocity(turning * DVec3::Y)
        });
        let mut world = scene.world(GRAVITY);
        world.follow(table, Arc::new(Turntable(turning)));
        let mut stepping = TimeStepping::new(world, &scene.contacts(), &[]);
        let end = run(&mut stepping, 10.0).bodies[held.index()];
        let radius = DVec3::new(end.location.x, 0.0, end.location.z).length();
        println!("{radius} m from the axis after {} rad", 10.0 * turning);
        assert!((radius / distance - 1.0).abs() < 0.01, "{radius}");
    }
}
