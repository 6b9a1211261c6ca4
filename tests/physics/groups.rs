//! Groups of bodies that do not meet are advanced one after another: that must change nothing.

use crate::common::frames;

/// Balls that spin, bounce and roll on a floor, three metres from each other; the first of them has number `first`.
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

/// Six balls far from each other move as each of them alone would, but for what counts as rest: that is 1e-8 of the fastest approach of all.
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

/// The first of six balls is so fast that it passes its impulse on to all of them within one step, although none is near the next: each
/// stops the one before where it was.
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
        // Where it was hit: a diameter before the next one.
        let place = if i == 0 { 0.8 } else { i as f64 + 0.8 };
        assert!((body.location.x - place).abs() < 1e-9, "{i}: {}", body.location.x);
        assert!(body.velocity.length() < 1e-9, "{i}: {}", body.velocity);
    }
    assert!((last[5].velocity.x - 200.0).abs() < 1e-9, "{}", last[5].velocity);
    // Five diameters of the way of 8 m are those that the impulse has jumped.
    assert!((last[5].location.x - (8.0 + 5.0 * 0.2)).abs() < 1e-9, "{}", last[5].location.x);
}
