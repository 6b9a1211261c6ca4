//! Tests of machines in time-stepping: several bodies on joints, under weight.

use std::f64::consts::FRAC_PI_2;

use glam::{DQuat, DVec3};

use super::super::super::*;
use super::{GRAVITY, Scene, cube, run};

/// Returns joints between bodies that do not collide with each other.
fn links(kinds: impl IntoIterator<Item = LinkKind>) -> Vec<Link> {
    kinds.into_iter().map(|kind| Link { kind, collides: false }).collect()
}

/// A shaft turns on a vertical hinge, with two balls welded to it. Its weight and the weight of the balls have no moment about the axis, so the
/// shaft must keep its angular velocity.
#[test]
fn weight_does_not_brake_a_turnstile() {
    let turning = 6.0 * DVec3::Y;
    let mut scene = Scene::default();
    let shaft = scene.add(Shape::Cylinder { radius: 0.04, height: 1.0 }, |body| RigidBody {
        mass: 2.0,
        ..body.with_angular_velocity(turning)
    });
    let ends = [Anchor::Point(DVec3::ZERO), Anchor::centre(shaft)];
    let mut kinds = vec![LinkKind::Hinge(Hinge::new(ends, DVec3::Y, DQuat::IDENTITY))];
    for x in [-0.42, 0.42] {
        let at = x * DVec3::X;
        let ball = scene.add(Shape::Sphere { radius: 0.06 }, |body| {
            body.with_location(at).with_velocity(turning.cross(at)).with_angular_velocity(turning)
        });
        let between = [Anchor::centre(shaft), Anchor::Body { id: ball, at: -at }];
        kinds.push(LinkKind::Fixed(Fixed { between, turned: DQuat::IDENTITY }));
    }
    let links = links(kinds);
    scene.surfaces.fill(None);
    let mut stepping = TimeStepping::new(scene.world(GRAVITY), &scene.contacts(), &links);
    for k in 1..=5 {
        let now = run(&mut stepping, f64::from(k)).bodies[shaft.index()].angular_velocity;
        println!("{k} s: {now}");
        assert!((now.y / turning.y - 1.0).abs() < 1e-3, "{k} {now}");
    }
}

/// Blocks slide on the arms of a rotating shaft, and press outwards on the limits of their sliders. Nothing brakes the shaft.
#[test]
fn limits_do_not_brake_a_rotor() {
    let turning = 6.0 * DVec3::Y;
    let mut scene = Scene::default();
    let shaft =
        scene.add(Shape::Cylinder { radius: 0.2, height: 0.3 }, |body| body.with_angular_velocity(turning));
    let ends = [Anchor::Point(DVec3::ZERO), Anchor::centre(shaft)];
    let mut kinds = vec![LinkKind::Hinge(Hinge::new(ends, DVec3::Y, DQuat::IDENTITY))];
    for axis in [DVec3::X, DVec3::NEG_X] {
        let at = 0.5 * axis;
        let block = scene.add(cube(0.1), |body| {
            body.with_location(at).with_velocity(turning.cross(at)).with_angular_velocity(turning)
        });
        let ends = [Anchor::centre(shaft), Anchor::centre(block)];
        let freedom = Freedom { limits: Some([0.0, 0.5]), motor: None };
        kinds.push(LinkKind::Slider(Slider { between: ends, axis, turned: DQuat::IDENTITY, freedom }));
    }
    let links = links(kinds);
    scene.surfaces.fill(None);
    let mut stepping = TimeStepping::new(scene.world(0.0), &scene.contacts(), &links);
    let end = run(&mut stepping, 4.0).bodies[shaft.index()].angular_velocity;
    println!("{end}");
    assert!((end.y / turning.y - 1.0).abs() < 2e-3, "{end}");
}

/// A heavy rotor spins on a hinge in a light arm, which a ball joint holds at its end. The arm must stay level and revolve with Ω = τ/(I ω), with
/// the moment τ of the weight about the ball joint.
#[test]
fn a_gyroscope_precesses() {
    let (spin, arm_mass, mass) = (50.0, 0.3, 2.0);
    let (radius, distance) = (0.2, 0.4);
    let moment = GRAVITY * (mass * distance + arm_mass * 0.5 * distance);
    let precession = moment / (0.5 * mass * radius * radius * spin) * DVec3::Y;
    let mut scene = Scene::default();
    let mut add = |shape: Shape, mass: f64, at: DVec3, spin: DVec3| {
        scene.add(shape, |body| {
            RigidBody { mass, inertia: mass * body.inertia, ..body }
                .with_orientation(DQuat::from_rotation_z(-FRAC_PI_2))
                .with_location(at)
                .with_velocity(precession.cross(at))
                .with_angular_velocity(precession + spin)
        })
    };
    let middle = 0.5 * distance * DVec3::X;
    let arm = add(Shape::Box { size: DVec3::new(0.05, distance, 0.05) }, arm_mass, middle, DVec3::ZERO);
    let rotor = add(Shape::Cylinder { radius, height: 0.05 }, mass, distance * DVec3::X, spin * DVec3::X);
    // The y axis of both bodies points along the arm.
    let half = 0.5 * distance * DVec3::Y;
    let pivot = [Anchor::Point(DVec3::ZERO), Anchor::Body { id: arm, at: -half }];
    let axle = [Anchor::Body { id: arm, at: half }, Anchor::centre(rotor)];
    let kinds = [
        LinkKind::Ball(Ball { between: pivot }),
        LinkKind::Hinge(Hinge::new(axle, DVec3::Y, DQuat::IDENTITY)),
    ];
    let links = links(kinds);
    scene.surfaces.fill(None);
    let mut stepping = TimeStepping::new(scene.world(GRAVITY), &scene.contacts(), &links);
    for k in 1..=5 {
        let t = f64::from(k);
        let now = run(&mut stepping, t).bodies[rotor.index()];
        let expected = DQuat::from_rotation_y(precession.y * t) * (distance * DVec3::X);
        let along = now.angular_velocity.dot(now.location.normalize());
        println!("{t} s: {} m from {expected}, spin {along}", now.location - expected);
        assert!(now.location.abs_diff_eq(expected, 0.05 * distance), "{t} {}", now.location);
        assert!((along / spin - 1.0).abs() < 1e-3, "{t} {along}");
    }
}

/// A beam of eight welded parts of 1 kg reaches out from a wall. The last part weighs 20 kg. The welds may yield, but the beam must not hang down.
#[test]
fn a_welded_beam_bends_little() {
    let mut scene = Scene::default();
    let mut links = Vec::new();
    let mut end = Anchor::Point(DVec3::ZERO);
    for k in 0..8 {
        let part = scene.add(Shape::Box { size: DVec3::new(0.5, 0.2, 0.2) }, |body| {
            let at = (0.25 + 0.5 * f64::from(k)) * DVec3::X;
            let mass = if k == 7 { 20.0 } else { 1.0 };
            RigidBody { mass, inertia: mass * body.inertia, ..body.with_location(at) }
        });
        let between = [end, Anchor::Body { id: part, at: -0.25 * DVec3::X }];
        let kind = LinkKind::Fixed(Fixed { between, turned: DQuat::IDENTITY });
        links.push(Link { kind, collides: false });
        end = Anchor::Body { id: part, at: 0.25 * DVec3::X };
    }
    let mut stepping = TimeStepping::new(scene.world(GRAVITY), &scene.contacts(), &links);
    for k in 1..=40 {
        let tip = run(&mut stepping, 0.1 * f64::from(k)).bodies[7].location.y;
        println!("{k}: {tip} m");
        assert!(tip > -0.2, "{k} {tip}");
    }
}
