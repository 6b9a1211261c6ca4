//! Tests of conservation laws: momentum and angular momentum of a closed system.

use glam::DVec3;
use jabuka::physics::{Anchor, METHODS, RigidBody, Shape, Spring, World};

use crate::common::tolerance;

/// Returns a world with two spinning boxes that are connected by a damped spring, and no other forces. `ends` are the spring's ends in the
/// boxes' axes, m.
fn dumbbell(ends: [DVec3; 2]) -> World {
    let mut world = World::new();
    let shape = Shape::Box { size: DVec3::new(0.3, 0.5, 0.9) };
    let one = RigidBody::new(&shape, 1.0)
        .with_location(DVec3::new(1.0, 2.0, 0.0))
        .with_velocity(DVec3::new(0.0, 1.0, 0.5))
        .with_angular_velocity(DVec3::new(1.0, 2.0, 3.0));
    let two = RigidBody::new(&shape, 2.0).with_velocity(DVec3::new(0.3, 0.0, -0.5));
    let [first, second] = [world.add(one), world.add(two)];
    let between = [Anchor::Body { id: first, at: ends[0] }, Anchor::Body { id: second, at: ends[1] }];
    world.add_force(Spring { between, stiffness: 10.0, damping: 0.1, rest_length: 1.0 });
    world
}

/// Checks that momentum is conserved in every step of every method, up to rounding (2,400 steps, 1e-16 each): the forces on the two boxes
/// are opposite. Angular momentum about the origin is conserved up to rounding by kick-and-drift methods, whose forces act along the line
/// between the locations at which they are evaluated. For other methods it is conserved to their order.
#[test]
fn a_closed_system_keeps_its_momenta() {
    assert_momenta_are_kept([DVec3::ZERO; 2]);
}

/// Checks conservation with a spring that exerts torques: its torques on the two boxes about the origin are opposite.
#[test]
fn a_closed_system_that_is_joined_off_its_centres_keeps_its_momenta() {
    assert_momenta_are_kept([DVec3::new(0.15, -0.25, 0.45), DVec3::new(-0.1, 0.2, 0.3)]);
}

fn assert_momenta_are_kept(ends: [DVec3; 2]) {
    let (time, steps) = (10.0, 2400);
    for method in METHODS {
        let mut world = dumbbell(ends);
        world.set_integrator(method);
        let before = world.balance();
        world.advance_to(time);
        let after = world.balance();

        let off = (after.linear_momentum - before.linear_momentum).length();
        assert!(off < 1e-12, "{}: {off:e}", method.name);

        let off = (after.angular_momentum - before.angular_momentum).length();
        let kick_and_drift = ["euler-cromer", "velocity-verlet", "yoshida4"].contains(&method.name);
        // ω = √(k/μ) = √(10 / ⅔) = 3.9 rad/s; the angular momentum is about 4 kg m²/s.
        let allowed = if kick_and_drift { 1e-12 } else { 4.0 * tolerance(method, 3.9 * time, steps) };
        assert!(off < allowed, "{}: {off:e} > {allowed:e}", method.name);
    }
}

/// Checks that without a torque, angular momentum is constant to the last bit.
#[test]
fn a_free_body_keeps_its_angular_momentum_exactly() {
    for method in METHODS {
        let mut world = dumbbell([DVec3::ZERO; 2]);
        world.set_integrator(method);
        let before = world.state().angular_momentum.clone();
        world.advance_to(1.0);
        assert_eq!(world.state().angular_momentum, before, "{}", method.name);
        for orientation in &world.state().orientation {
            assert!((orientation.length() - 1.0).abs() < 1e-15, "{}", method.name);
        }
    }
}
