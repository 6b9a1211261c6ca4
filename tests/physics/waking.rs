//! Tests of bodies that have come to rest on others, and are held there until something moves them: it must find them, whatever it is.
//!
//! In each scene, a box rests for at least 0.4 s. It is held in place long before something reaches it.

use glam::DVec3;
use jabuka::simulate::Frame;

use crate::common::frames;

const G: f64 = 9.81;
/// The length of a step, s: a twelfth of a frame.
const STEP: f64 = 1.0 / 240.0;

/// Simulates a cube of 1 kg and 1 m on the ground, with its center at the origin of x, together with `rest`.
fn beside_a_box(duration: f64, friction: f64, rest: &str) -> Vec<Frame> {
    frames(&format!(
        "[simulation]
        duration = {duration}
        frame_rate = 20
        gravity = [0, -{G}, 0]
        contacts = 'event-driven'
        integrator = 'velocity-verlet'
        [environment]
        ground = {{ height = 0, friction = {friction} }}
        [defaults.body]
        friction = {friction}
        [body.box]
        shape.box.size = [1, 1, 1]
        location = [0, 0.5, 0]
        mass = 1
        {rest}"
    ))
}

/// Returns the place of the cube in the last frame, after making sure that it rested in the frame at `rests`, s.
fn end_of_box(frames: &[Frame], rests: f64) -> DVec3 {
    for frame in frames.iter().filter(|frame| frame.time <= rests + 1e-9) {
        assert!((frame.bodies[0].location - DVec3::Y * 0.5).length() < 1e-9, "t = {}", frame.time);
    }
    frames[frames.len() - 1].bodies[0].location
}

/// A guided plate reaches the cube at 0.5 s with 1 m/s and pushes it on. The work of the guide covers the kinetic energy and the friction.
#[test]
fn a_guided_body_pushes_what_rests() {
    for axis in 0..2 {
        let along = |text: &str| {
            if axis == 0 { format!("['{text}', 0.5, 0]") } else { format!("[0, 0.5, '{text}']") }
        };
        let frames = beside_a_box(
            2.0,
            0.5,
            &format!(
                "[body.pusher]
                shape.box.size = [0.2, 0.6, 0.2]
                friction = 0
                motion.formula.location = {}",
                along("-1.1 + t")
            ),
        );
        let end = end_of_box(&frames, 0.5);
        let exact = DVec3::Y * 0.5 + 1.5 * if axis == 0 { DVec3::X } else { DVec3::Z };
        assert!((end - exact).length() < 1e-9, "{end}");
        let balance = frames[frames.len() - 1].balance;
        let friction = balance.accounts.friction + 0.5 * G * 1.5;
        assert!(balance.drift.abs() < 1e-9 && friction.abs() < 1e-6, "{:e} {friction:e}", balance.drift);
    }
}

/// A plate rests on two blocks. A guided piston comes up between them, reaches the plate at 0.5 s, and carries it at 1 m/s.
#[test]
fn a_guided_body_lifts_what_rests() {
    let frames = beside_a_box(
        1.5,
        0.0,
        "[body.block]
        repeat = 2
        shape.box.size = [0.2, 1.5, 1]
        location = ['3 + 4*i', 0.75, 0]
        [body.plate]
        shape.box.size = [4.4, 0.1, 1]
        location = [5, 1.55, 0]
        mass = 2
        [body.piston]
        shape.box.size = [3, 0.2, 0.4]
        motion.formula.location = [5, '0.9 + t', 0]",
    );
    end_of_box(&frames, 1.5);
    for frame in &frames {
        let height = frame.bodies[3].location.y - 1.55;
        let exact = (frame.time - 0.5).max(0.0);
        assert!((height - exact).abs() < 1e-9, "t = {}: {height} {exact}", frame.time);
    }
}

/// A ball flies against the cube at the height of its center, with the same mass. Without friction and losses, the cube takes over the ball's velocity along x.
#[test]
fn a_flying_ball_moves_what_rests() {
    let frames = beside_a_box(
        1.2,
        0.0,
        "restitution = 1
        [body.ball]
        shape.sphere.radius = 0.1
        mass = 1
        location = [-1.6, '0.5 + 9.81/8', 0]
        velocity = [2, 0, 0]
        restitution = 1",
    );
    let end = end_of_box(&frames, 0.5);
    assert!((end - DVec3::new(1.4, 0.5, 0.0)).length() < 1e-6, "{end}");
}

/// A ball on a rod swings down from an angle of 60° and hits the cube at its lowest point, with v² = g L. The cube takes over its velocity.
#[test]
fn a_ball_on_a_joint_moves_what_rests() {
    let frames = beside_a_box(
        1.5,
        0.0,
        "restitution = 1
        [body.bob]
        shape.sphere.radius = 0.1
        mass = 1
        location = ['-0.6 - 2*sin(pi/3)', '2.5 - 2*cos(pi/3)', 0]
        restitution = 1
        [joint.rod.rod]
        between = [[-0.6, 2.5, 0], 'bob']",
    );
    end_of_box(&frames, 0.75);
    let speed = frames[frames.len() - 1].bodies[0].velocity.x;
    let exact = (2.0 * G).sqrt();
    // The method's error is of the order of (ω h)² / 24 with ω = 2.2/s and h = 1/240 s.
    assert!((speed / exact - 1.0).abs() < 1e-4, "{speed} {exact}");
}

/// A slack rope hangs from a guided hook that rises at 1 m/s. When the rope becomes taut at 0.5 s, it lifts the cube.
#[test]
fn a_rope_that_becomes_taut_lifts_what_rests() {
    let frames = beside_a_box(
        1.0,
        0.5,
        "[body.hook]
        shape.sphere.radius = 0.1
        motion.formula.location = [0, '1.5 + t', 0]
        collides = false
        [joint.line.rope]
        between = ['hook', 'box']
        length = 1.5",
    );
    let end = end_of_box(&frames, 0.5);
    assert!((end - DVec3::Y).length() < 1e-9, "{end}");
}

/// A guided hand pulls the cube by a spring of 10 N/m, from its rest length on, at 1 m/s. The cube begins to slide at t₀, when the spring
/// pulls with μ m g. From then on, x = (t − t₀) − sin ω(t − t₀) / ω. The cube stands on four points, whose friction may hold it until the
/// end of the step.
#[test]
fn a_spring_that_tightens_moves_what_rests() {
    let frames = beside_a_box(
        1.0,
        0.5,
        "[body.hand]
        shape.sphere.radius = 0.1
        motion.formula.location = ['2 + t', 0.5, 0]
        collides = false
        [force.band.spring]
        between = ['box', 'hand']
        stiffness = 10
        rest_length = 2",
    );
    let (start, omega) = (0.05 * G, 10.0_f64.sqrt());
    let end = end_of_box(&frames, 0.45);
    let exact = (1.0 - start) - libm::sin(omega * (1.0 - start)) / omega;
    assert!((end - DVec3::new(exact, 0.5, 0.0)).length() < 1.04 * STEP, "{end} {exact}");
}

/// A force grows with time, or sets in at a moment. The cube slides as soon as the force exceeds μ m g, or at the end of that step.
#[test]
fn a_force_that_changes_moves_what_rests() {
    for (force, exact) in [
        ("10*t", 10.0 * (1.0 - 0.05 * G) * (1.0 - 0.05 * G) * (1.0 - 0.05 * G) / 6.0),
        ("if(t < 0.5, 0, 20)", 0.5 * (20.0 - 0.5 * G) * 0.25),
    ] {
        let frames =
            beside_a_box(1.0, 0.5, &format!("[force.push.formula]\non = ['box']\nforce = ['{force}', 0, 0]"));
        let end = end_of_box(&frames, 0.45);
        let speed = frames[frames.len() - 1].bodies[0].velocity.x;
        assert!((end - DVec3::new(exact, 0.5, 0.0)).length() < speed * STEP, "{force}: {end} {exact}");
    }
}

/// A ball appears at 0.5 s, right beside the cube, and flies against it. Another cube loses its support when it disappears.
#[test]
fn births_and_deaths_move_what_rests() {
    let frames = beside_a_box(
        1.0,
        0.0,
        "restitution = 1
        [body.ball]
        shape.sphere.radius = 0.1
        mass = 1
        location = [-0.6, 0.5, 0]
        velocity = [2, 0, 0]
        restitution = 1
        start = 0.5",
    );
    let end = end_of_box(&frames, 0.5);
    assert!((end - DVec3::new(1.0, 0.5, 0.0)).length() < 1e-9, "{end}");
    let frames = beside_a_box(
        0.8,
        0.5,
        "[body.stool]
        shape.box.size = [1, 1, 1]
        location = [5, 0.5, 0]
        end = 0.5
        [body.load]
        shape.box.size = [1, 1, 1]
        location = [5, 1.5, 0]",
    );
    end_of_box(&frames, 0.8);
    let height = frames[frames.len() - 1].bodies[1].location.y;
    assert!((height - (1.5 - 0.5 * G * 0.09)).abs() < 1e-6, "{height}");
}

/// A plate touches the cube at its side and does not push it, whatever its shape. Nothing moves until the plate does.
#[test]
fn what_rests_beside_a_guided_body_stays() {
    for shape in [
        "box.size = [0.2, 0.6, 0.4]",
        "box.size = [0.2, 0.6, 1]",
        "box.size = [0.2, 1, 1]",
        "sphere.radius = 0.1",
        "cylinder = { radius = 0.1, height = 0.6 }",
    ] {
        for (motion, end) in [("-0.6", 0.0), ("-0.6 - max(0, t - 1)", 0.0), ("-0.6 + max(0, t - 1)", 0.5)] {
            let frames = beside_a_box(
                1.5,
                0.5,
                &format!("[body.plate]\nshape.{shape}\nmotion.formula.location = ['{motion}', 0.5, 0]"),
            );
            let found = end_of_box(&frames, 1.0);
            assert!((found - DVec3::new(end, 0.5, 0.0)).length() < 1e-9, "{shape}, {motion}: {found}");
        }
    }
}

/// A plate pushes the cube at 1 m/s from 0.5 s on, and stops suddenly at 1 s. The cube slides on: a contact cannot pull.
#[test]
fn what_a_body_pushes_goes_on_when_it_stops() {
    for motion in [
        "min(-1.1 + t, -0.1)",
        "if(t < 1, -1.1 + t, -0.1)",
        "if(t < 1, -1.1 + t, -0.1 - 3*(t - 1))",
        "min(-1.1 + t, -0.1037)",
    ] {
        let frames = beside_a_box(
            2.0,
            0.0,
            &format!(
                "[body.pusher]
                shape.box.size = [0.2, 0.6, 0.2]
                motion.formula.location = ['{motion}', 0.5, 0]"
            ),
        );
        let end = end_of_box(&frames, 0.5);
        assert!((end - DVec3::new(1.5, 0.5, 0.0)).length() < 1e-9, "{motion}: {end}");
        let drift = frames[frames.len() - 1].balance.drift;
        assert!(drift.abs() < 1e-9, "{motion}: {drift:e}");
    }
}

/// A table is pulled away at 5 m/s, or rises at 2 m/s and stops at once. The ball on it falls, or flies on. A table that falls at 1 m/s is
/// caught up with: the ball comes down on it after 2 · 1 m/s / g.
#[test]
fn what_lies_on_a_table_that_changes_its_speed_falls() {
    for (motion, start, speed) in [
        ("if(t < 0.5, 0, -5*(t - 0.5))", 0.5, 0.0),
        ("if(t < 0.5, 2*t, 1)", 0.5, 2.0),
        ("if(t < 0.51, 2*t, 1.02 - 10*(t - 0.51))", 0.51, 2.0),
        ("-max(0, t - 0.5)", 0.5, 0.0),
    ] {
        let frames = frames(&format!(
            "[simulation]
            duration = 1
            frame_rate = 20
            gravity = [0, -{G}, 0]
            contacts = 'event-driven'
            [environment]
            ground = false
            [body.table]
            shape.box.size = [2, 0.2, 2]
            motion.formula.location = [0, '{motion}', 0]
            [body.ball]
            shape.sphere.radius = 0.3
            location = [0, 0.4, 0]"
        ));
        for frame in &frames {
            let (table, ball) = (frame.bodies[0].location.y, frame.bodies[1].location.y - 0.4);
            let free = (frame.time - start).max(0.0);
            let flight = speed * start + speed * free - 0.5 * G * free * free;
            // Without restitution, the ball stays on the table once it has come down.
            let exact = if free > 0.0 { flight.max(table) } else { table };
            assert!((ball - exact).abs() < 1e-6, "{motion}, t = {}: {ball} {exact}", frame.time);
        }
    }
}

/// A hook lifts a ball on a taut rope at 2 m/s, and stops at once. The ball rises on, and the rope becomes slack.
#[test]
fn what_hangs_on_a_rope_rises_on_when_its_hook_stops() {
    let frames = frames(&format!(
        "[simulation]
        duration = 0.8
        frame_rate = 20
        gravity = [0, -{G}, 0]
        [body.hook]
        shape.sphere.radius = 0.1
        motion.formula.location = [0, 'min(2*t, 1)', 0]
        [body.ball]
        shape.sphere.radius = 0.1
        location = [0, -1, 0]
        velocity = [0, 2, 0]
        [joint.line.rope]
        between = ['hook', 'ball']
        length = 1"
    ));
    for frame in &frames {
        let free = (frame.time - 0.5).clamp(0.0, 4.0 / G);
        let exact = -1.0 + (2.0 * frame.time).min(1.0) + 2.0 * free - 0.5 * G * free * free;
        let height = frame.bodies[1].location.y;
        assert!((height - exact).abs() < 1e-6, "t = {}: {height} {exact}", frame.time);
    }
}

/// Four dominoes stand at a distance of 0.5 m, and a heavy ball hits the first. Long after the last one has come to rest, the third one
/// falls against it. The exact end has been computed with a contact solver of another program, at a fine step.
#[test]
fn dominoes_that_wait_fall_to_the_last() {
    let frames = frames(
        "[simulation]
        duration = 1.2
        frame_rate = 25
        gravity = [0, -9.81, 0]
        contacts = 'event-driven'
        integrator = 'velocity-verlet'
        [environment]
        ground = { friction = 0.5, height = 0 }
        [body.domino]
        shape.box.size = [0.1, 0.8, 0.4]
        location = [0, 0.4, 0]
        repeat.line = { count = 4, to = [1.5, 0, 0] }
        [body.ball]
        shape.sphere.radius = 0.1
        location = [-0.3, 0.7, 0]
        velocity = [2, 0, 0]
        mass = 3",
    );
    let mut before = f64::INFINITY;
    for frame in &frames {
        let accounts = frame.balance.accounts;
        let taken = accounts.impacts + accounts.friction;
        let drift = frame.balance.drift.abs();
        assert!(taken <= before + 1e-6 && drift < 1e-4, "t = {}: {before} {taken} {drift:e}", frame.time);
        before = taken;
    }
    let last = &frames[frames.len() - 1];
    for (i, angle) in [78.5, 78.5, 78.8, 90.0].into_iter().enumerate() {
        let up = (last.bodies[i].orientation * DVec3::Y).y;
        let tilt = libm::acos(up).to_degrees();
        assert!((tilt - angle).abs() < 1.0, "domino {i}: {tilt} {angle}");
    }
}
