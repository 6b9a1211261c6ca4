//! Tests of buoyancy, magnets, and the gravity of an oblate planet.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};
use jabuka::Scene;
use jabuka::physics::{
    BodyId, Buoyancy, Dipoles, Gravitation, J2, METHODS, RigidBody, Shape, UniformGravity, World,
};

use crate::common::{ball, frames, method, tolerance, worlds};

const G: f64 = 9.81;

fn lake(world: &mut World, id: BodyId, shape: Shape, density: f64) {
    let gravity = DVec3::new(0.0, -G, 0.0);
    world.add_force(UniformGravity { acceleration: gravity });
    world.add_force(Buoyancy { bodies: vec![(id, shape)], density, level: 0.0, gravity });
}

/// Checks a floating cube with edge a and 0.4 of the liquid's density, which floats with a draft of 0.4 a. While the surface stays between
/// its top and bottom, it oscillates vertically as on a spring: ω² = ρ g a²/m = g/(0.4 a).
#[test]
fn a_box_heaves_as_on_a_spring() {
    let (edge, amplitude, steps) = (0.5, 0.15, 1000);
    let shape = Shape::Box { size: DVec3::splat(edge) };
    let rest = edge * (0.5 - 0.4);
    let rate = (G / (0.4 * edge)).sqrt();
    let body =
        RigidBody::new(&shape, 400.0 * edge * edge * edge).with_location((rest + amplitude) * DVec3::Y);
    for (method, mut world, id) in worlds(body) {
        lake(&mut world, id, shape.clone(), 1000.0);
        let period = TAU / rate;
        world.set_step(period / f64::from(steps));
        world.advance_to(1.25 * period);
        let allowed = amplitude * tolerance(method, 1.25 * TAU, steps + steps / 4);
        let off = (world.location(id).y - rest).abs();
        assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
        let drift = world.balance().drift.abs();
        assert!(drift < 4.0 * tolerance(method, 1.25 * TAU, steps + steps / 4), "{}: {drift:e}", method.name);
    }
}

/// Without gravity nothing is carried: a body stays, or keeps its velocity, and a warning says so.
#[test]
fn nothing_floats_without_gravity() {
    for (extra, speed) in [("", 0.0), ("velocity = [0, 2, 0]", 2.0), ("angular_velocity = [1, 0, 0]", 0.0)] {
        for shape in ["box.size = [1, 1, 1]", "sphere.radius = 0.5", "cylinder = { radius = 1, height = 1 }"]
        {
            let text = format!(
                "simulation.duration = 1
                [body.block]
                shape.{shape}
                {extra}
                [force.lake.buoyancy]
                density = 1000"
            );
            let warnings = Scene::parse(&text).unwrap().warnings.to_text(false);
            assert!(warnings.contains("the force `lake` has no effect"), "{warnings}");
            let last = frames(&text).pop().unwrap();
            let off = (last.bodies[0].location - speed * DVec3::Y).length();
            assert!(off < 1e-12 && last.bodies[0].force == DVec3::ZERO, "{text}: {off:e}");
            assert!(last.balance.drift.abs() < 1e-12, "{text}: {:e}", last.balance.drift);
        }
    }
}

/// Checks the roll of a plank about its long axis: ω² = m g GM/I with the metacentric height GM = b²/(12 d) + d/2 − h/2, where b is the
/// width, h the height and d = h ρ/ρ₀ the draft. Small angles do not cause heave. For an angle φ, ω has a relative error of φ², here 1e-6.
#[test]
fn a_plank_rolls_about_its_metacentre() {
    let (width, height, length) = (1.0, 0.3, 2.0);
    let shape = Shape::Box { size: DVec3::new(width, height, length) };
    let mass = 600.0 * width * height * length;
    let draft = 0.6 * height;
    let metacentric = width * width / (12.0 * draft) + 0.5 * draft - 0.5 * height;
    let inertia = mass / 12.0 * (width * width + height * height);
    let period = TAU / (mass * G * metacentric / inertia).sqrt();
    let (angle, steps) = (1e-3, 1000);
    let body = RigidBody::new(&shape, mass)
        .with_location((0.5 * height - draft) * DVec3::Y)
        .with_orientation(DQuat::from_rotation_z(angle));
    for (method, mut world, id) in worlds(body) {
        lake(&mut world, id, shape.clone(), 1000.0);
        world.set_step(period / f64::from(steps));
        world.advance_to(0.25 * period);
        // A quarter of a period later the plank is level.
        let now = 2.0 * world.orientation(id).z;
        let allowed = angle * (tolerance(method, TAU, steps) + 1e-5);
        assert!(now.abs() < allowed, "{}: {now:e} > {allowed:e}", method.name);
    }
}

/// Checks that an upright log of a third of the water's density falls over and floats lying, with its energy balanced all the time.
#[test]
fn a_log_does_not_stand() {
    let shape = Shape::Cylinder { radius: 0.2, height: 1.0 };
    let mut world = World::new();
    world.set_integrator(method("rk4"));
    let mass = 333.0 * PI * 0.04;
    let id = world.add(
        RigidBody::new(&shape, mass)
            .with_location(0.17 * DVec3::Y)
            .with_orientation(DQuat::from_rotation_x(0.05)),
    );
    lake(&mut world, id, shape, 1000.0);
    world.set_step(0.002);
    let mut lowest = 1.0_f64;
    for step in 1..=40 {
        world.advance_to(f64::from(step) * 0.1);
        lowest = lowest.min((world.orientation(id) * DVec3::Y).y);
        let drift = world.balance().drift.abs();
        assert!(drift < 1e-6, "{drift:e}");
    }
    assert!(lowest < 0.1, "{lowest}");
}

/// Checks a magnet in a field, which swings like a pendulum: θ'' = −(m B/I) sin θ. From 1 mrad, its period is 2π √(I/(m B)) up to 1e-7.
#[test]
fn a_compass_needle_swings() {
    let shape = Shape::Cylinder { radius: 0.1, height: 0.5 };
    let body = RigidBody::new(&shape, 2.0).with_orientation(DQuat::from_rotation_x(1e-3));
    let (moment, field, steps) = (0.3, 0.5, 1000);
    let period = TAU * (body.inertia.x / (moment * field)).sqrt();
    for (method, mut world, id) in worlds(body) {
        let moments = vec![moment * DVec3::Y];
        world.add_force(Dipoles {
            bodies: vec![id],
            against: None,
            moments,
            constant: Dipoles::CONSTANT,
            field: field * DVec3::Y,
        });
        world.set_step(period / f64::from(steps));
        world.advance_to(0.25 * period);
        let now = 2.0 * world.orientation(id).x;
        let allowed = 1e-3 * (tolerance(method, TAU, steps) + 1e-6);
        assert!(now.abs() < allowed, "{}: {now:e} > {allowed:e}", method.name);
    }
}

/// Checks that two free magnets conserve energy, momentum and angular momentum.
#[test]
fn two_free_magnets_keep_energy_and_momenta() {
    for method in METHODS {
        let mut world = World::new();
        world.set_integrator(method);
        let one = world.add(ball().with_velocity(0.3 * DVec3::Y).with_angular_velocity(DVec3::X));
        let two = world.add(ball().with_location(0.8 * DVec3::X));
        world.add_force(Dipoles {
            bodies: vec![one, two],
            against: None,
            moments: vec![DVec3::new(1.0, 0.5, 0.0), DVec3::new(0.0, 0.3, -0.8)],
            constant: 0.01,
            field: DVec3::ZERO,
        });
        world.set_step(0.0005);
        let before = world.balance();
        world.advance_to(1.0);
        let after = world.balance();
        let push = (after.linear_momentum - before.linear_momentum).length();
        let turn = (after.angular_momentum - before.angular_momentum).length();
        let allowed = tolerance(method, 10.0, 2000);
        assert!(push < 1e-12 && turn < allowed.max(1e-12), "{}: {push:e} {turn:e}", method.name);
        assert!(after.drift.abs() < 10.0 * allowed, "{}: {:e}", method.name, after.drift);
    }
}

/// Checks the precession of a circular orbit's node by −3/2 n J₂ (R/p)² cos i, averaged over whole revolutions. Oscillations within a
/// revolution cancel, up to the second order in J₂.
#[test]
fn the_node_of_an_orbit_precesses() {
    let (j2, tilt, turns) = (1e-5, 0.7_f64, 20);
    let (sin, cos) = libm::sincos(tilt);
    for method in METHODS.iter().filter(|method| method.order >= 4) {
        let mut world = World::new();
        world.set_integrator(method);
        // The planet's axis is y. Its mass is 1; the moon's is negligible.
        let planet = world.add(ball());
        let moon = RigidBody::new(&Shape::Sphere { radius: 0.01 }, 1e-12);
        let moon = world.add(moon.with_location(DVec3::X).with_velocity(DVec3::new(0.0, sin, -cos)));
        let bodies = vec![planet, moon];
        world.add_force(Gravitation {
            bodies,
            against: None,
            constant: 1.0,
            softening: 0.0,
            opening_angle: None,
        });
        world.add_force(J2 { planet, bodies: vec![moon], j2, radius: 0.8, axis: DVec3::Y, constant: 1.0 });
        world.set_step(TAU / 1000.0);
        let node = |world: &World| {
            let state = world.state();
            let (x, v) = (state.location[1] - state.location[0], state.velocity[1] - state.velocity[0]);
            let normal = x.cross(v);
            // The ascending node is in the direction y × normal.
            let node = DVec3::Y.cross(normal);
            libm::atan2(-node.z, node.x)
        };
        let before = node(&world);
        world.advance_to(TAU * f64::from(turns));
        let rate = (node(&world) - before) / (TAU * f64::from(turns));
        let exact = -1.5 * j2 * 0.64 * cos;
        // The oblateness changes the duration of a revolution by 1e-5. The node's error is this fraction of its oscillation within one of
        // the 20 revolutions.
        assert!((rate / exact - 1.0).abs() < 1e-4, "{}: {rate:e} {exact:e}", method.name);
    }
}

/// Checks that a rotating planet gains the angular momentum that its moon loses.
#[test]
fn planet_and_moon_keep_their_momenta() {
    for method in METHODS {
        let mut world = World::new();
        world.set_integrator(method);
        let planet = Shape::Sphere { radius: 0.5 };
        let planet = world.add(RigidBody::new(&planet, 2.0).with_orientation(DQuat::from_rotation_z(0.6)));
        let moon = world.add(ball().with_location(1.5 * DVec3::X).with_velocity(DVec3::new(0.0, 0.2, 1.3)));
        world.add_force(Gravitation {
            bodies: vec![planet, moon],
            against: None,
            constant: 1.0,
            softening: 0.0,
            opening_angle: None,
        });
        world.add_force(J2 {
            planet,
            bodies: vec![moon],
            j2: 0.1,
            radius: 0.5,
            axis: DVec3::Y,
            constant: 1.0,
        });
        world.set_step(0.001);
        let before = world.balance();
        world.advance_to(2.0);
        let after = world.balance();
        let push = (after.linear_momentum - before.linear_momentum).length();
        let turn = (after.angular_momentum - before.angular_momentum).length();
        let allowed = tolerance(method, 6.0, 2000);
        assert!(push < 1e-12 && turn < allowed, "{}: {push:e} {turn:e}", method.name);
        assert!(after.drift.abs() < 10.0 * allowed, "{}: {:e}", method.name, after.drift);
    }
}
