//! Tests of bodies that exist for a limited time: they move, exert forces and count in balances only while they exist.

use glam::{DQuat, DVec3};
use jabuka::physics::{
    Anchor, BodyId, Coulomb, Drag, Dynamics, Gravitation, Kinematics, METHODS, Method, Motion, Presence,
    RigidBody, Snapshot, Spring, UniformGravity, World,
};

use crate::common::{ball, method};

const G: f64 = 10.0;

fn world(method: &'static Method, step: f64) -> World {
    let mut world = World::new();
    world.set_integrator(method);
    world.set_step(step);
    world
}

fn during(start: f64, end: f64) -> Presence {
    Presence::during(&[[start, end]])
}

/// Advances the world to the time `t`. Returns its snapshots at the given moments, and a last one at `t`.
#[allow(clippy::unwrap_used, reason = "only tests call it")]
fn seen(world: &mut World, t: f64, moments: &[f64]) -> Vec<Snapshot> {
    let mut seen = Vec::new();
    world.advance(t, moments, &mut |moment| seen.push(moment)).unwrap();
    seen.push(world.snapshot().unwrap());
    seen
}

/// Checks a body that is thrown up at its start time, 0.5 s, and observed 1.5 s later. First-order methods have the error ±½ g t dt; all
/// others are exact under a constant force. No regular step ends at 0.5 s.
#[test]
fn a_body_born_in_a_fall_moves_as_if_time_had_begun_then() {
    let (step, later) = (0.07, 1.5);
    for method in METHODS {
        let mut world = world(method, step);
        let id = world.add(ball().with_velocity(DVec3::new(1.0, 5.0, 0.0)));
        world.add_force(UniformGravity { acceleration: DVec3::NEG_Y * G });
        world.limit(id, &during(0.5, f64::INFINITY));
        let before = &seen(&mut world, 0.4, &[0.2])[..];
        for moment in before {
            let balance = moment.balance;
            assert!(moment.bodies.is_empty() && balance.total == 0.0 && balance.drift == 0.0);
            assert_eq!((balance.linear_momentum, balance.angular_momentum), (DVec3::ZERO, DVec3::ZERO));
        }
        let [born, end] = &seen(&mut world, 2.0, &[0.5])[..] else { panic!("two moments") };
        assert_eq!((born.bodies[0].location, born.bodies[0].velocity.y), (DVec3::ZERO, 5.0));
        assert_eq!((born.balance.kinetic, born.balance.drift), (13.0, 0.0));
        let exact = DVec3::new(later, 5.0 * later - 0.5 * G * later * later, 0.0);
        let allowed = if method.order == 1 { 0.5 * G * later * step } else { 1e-12 };
        let error = (end.bodies[0].location - exact).length();
        assert!(error <= allowed, "{}: {error}", method.name);
    }
}

/// Checks two attracting bodies of which one disappears after 1 s: from then on, the other moves in a straight line with a velocity that
/// is constant to the last bit.
#[test]
fn of_two_bodies_that_attract_each_other_one_leaves_and_the_other_goes_straight_on() {
    for method in METHODS {
        let build = || {
            let mut world = world(method, 0.01);
            let pair = [0.0, 3.0].map(|x| world.add(ball().with_location(DVec3::X * x)));
            let bodies = pair.to_vec();
            world.add_force(Gravitation {
                bodies,
                against: None,
                constant: 1.0,
                softening: 0.0,
                opening_angle: None,
            });
            (world, pair)
        };
        let (mut both, _) = build();
        let (mut world, [stays, leaves]) = build();
        world.limit(leaves, &during(f64::NEG_INFINITY, 1.0));
        for time in [0.3, 1.0] {
            assert_eq!(seen(&mut both, time, &[]), seen(&mut world, time, &[]), "{}", method.name);
        }
        let (place, velocity) = (world.location(stays), world.velocity(stays));
        assert!(velocity.x > 0.1, "they attract each other");
        let moments = seen(&mut world, 3.0, &[1.0 + 1e-9, 2.3]);
        for moment in &moments {
            let [body] = &moment.bodies[..] else { panic!("one is left") };
            assert_eq!((body.id, body.velocity, body.force), (stays.index(), velocity, DVec3::ZERO));
            let straight = place + velocity * (moment.time - 1.0);
            assert!(body.location.abs_diff_eq(straight, 1e-13), "{}", method.name);
            assert_eq!(moment.balance.linear_momentum, velocity);
        }
    }
}

/// Checks that the energy of appearing and disappearing bodies is accounted for, under gravity, drag, a spring and a torque. rk4 is exact
/// for gravity, and its other errors are far below rounding at this step. Without the accounts, each appearance would cause a drift of 0.1
/// or more.
#[test]
fn energy_that_comes_and_goes_with_bodies_is_no_drift() {
    let mut world = world(method("rk4"), 1e-3);
    let mut ids = Vec::new();
    for k in 0..6 {
        let x = f64::from(k);
        let body = ball().with_location(DVec3::new(x, 1.0, 0.0)).with_velocity(DVec3::new(1.0, x, -1.0));
        let id = world.add(body.with_angular_velocity(DVec3::Y).with_torque(DVec3::Y * 0.001));
        world.limit(id, &during(0.1 + 0.137 * x, 0.6 + 0.2 * x));
        ids.push(id);
    }
    world.add_force(UniformGravity { acceleration: DVec3::NEG_Y * G });
    world.add_force(Drag { bodies: ids.clone(), linear: 0.1, quadratic: 0.01, wind: DVec3::X });
    let between = [Anchor::centre(ids[1]), Anchor::centre(ids[2])];
    world.add_force(Spring { between, stiffness: 5.0, damping: 0.1, rest_length: 1.0 });
    let mut counts = Vec::new();
    for frame in 1..=50 {
        let time = f64::from(frame) / 25.0;
        for moment in seen(&mut world, time, &[time - 0.021]) {
            assert!(moment.balance.drift.abs() < 1e-11, "{} at {time}", moment.balance.drift);
            counts.push(moment.bodies.len());
        }
    }
    assert_eq!((counts.iter().min(), counts.iter().max(), counts.last()), (Some(&0), Some(&5), Some(&0)));
}

/// Checks that absent bodies do not change a bit of the present ones. The absent ones include two bodies at the same place, whose
/// attraction is undefined, in a wind.
#[test]
fn nothing_acts_on_what_is_not_there_and_nothing_comes_from_it() {
    for method in METHODS {
        let run = |absent: usize| {
            let mut world = world(method, 0.01);
            let body = ball().with_charge(1.0).with_velocity(DVec3::Z);
            let mut ids = vec![world.add(body), world.add(body.with_location(DVec3::X))];
            for k in 0..absent {
                let torque = body.with_torque(DVec3::X).with_force(DVec3::Y).with_location(DVec3::Y * 2.0);
                let id = world.add(torque.with_fixed(k == 2));
                if k == 1 {
                    world.drive(id, Rolling);
                }
                world.limit(id, &during(9.0, 10.0));
                let between = [Anchor::centre(id), Anchor::centre(ids[0])];
                world.add_force(Spring { between, stiffness: 50.0, damping: 1.0, rest_length: 0.3 });
                ids.push(id);
            }
            world.add_force(Gravitation {
                bodies: ids.clone(),
                against: None,
                constant: 2.0,
                softening: 0.0,
                opening_angle: None,
            });
            let (one, others) = (vec![ids[0]], ids[1..].to_vec());
            world.add_force(Coulomb { bodies: one, against: Some(others), constant: 1.0, softening: 0.0 });
            world.add_force(Drag { bodies: ids, linear: 0.3, quadratic: 0.1, wind: DVec3::Y });
            world.add_force(UniformGravity { acceleration: DVec3::NEG_Y });
            seen(&mut world, 1.0, &[0.123])
        };
        assert_eq!(run(0), run(4), "{}", method.name);
    }
}

/// A prescribed motion along x at 1 m/s with rotation.
struct Rolling;

impl Motion for Rolling {
    fn at(&self, t: f64) -> Kinematics {
        Kinematics {
            location: DVec3::X * t,
            velocity: DVec3::X,
            acceleration: DVec3::ZERO,
            orientation: DQuat::from_rotation_z(-t),
            angular_velocity: DVec3::NEG_Z,
        }
    }

    fn angular_acceleration(&self, _: f64) -> DVec3 {
        DVec3::ZERO
    }
}

/// Checks that a guided body reappears where its prescribed motion is. Steps end at appearances only if the world has free bodies; the
/// result is the same in both cases.
#[test]
fn a_guided_body_comes_back_where_its_motion_has_it() {
    for is_alone in [true, false] {
        let mut world = world(method("rk4"), if is_alone { f64::INFINITY } else { 0.01 });
        let id = world.add(ball());
        world.drive(id, Rolling);
        world.limit(id, &Presence::during(&[[0.1, 0.2], [0.55, 0.55], [0.7, 2.0]]));
        let free = (!is_alone).then(|| world.add(ball()));
        let moments = [0.05, 0.1, 0.15, 0.2, 0.3, 0.55, 0.6, 0.7, 0.9];
        for moment in seen(&mut world, 1.0, &moments) {
            let t = moment.time;
            let is_there = [0.1, 0.15, 0.2, 0.55, 0.7, 0.9, 1.0].contains(&t);
            let body = moment.body(id.index());
            assert_eq!(body.is_some(), is_there, "{t}");
            if let Some(body) = body {
                assert_eq!((body.location, body.velocity), (DVec3::X * t, DVec3::X));
                assert!(body.angular_velocity.abs_diff_eq(DVec3::NEG_Z, 1e-15));
            }
            assert_eq!(moment.bodies.len(), usize::from(is_there) + usize::from(free.is_some()));
        }
    }
}

/// Checks that the appearances of n guided bodies add no steps; otherwise n bodies would cost n² work.
#[test]
fn births_of_guided_bodies_take_no_steps_of_their_own() {
    let mut world = world(&METHODS[0], f64::INFINITY);
    for k in 0..100 {
        let id = world.add(ball());
        world.drive(id, Rolling);
        world.limit(id, &during(0.01 * f64::from(k), 0.5 + 0.01 * f64::from(k)));
    }
    let mut there = Vec::new();
    for frame in 1..=10u32 {
        let time = 0.1 * f64::from(frame);
        there.extend(seen(&mut world, time, &[]).iter().map(|moment| moment.bodies.len()));
        assert_eq!(world.steps(), u64::from(frame));
    }
    assert_eq!((there[0], there[9]), (11, 50));
}

/// Checks that observing moments does not change a run, even if a moment coincides with an appearance, or bodies appear between two
/// moments.
#[test]
fn looking_at_moments_changes_nothing() {
    for (method, is_given) in METHODS.iter().flat_map(|method| [(method, false), (method, true)]) {
        let build = || {
            let mut world = world(method, if is_given { f64::INFINITY } else { 0.03 });
            let mut ids: Vec<BodyId> = Vec::new();
            for k in 0..5 {
                let body: RigidBody = ball().with_location(DVec3::Y * f64::from(k));
                let id = world.add(body.with_velocity(DVec3::X));
                if is_given {
                    world.drive(id, Rolling);
                }
                world.limit(id, &during(0.1 * f64::from(k), 0.15 + 0.1 * f64::from(k)));
                ids.push(id);
            }
            world.add_force(Gravitation {
                bodies: ids,
                against: None,
                constant: 1.0,
                softening: 0.1,
                opening_angle: None,
            });
            // Add a force, so that guided bodies do work; the sum of this work depends on the steps.
            world.add_force(UniformGravity { acceleration: DVec3::X });
            world
        };
        let (mut plain, mut watched) = (build(), build());
        for frame in 1..=25 {
            let time = f64::from(frame) / 25.0;
            let moments = [time - 0.03, time - 0.02, time - 1e-3];
            let end = seen(&mut watched, time, &moments).pop();
            assert_eq!(end, seen(&mut plain, time, &[]).pop(), "{} at {time}", method.name);
        }
        let [before, at, end] = &seen(&mut build(), 0.25, &[0.1 - 1e-9, 0.1])[..] else { panic!("three") };
        assert_eq!([before, at, end].map(|moment| moment.bodies.len()), [1, 2, 2]);
    }
}
