//! Tests of groups of distant bodies, which are advanced one after another: grouping must not change the result.

use crate::common::frames;

/// Returns a scene with balls that spin, bounce and roll on a floor, 3 m apart. The first of them has the number `first`.
fn balls(count: usize, first: usize) -> String {
    format!(
        r#"
        [simulation]
        duration = 0.8
        frame_rate = 50
        integrator = "velocity-verlet"
        gravity = [0, -9.81, 0]
        contacts = "event-driven"
        [defaults.body]
        restitution = 0.3
        friction = 0.4
        [body.ball]
        repeat = {count}
        shape.sphere.radius = 0.1
        mass = 1
        location = ["3*(i + {first})", "0.4 + 0.03*(i + {first})", 0]
        angular_velocity = ["1 + 0.3*(i + {first})", 0, 2]
        "#
    )
}

/// Checks that six distant balls move like each of them alone. They differ only by the threshold of rest, which is 1e-8 of the fastest
/// approach of all bodies.
#[test]
fn what_is_far_away_has_no_influence() {
    let together = frames(&balls(6, 0));
    assert!(together.iter().any(|frame| frame.balance.accounts.impacts < -1.0), "nothing has hit the floor");
    for i in 0..6 {
        for (one, all) in frames(&balls(1, i)).iter().zip(&together) {
            let (one, all) = (&one.bodies[0], &all.bodies[i]);
            assert!((one.location - all.location).length() < 1e-7, "{i}: {} {}", one.location, all.location);
        }
    }
}

/// Checks an impulse that passes through six separate balls within one step: each ball stops where it hits the next one, although the
/// balls are far apart.
#[test]
fn an_impulse_goes_through_all_groups_within_a_step() {
    let frames = frames(
        r#"
        [simulation]
        duration = 0.04
        frame_rate = 25
        step = 0.04
        integrator = "velocity-verlet"
        contacts = "event-driven"
        [defaults.body]
        restitution = 1
        friction = 0
        [body.ball]
        repeat = 6
        shape.sphere.radius = 0.1
        mass = 1
        location = ["i", 1, 0]
        velocity = ["if(i == 0, 200, 0)", 0, 0]
        [body.floor]
        shape.box.size = [20, 0.2, 2]
        location = [0, -1, 0]
        fixed = true
        "#,
    );
    let last = &frames[1].bodies;
    for (i, body) in last[..5].iter().enumerate() {
        // The ball stops one diameter before the center of the next ball.
        let place = if i == 0 { 0.8 } else { i as f64 + 0.8 };
        assert!((body.location.x - place).abs() < 1e-9, "{i}: {}", body.location.x);
        assert!(body.velocity.length() < 1e-9, "{i}: {}", body.velocity);
    }
    assert!((last[5].velocity.x - 200.0).abs() < 1e-9, "{}", last[5].velocity);
    // The impulse covers 8 m of free path, plus one diameter in each of five impacts.
    assert!((last[5].location.x - (8.0 + 5.0 * 0.2)).abs() < 1e-9, "{}", last[5].location.x);
}
