//! Tests of the order of simultaneous impacts, of impacts at several points, and of the last bounce, against closed forms.

use glam::DVec3;
use jabuka::physics::{BodyId, Shape, Surface, World};

use crate::common::{frames, method};
use crate::contacts::{G, Table, advance, exact, surface};

/// Returns a world with three equal balls that touch in a row along x, with these velocities along x in m/s.
fn row(velocities: [f64; 3], restitution: f64) -> (World, [BodyId; 3]) {
    let mut table = Table::new(method("velocity-verlet"), false);
    let balls = std::array::from_fn(|i| {
        let place = DVec3::new(0.2 * (i as f64 - 1.0), 0.0, 0.0);
        table.add(Shape::Sphere { radius: 0.1 }, 1.0, surface(restitution, 0.0), |body| {
            body.with_location(place).with_velocity(velocities[i] * DVec3::X)
        })
    });
    (table.build(), balls)
}

/// Applies the impact between the balls i and i + 1 of equal mass to the velocities `v`.
fn hit(v: &mut [f64; 3], i: usize, restitution: f64) {
    let (mean, half) = (0.5 * (v[i] + v[i + 1]), 0.5 * restitution * (v[i] - v[i + 1]));
    (v[i], v[i + 1]) = (mean - half, mean + half);
}

/// Checks the order of simultaneous impacts: the fastest approach comes first; of equally fast ones, that of the bodies with the smaller
/// numbers. With a restitution of 1/2, the result shows the order: 1, 0, −1 m/s become −23/64, 3/64 and 5/16 m/s, not the mirror image of
/// these.
#[test]
fn of_impacts_at_one_instant_the_fastest_comes_first_and_then_the_first() {
    for (start, first) in [([1.0, 0.0, -1.0], 0), ([1.0, 0.0, -2.0], 1), ([2.0, 0.0, -1.0], 0)] {
        let (mut world, balls) = row(start, 0.5);
        advance(&mut world, 1e-3);
        let mut expected = start;
        hit(&mut expected, first, 0.5);
        loop {
            let approach = |i: usize| expected[i] - expected[i + 1];
            let next = if approach(1) > approach(0) { 1 } else { 0 };
            if approach(next) <= 0.0 {
                break;
            }
            hit(&mut expected, next, 0.5);
        }
        for (ball, expected) in balls.iter().zip(expected) {
            let off = world.velocity(*ball) - expected * DVec3::X;
            assert!(off.length() < 1e-14, "{start:?}: {} {expected}", world.velocity(*ball));
        }
    }
    let mut known = [1.0, 0.0, -1.0];
    [0, 1, 0].into_iter().for_each(|i| hit(&mut known, i, 0.5));
    assert_eq!(known, [-23.0 / 64.0, 3.0 / 64.0, 5.0 / 16.0]);
}

/// Checks that a fast impact elsewhere changes no slow impact: a ball of 5 mm/s meets two that touch, so the first two balls have several
/// impacts at one instant. The fast impact, at 200 m/s, is before them.
#[test]
fn a_fast_impact_elsewhere_changes_no_slow_one() {
    let run = |is_one_fast: bool| {
        let mut table = Table::new(method("velocity-verlet"), false);
        let mut ball = |place: DVec3, speed: f64| {
            table.add(Shape::Sphere { radius: 0.1 }, 1.0, surface(0.9, 0.0), |body| {
                body.with_location(place).with_velocity(speed * DVec3::X)
            })
        };
        let slow = [(-0.2005, 0.005), (0.0, 0.0), (0.2, 0.0)].map(|(x, speed)| ball(x * DVec3::X, speed));
        if is_one_fast {
            for side in [-1.0, 1.0] {
                ball(DVec3::new(side, 1000.0, 0.0), -side * 100.0);
            }
        }
        let mut world = table.build();
        advance(&mut world, 0.2);
        slow.map(|ball| world.velocity(ball))
    };
    let alone = run(false);
    assert!(alone[0].x < alone[1].x && alone[1].x < alone[2].x, "{alone:?}");
    assert_eq!(run(true), alone);
}

/// Checks the time at which a bouncing ball comes to rest: at the first impact with a rebound slower than 1e-8 of the fastest impact of
/// the run. This fastest impact is between two other balls, at 2,000 m/s. The ball's impact n is at √(2h/g) (1 + 2 Σ eᵏ), k from 1 to n.
#[test]
fn a_ball_rests_from_the_impact_on_whose_rebound_nobody_could_see() {
    for (method, restitution) in exact().into_iter().flat_map(|m| [0.3, 0.5, 0.8].map(|e| (m, e))) {
        let mut table = Table::new(method, true);
        table.floor(Surface::default());
        let mut ball = |place: DVec3, velocity: DVec3, restitution: f64| {
            table.add(Shape::Sphere { radius: 0.1 }, 1.0, surface(restitution, 0.0), |body| {
                body.with_location(place).with_velocity(velocity)
            })
        };
        let slow = ball(DVec3::new(0.0, 1.1, 0.0), DVec3::ZERO, restitution);
        for side in [-1.0, 1.0] {
            ball(DVec3::new(side, 1000.0, 0.0), -side * 1000.0 * DVec3::X, 1.0);
        }
        let mut world = table.build();
        let fall = (2.0 / G).sqrt();
        let (mut time, mut rebound) = (fall, restitution);
        while G * fall * rebound > 1e-8 * 2000.0 {
            time += 2.0 * fall * rebound;
            rebound *= restitution;
        }
        // The duration of the flight that would follow the last impact.
        let flight = 2.0 * fall * rebound;
        advance(&mut world, time - 0.3 * flight);
        assert!(world.velocity(slow) != DVec3::ZERO, "{} {restitution}", method.name);
        advance(&mut world, time + 0.3 * flight);
        assert_eq!(world.velocity(slow), DVec3::ZERO, "{} {restitution}", method.name);
    }
}

/// Checks a block on a vertical rail that falls into a corner, from 0.75 m above the floor of the corner, and slides along its wall. It
/// can only move along the rail, so the impact has no effect along all other directions at the contact points. The block rebounds to
/// e² h = 0.1875 m. The tallest of 100 frames a second is lower by at most g/8 / 100² = 1.2e-4 m.
#[test]
fn a_block_on_a_rail_rebounds_from_a_corner() {
    let frames = frames(
        r#"
        [simulation]
        duration = 0.7
        frame_rate = 100
        integrator = "rk4"
        gravity = [0, -9.81, 0]
        contacts = "event-driven"
        [body.corner]
        shape.compound.parts = [
            { box.size = [2, 0.2, 1], location = [0, -0.1, 0] },
            { box.size = [0.2, 2, 1], location = [-0.6, 0.9, 0] },
        ]
        location = [-0.3, 0.4, 0]
        fixed = true
        [body.block]
        shape.box.size = [1, 0.5, 0.5]
        location = [0, 1, 0]
        friction = 0.5
        restitution = 0.5
        [joint.guide.slider]
        between = [[0, 0, 0], "block"]
        axis = [0, 1, 0]
        "#,
    );
    let heights = frames.iter().map(|frame| frame.bodies[1].location.y - 0.25);
    let (lowest, highest) =
        heights.skip(40).fold((f64::MAX, 0.0), |(low, high): (f64, f64), y| (low.min(y), high.max(y)));
    assert!(lowest > -1e-9 && (highest - 0.1875).abs() < 1.5e-4, "{lowest} {highest}");
}
