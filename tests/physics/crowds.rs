//! Tests of two cases in which event-driven contacts are replaced: bodies with too many events are advanced by time-stepping, and bodies
//! at rest are held in place.

use crate::common::{boxes_that_a_ball_hits, drift, frames};

/// Checks the energy balance of a falling chain. Its links hit each other and the floor thousands of times within 0.01 s. With
/// velocity-Verlet, the accounts have a relative error of the square of the step: ω² h² / 24 = 2e-5 for ω = 5/s.
#[test]
fn a_chain_falls_flat_and_its_energy_is_balanced() {
    let frames = frames(
        r#"
        [simulation]
        duration = 1.2
        frame_rate = 50
        integrator = "velocity-verlet"
        gravity = [0, -9.81, 0]
        contacts = "event-driven"
        [body.link]
        repeat = 8
        shape.capsule = { radius = 0.03, height = 0.3 }
        location = ["0.32*i", "0.4+0.02*i", 0]
        orientation = [0, 0, 90]
        mass = 0.1
        [joint.link.ball]
        between = ["link[i]", "link[i+1]"]
        at = ["0.32*i + 0.16", "0.41+0.02*i", 0]
        "#,
    );
    assert!(drift(&frames) < 2e-5, "{:e}", drift(&frames));
    let (first, last) = (&frames[0].balance, &frames[frames.len() - 1]);
    // At the end each link lies on the floor, and the potential energy of the fall has been dissipated.
    let lost = -last.balance.accounts.impacts - last.balance.accounts.friction;
    assert!(lost > 0.8 * (first.potential - last.balance.potential), "{lost}");
    for body in &last.bodies[..8] {
        assert!(body.location.y > 0.029 && body.location.y < 0.05, "{}", body.location.y);
    }
}

/// Checks three balls that are pushed apart by a fourth above them, with slow slip at several contacts at once. Friction stops the slip
/// within a step, so the fourth order of rk4 is kept.
#[test]
fn slow_slips_come_to_an_end() {
    let frames = frames(
        r#"
        [simulation]
        duration = 0.36
        frame_rate = 25
        step = 0.004
        integrator = "rk4"
        gravity = [0, -9.81, 0]
        contacts = "event-driven"
        [body.b]
        repeat = 3
        shape.sphere.radius = 0.1
        mass = 1
        location = ["0.12*cos(2*pi*i/3)", 0.1, "0.12*sin(2*pi*i/3)"]
        friction = 0.5
        [body.top]
        shape.sphere.radius = 0.1
        mass = 1
        location = [0, 0.5, 0]
        "#,
    );
    assert!(drift(&frames) < 1e-6, "{:e}", drift(&frames));
}

/// Checks that standing boxes are held without changing a bit until a ball hits them. Then they move, and their energy is balanced.
#[test]
fn what_stands_still_is_held_until_something_hits_it() {
    let frames = boxes_that_a_ball_hits(
        r#"integrator = "velocity-verlet"
        contacts = "event-driven""#,
    );
    let early: Vec<_> = frames.iter().filter(|frame| frame.time > 0.1 && frame.time < 0.5).collect();
    for frame in &early {
        assert_eq!(frame.bodies[..2], early[0].bodies[..2], "{}", frame.time);
    }
    // The floor's force on the lower box equals the weight of both boxes, also while the boxes are held.
    let on_floor = early[5]
        .contacts
        .iter()
        .filter(|contact| contact.bodies[1] != 1)
        .map(|contact| contact.force.length());
    assert!((on_floor.sum::<f64>() - 2.0 * 9.81).abs() < 1e-6);
    let last = &frames[frames.len() - 1];
    assert!((last.bodies[1].location - early[0].bodies[1].location).length() > 1e-3, "it was not hit");
    assert!(drift(&frames) < 2e-5, "{:e}", drift(&frames));
}
