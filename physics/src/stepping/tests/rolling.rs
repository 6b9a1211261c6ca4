//! Tests of round bodies in time-stepping: they roll, slide and turn against closed forms.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::super::super::*;
use super::{GRAVITY, Scene, run};

/// Adds a wheel that lies on the ground: its axis is the z axis.
fn wheel(scene: &mut Scene, radius: f64, body: impl FnOnce(RigidBody) -> RigidBody) -> BodyId {
    let shape = Shape::Cylinder { radius, height: 0.5 * radius };
    scene.add(shape, |start| body(start.with_orientation(DQuat::from_rotation_x(FRAC_PI_2))))
}

/// A bouncy ball and a wheel roll without slip, slowly and so fast that they rotate by 0.4 rad within a step. They must stay on the floor,
/// and keep their velocity and their energy. Both are set down by hand, so they sink in at first, by 1e-4 m.
#[test]
fn what_rolls_stays_on_the_floor_at_any_speed() {
    let radius = 0.3;
    for speed in [2.0, 10.0, 30.0] {
        let mut scene = Scene::default().with_ground(0.0);
        let roll = |body: RigidBody| {
            let spin = -speed / radius * DVec3::Z;
            body.with_velocity(speed * DVec3::X).with_angular_velocity(spin)
        };
        let ball = scene.add(Shape::Sphere { radius }, |body| roll(body.with_location(radius * DVec3::Y)));
        scene.surfaces[ball.index()] = Some(Surface { restitution: Some(0.6), ..Surface::default() });
        let wheel = wheel(&mut scene, radius, |body| roll(body.with_location(DVec3::new(0.0, radius, 2.0))));
        let mut stepping = scene.stepping();
        let energy = stepping.snapshot().map_or(0.0, |start| start.balance.kinetic);
        for k in 1..=60 {
            let now = run(&mut stepping, 0.05 * f64::from(k));
            for id in [ball, wheel] {
                let body = &now.bodies[id.index()];
                assert!((body.location.y - radius).abs() < 2e-4, "{speed} m/s: {}", body.location);
                assert!(body.velocity.y.abs() < 2e-3, "{speed} m/s: {}", body.velocity);
                assert!((body.velocity.x / speed - 1.0).abs() < 1e-4, "{speed} m/s: {}", body.velocity);
                assert!((body.angular_velocity.z * radius / speed + 1.0).abs() < 1e-3);
            }
            assert!((now.bodies[wheel.index()].location.z - 2.0).abs() < 0.01);
            let accounts = now.balance.accounts;
            assert!((accounts.impacts.abs() + accounts.friction.abs()) / energy < 1e-3, "{accounts:?}");
        }
    }
}

/// A ball slides until it rolls: friction leaves 5/7 of the speed of a solid ball, and takes 2/7 of its kinetic energy. A ball that is set
/// down with a rotation ends with 2/7 of the speed of its surface. Both hold for a wheel with 2/3 and 1/3.
#[test]
fn what_slides_begins_to_roll() {
    let (radius, speed) = (0.3, 10.0);
    let mut scene = Scene::default().with_ground(0.0);
    let (push, spin) = (speed * DVec3::X, -speed / radius * DVec3::Z);
    let at = |z: f64| DVec3::new(0.0, radius, z);
    let ball = Shape::Sphere { radius };
    scene.add(ball.clone(), |body| body.with_location(at(0.0)).with_velocity(push));
    scene.add(ball, |body| body.with_location(at(2.0)).with_angular_velocity(spin));
    wheel(&mut scene, radius, |body| body.with_location(at(4.0)).with_velocity(push));
    wheel(&mut scene, radius, |body| body.with_location(at(6.0)).with_angular_velocity(spin));
    let mut stepping = scene.stepping();
    let end = run(&mut stepping, 3.0);
    for (body, part) in end.bodies[1..].iter().zip([5.0 / 7.0, 2.0 / 7.0, 2.0 / 3.0, 1.0 / 3.0]) {
        assert!((body.velocity.x / speed - part).abs() < 2e-4, "{part}: {}", body.velocity);
        assert!((body.angular_velocity.z * radius + body.velocity.x).abs() < 1e-3 * speed);
    }
    // Of the kinetic energies ½ m v² and ½ I ω², the part 2/7 and 5/7 is lost by the balls, 1/3 and 2/3 by the wheels.
    let moving = 0.5 * speed * speed;
    let expected = moving * (2.0 / 7.0 + 0.4 * 5.0 / 7.0 + 1.0 / 3.0 + 0.5 * 2.0 / 3.0);
    let lost = -end.balance.accounts.friction - end.balance.accounts.impacts;
    assert!((lost / expected - 1.0).abs() < 5e-3, "{lost} {expected}");
}

/// Motors turn the four wheels of a cart. It must reach the speed at which the wheels roll, and stay straight and level.
#[test]
fn a_cart_with_fast_wheels_drives_straight() {
    let (radius, turning) = (0.3, 80.0);
    let mut scene = Scene::default().with_ground(0.0);
    let middle = DVec3::new(0.0, radius, 0.0);
    let cart = scene.add(Shape::Box { size: DVec3::new(2.0, 0.2, 0.8) }, |body| body.with_location(middle));
    let mut links = Vec::new();
    for (x, z) in [(-0.8, -0.6), (-0.8, 0.6), (0.8, -0.6), (0.8, 0.6)] {
        let at = DVec3::new(x, 0.0, z);
        let wheel = wheel(&mut scene, radius, |body| body.with_location(middle + at));
        let between = [Anchor::Body { id: cart, at }, Anchor::centre(wheel)];
        let motor = Some(Motor::Speed { speed: -turning, limit: 5.0 });
        let hinge = Hinge::new(between, DVec3::Z, DQuat::from_rotation_x(-FRAC_PI_2));
        links.push(Link {
            kind: LinkKind::Hinge(hinge.with(Freedom { limits: None, motor })),
            collides: false,
        });
    }
    let mut stepping = TimeStepping::new(scene.world(GRAVITY), &scene.contacts(), &links);
    run(&mut stepping, 8.0);
    let end = run(&mut stepping, 10.0);
    let body = &end.bodies[cart.index()];
    println!("{} {} {:?}", body.location, body.velocity, end.balance.accounts);
    assert!((body.velocity.x / (turning * radius) - 1.0).abs() < 1e-3, "{}", body.velocity);
    assert!(body.velocity.y.abs() < 1e-3 && (body.location.y - radius).abs() < 2e-3, "{}", body.location);
    assert!(body.location.z.abs() < 0.05, "{}", body.location);
}

/// The given motion of a roller at a fixed place: it turns about the z axis so that its top moves along x.
struct Turning {
    at: DVec3,
    turning: f64,
}

impl Motion for Turning {
    fn at(&self, t: f64) -> Kinematics {
        Kinematics {
            location: self.at,
            velocity: DVec3::ZERO,
            acceleration: DVec3::ZERO,
            orientation: DQuat::from_rotation_z(-self.turning * t) * DQuat::from_rotation_x(FRAC_PI_2),
            angular_velocity: -self.turning * DVec3::Z,
        }
    }

    fn angular_acceleration(&self, _: f64) -> DVec3 {
        DVec3::ZERO
    }
}

/// A plank lies on two rollers that a given motion turns at 20 rad/s. They must accelerate it to the speed of their surface, and not lift it.
#[test]
fn guided_rollers_carry_a_plank() {
    let (radius, turning) = (0.3, 20.0);
    let mut scene = Scene::default();
    let rollers =
        [-20.0, 20.0].map(|x| (wheel(&mut scene, radius, |body| body.with_location(x * DVec3::X)), x));
    let plank = scene.add(Shape::Box { size: DVec3::new(100.0, 0.1, 0.2) }, |body| {
        body.with_location((radius + 0.05) * DVec3::Y - 5.0 * DVec3::X)
    });
    let mut world = scene.world(GRAVITY);
    for (roller, x) in rollers {
        world.follow(roller, Arc::new(Turning { at: x * DVec3::X, turning }));
    }
    let mut stepping = TimeStepping::new(world, &scene.contacts(), &[]);
    for k in 1..=20 {
        let body = run(&mut stepping, 0.1 * f64::from(k)).bodies[plank.index()];
        assert!((body.location.y - radius - 0.05).abs() < 1e-3, "{}", body.location);
        if k == 5 {
            // The plank still slides, so friction is μ m g.
            assert!((body.velocity.x / (0.5 * GRAVITY * 0.5) - 1.0).abs() < 0.02, "{}", body.velocity);
        }
    }
    let end = run(&mut stepping, 2.0).bodies[plank.index()];
    assert!((end.velocity.x / (turning * radius) - 1.0).abs() < 1e-3, "{}", end.velocity);
}

/// A cone on its side rolls about its apex, which stays at rest. Its centre of mass describes a circle.
#[test]
fn a_cone_rolls_about_its_apex() {
    let (radius, height, speed) = (0.2, 0.5, 0.5);
    let half_angle = libm::atan2(radius, height);
    let from_apex = 0.75 * height;
    let (up, along) = (from_apex * libm::sin(half_angle), from_apex * libm::cos(half_angle));
    let mut scene = Scene::default().with_ground(0.0);
    // The axis points from the base to the apex: along x, and down by the half angle.
    let turn = DQuat::from_rotation_z(-FRAC_PI_2 - half_angle);
    let cone = scene.add(Shape::Cone { radius, top_radius: 0.0, height }, |body| {
        body.with_location(up * DVec3::Y)
            .with_orientation(turn)
            .with_velocity(speed * DVec3::Z)
            .with_angular_velocity(speed / up * DVec3::X)
    });
    let mut stepping = scene.stepping();
    for k in 1..=20 {
        let t = 0.2 * f64::from(k);
        let angle = speed / along * t;
        let expected = DVec3::new(along * (1.0 - libm::cos(angle)), up, along * libm::sin(angle));
        let found = run(&mut stepping, t).bodies[cone.index()].location;
        assert!(found.abs_diff_eq(expected, 0.02), "{t} {found} {expected}");
    }
}
