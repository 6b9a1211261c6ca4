//! Tests that equal runs agree bit for bit: after a reset, and next to clones of the world.

use glam::DVec3;
use jabuka::physics::{
    Anchor, ConstantForce, METHODS, Method, RigidBody, Shape, Spring, State, UniformGravity, World,
};

use crate::common::air;

/// Returns a world with bodies, forces and torques of many kinds.
fn build(method: &'static Method) -> World {
    let mut world = World::new();
    world.set_integrator(method);
    let ground = world.add(RigidBody::new(&Shape::Plane { normal: DVec3::Y }, 1.0));
    let mut last = ground;
    for k in 1..=5 {
        let x = f64::from(k);
        let body = RigidBody::new(&Shape::Box { size: DVec3::new(1.0, 0.3, 0.1 * x) }, x)
            .with_location(DVec3::new(x, 1.0, -0.3 * x))
            .with_velocity(DVec3::new(0.0, 0.1 * x, 1.0))
            .with_angular_velocity(DVec3::new(0.3, x, -0.1));
        let id = world.add(body);
        let between = [Anchor::centre(last), Anchor::centre(id)];
        world.add_force(Spring { between, stiffness: 20.0, damping: 0.3, rest_length: 0.8 });
        last = id;
    }
    world.add_force(UniformGravity { acceleration: DVec3::new(0.0, -9.81, 0.0) });
    world.add_force(air(last, 0.1));
    world.add_force(ConstantForce { bodies: vec![last], force: DVec3::X, torque: DVec3::Z });
    world
}

/// Advances the world frame by frame, and calls `each` after every frame. Returns the final state.
fn run(world: &mut World, frames: std::ops::Range<u32>, each: impl Fn(&mut World)) -> State {
    for frame in frames {
        world.advance_to(f64::from(frame) / 25.0);
        each(world);
    }
    world.state().clone()
}

#[test]
fn a_run_after_a_reset_is_the_first_run() {
    for method in METHODS {
        let run = || run(&mut build(method), 1..50, |_| {});
        let first = run();
        assert!(first.location.iter().all(|location| location.is_finite()), "{}", method.name);
        assert!(first == run(), "{}", method.name);
    }
}

/// Checks that observing balances and forces, and cloning the world between frames, do not change a run. A clone ends in the same state as
/// the original, even after the original is dropped.
#[test]
fn clones_and_measurements_leave_no_trace() {
    for method in METHODS {
        let undisturbed = run(&mut build(method), 1..50, |_| {});

        let mut world = build(method);
        let watched = run(&mut world, 1..50, |world| {
            let before = world.state().clone();
            let mut branch = world.clone();
            branch.advance_to(world.time() + 0.013);
            assert!(branch.state() != &before && world.state() == &before);
            world.balance();
            world.forces();
        });
        assert!(watched == undisturbed, "{}", method.name);

        let mut original = build(method);
        run(&mut original, 1..20, |_| {});
        let mut branch = original.clone();
        drop(original);
        assert!(run(&mut branch, 20..50, |_| {}) == undisturbed, "{}", method.name);
    }
}
