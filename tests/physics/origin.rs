//! Tests that the origin of the world is a place like any other: machines whose joints are there, and the same machines elsewhere.

use glam::DVec3;

use crate::common::{frames, pressed_arm};

const PLACES: [DVec3; 3] = [DVec3::ZERO, DVec3::new(1.0, 1.0, -1.0), DVec3::new(-300.0, 1000.0, 40.0)];

/// A bead on a rod that turns at ω = 3 rad/s slides out: r = 0.2 cosh(ω t).
#[test]
fn a_bead_slides_out_on_a_turning_rod() {
    for place @ DVec3 { x, y, z } in PLACES {
        let frames = frames(&format!(
            "[simulation]
            duration = 1
            integrator = 'rk4'
            [body.rod]
            shape.cylinder = {{ radius = 0.02, height = 3 }}
            location = [{x}, {y}, {z}]
            orientation = [0, 0, 90]
            [body.bead]
            shape.sphere.radius = 0.06
            location = ['{x} + 0.2', {y}, {z}]
            velocity = [0, 0, -0.6]
            angular_velocity = [0, 3, 0]
            [joint.axle.hinge]
            between = [[{x}, {y}, {z}], 'rod']
            axis = [0, 1, 0]
            motor.angle = 'deg(3*t)'
            [joint.rail.slider]
            between = ['rod', 'bead']
            axis = [1, 0, 0]"
        ));
        for frame in &frames {
            let (radius, exact) =
                (frame.bodies[1].location.distance(place), 0.2 * libm::cosh(3.0 * frame.time));
            assert!((radius - exact).abs() < 1e-6, "{place}, t = {}: {radius} {exact}", frame.time);
        }
    }
}

/// A torque presses an arm on the rotor that carries it, so both turn as one body: ω = τ t / I.
#[test]
fn an_arm_pressed_on_its_rotor_turns_with_it() {
    // The moments of inertia of both boxes about their centers, and that of the arm's distance from the axle, kg m².
    let inertia = 4.0 / 12.0 * (4.0 + 0.04) + 1.0 / 12.0 * (1.0 + 0.01) + (0.5 * 0.5 + 0.151 * 0.151);
    for place in PLACES {
        let frames = pressed_arm(place, (1.0, 100, 0.004));
        let end = &frames[frames.len() - 1];
        let exact = 0.5 * 4.0 / inertia;
        // The arm first closes a gap of 1 mm, and hits the rotor.
        let kinetic = end.balance.kinetic;
        assert!((kinetic / exact - 1.0).abs() < 0.01, "{place}: {kinetic} {exact}");
    }
}

/// A contact holds the arm on its rotor, and its friction repeats what the joints say. 1 km away, coordinates are rounded to 1e-13 m. This
/// changes speeds by some 1e-11 m/s in each of 300 steps, so places after 1 s by less than 1e-9 m.
#[test]
fn a_pressed_arm_moves_alike_far_from_the_origin() {
    let runs = PLACES.map(|place| pressed_arm(place, (1.0, 10, 1.0 / 300.0)));
    for (place, run) in PLACES.iter().zip(&runs) {
        for (frame, first) in run.iter().zip(&runs[0]) {
            for (body, same) in frame.bodies.iter().zip(&first.bodies) {
                let apart = (body.location - *place).distance(same.location);
                assert!(apart < 1e-9, "{place}, t = {}: {apart:e}", frame.time);
            }
        }
    }
}

/// Seats that are bolted to a carousel stay where they are on it.
#[test]
fn bolted_seats_stay_on_a_carousel() {
    for place @ DVec3 { x, y, z } in PLACES {
        let frames = frames(&format!(
            "[simulation]
            duration = 5
            gravity = [0, -9.81, 0]
            [body.table]
            shape.cylinder = {{ radius = 1, height = 0.1 }}
            location = [{x}, {y}, {z}]
            [joint.axle.hinge]
            between = [[{x}, {y}, {z}], 'table']
            axis = [0, 1, 0]
            motor = {{ speed = 2, torque = 50 }}
            [body.seat]
            shape.box.size = [0.1, 0.5, 0.1]
            location = ['{x} + 0.8*cos(i*pi)', '{y} + 0.3', {z}]
            repeat = 2
            [joint.bolt.fixed]
            between = ['table', 'seat[i]']"
        ));
        let on_table = |frame: usize, seat: usize| {
            let bodies = &frames[frame].bodies;
            bodies[0].orientation.conjugate() * (bodies[seat].location - bodies[0].location)
        };
        for seat in [1, 2] {
            let moved = on_table(frames.len() - 1, seat).distance(on_table(0, seat));
            assert!(moved < 1e-9, "{place}: {moved:e}");
        }
        let speed = frames[frames.len() - 1].bodies[0].angular_velocity.y;
        assert!((speed - 2.0).abs() < 1e-9, "{place}: {speed}");
    }
}
