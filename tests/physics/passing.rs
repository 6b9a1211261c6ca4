//! Tests of bodies that meet at an angle, just miss each other, or slide over seams, by both policies of contacts. What is not in the way must
//! not change the motion.

use glam::DVec3;
use jabuka::physics::BodySnapshot;
use jabuka::simulate::Frame;

use crate::common::frames;

const POLICIES: [&str; 2] = ["event-driven", "time-stepping"];

/// Returns the last frame of a scene, and the state of its body `a` there.
fn end(policy: &str, settings: &str, bodies: &str) -> (Vec<Frame>, BodySnapshot) {
    let text = format!("[simulation]\nframe_rate = 50\ncontacts = \"{policy}\"\n{settings}\n{bodies}");
    let frames = frames(&text);
    let body = frames[frames.len() - 1].bodies[0];
    (frames, body)
}

/// Checks equal balls without friction that meet at an angle of 40° to their line of centers: the other one leaves along this line with
/// (1 + e)/2 · v · cos 40°, wherever in a step they meet.
#[test]
fn balls_that_meet_at_an_angle_part_along_their_line_of_centers() {
    for policy in POLICIES {
        for phase in 0..5 {
            let bodies = format!(
                r#"
                [environment]
                ground = false
                [defaults.body]
                friction = 0
                restitution = 0.95
                shape.sphere.radius = 0.028
                mass = 0.17
                [body.other]
                [body.comes]
                location = ["-0.2 - 0.0016*{phase} - 0.056*cos(rad(40))", 0, "0.056*sin(rad(40))"]
                velocity = [2, 0, 0]
                "#
            );
            let (_, other) = end(policy, "duration = 0.3", &bodies);
            let (sin, cos) = libm::sincos(40.0_f64.to_radians());
            let expected = 0.5 * 1.95 * 2.0 * cos * DVec3::new(cos, 0.0, -sin);
            // The moment of the touch is found to 1e-9 of the size.
            let error = (other.velocity - expected).length();
            assert!(error < 1e-7, "{policy}, {phase}: {error}");
        }
    }
}

/// Checks that a ball that flies past a corner, half a millimeter above it, or past another ball, does not touch it.
#[test]
fn what_is_missed_by_little_is_not_touched() {
    let past_corner = r#"
        [environment]
        ground = false
        [body.a]
        shape.sphere.radius = 0.05
        location = [-1, 0.1505, 0]
        velocity = [5, 0, 0]
        [body.box]
        shape.box.size = [0.2, 0.2, 0.2]
        fixed = true
        restitution = 0.5
    "#;
    let past_ball = r#"
        [environment]
        ground = false
        [defaults.body]
        shape.sphere.radius = 0.05
        [body.a]
        location = [-1, 0.1001, 0]
        velocity = [5, 0, 0]
        [body.b]
    "#;
    for policy in POLICIES {
        for bodies in [past_corner, past_ball] {
            let (_, ball) = end(policy, "duration = 0.4", bodies);
            assert_eq!(ball.velocity, DVec3::X * 5.0, "{policy}");
        }
    }
}

/// Checks an elastic impact of a ball and a turning box without friction: the energy stays, and so does the angular momentum, since both
/// bodies get the impulse where they touch. By Moreau's scheme the box gets it with its orientation at the start of a substep of 2 ms; it
/// turns by 0.004 rad until then.
#[test]
fn a_ball_and_a_turning_box_keep_their_energy_and_angular_momentum() {
    let bodies = r#"
        [environment]
        ground = false
        [defaults.body]
        friction = 0
        restitution = 1
        [body.box]
        shape.box.size = [0.2, 0.3, 0.15]
        mass = 1
        location = [0.5, 0.034442185152504814, 0.025795440294030247]
        velocity = [-2.0, 0, 0]
        angular_velocity = [-0.63542735335324, -1.9286659976562932, 0.09019777094886816]
        orientation = [72.88814474107457, 141.08374602625906, 54.59629069420694]
        [body.ball]
        shape.sphere.radius = 0.12
        mass = 2
        location = [-0.5, -0.002340304584764419, 0.008338203945503123]
        velocity = [2.0, 0, 0]
        angular_velocity = [3.2649030815626814, 0.03749484653912205, -1.7452972448023694]
    "#;
    for policy in POLICIES {
        let (frames, _) = end(policy, "duration = 0.8", bodies);
        let (first, last) = (&frames[0].balance, &frames[frames.len() - 1].balance);
        let change = (last.kinetic - first.kinetic).abs() / first.kinetic;
        assert!(change < 1e-3, "{policy}: {change}");
        let turned =
            (last.angular_momentum - first.angular_momentum).length() / first.angular_momentum.length();
        assert!(turned < 1e-6, "{policy}: {turned}");
    }
}

/// Twelve fixed boxes in a row, flush with each other, with their tops at a height of 0.
const ROW: &str = r#"
    [body.row]
    shape.box.size = [0.3, 0.2, 0.5]
    location = ["0.3*i", -0.1, 0]
    fixed = true
    friction = 0
    repeat = 12
"#;

/// Checks that nothing trips at the seams of a row of boxes: neither a box without friction, nor a cylinder on its end, nor a rolling ball.
#[test]
fn seams_of_flush_boxes_are_no_obstacles() {
    let sliding =
        |shape: &str| format!("{shape}\nlocation = [0, 0.05, 0]\nvelocity = [1, 0, 0]\nfriction = 0");
    let rolling = "shape.sphere.radius = 0.05\nlocation = [0, 0.05, 0]\nvelocity = [3, 0, 0]\n\
        angular_velocity = [0, 0, -60]\nfriction = 0";
    for (body, speed) in [
        (sliding("shape.box.size = [0.1, 0.1, 0.1]"), 1.0),
        (sliding("shape.cylinder = { radius = 0.05, height = 0.1 }"), 1.0),
        (rolling.to_owned(), 3.0),
    ] {
        for policy in POLICIES {
            let bodies = format!("[environment]\nground = false\n[body.a]\n{body}\n{ROW}");
            let (_, body) = end(policy, "duration = 0.8\ngravity = [0, -9.81, 0]", &bodies);
            assert!(
                (body.velocity - DVec3::X * speed).length() < 1e-5 * speed,
                "{policy}: {}",
                body.velocity
            );
            assert!(
                (body.location - DVec3::new(0.8 * speed, 0.05, 0.0)).length() < 1e-5,
                "{policy}: {}",
                body.location
            );
        }
    }
}

/// Checks a brick that a force pulls over flush bricks with friction: a = F/m − µ g. Its way may be off by what the first step starts with.
#[test]
fn a_brick_is_pulled_over_flush_bricks_as_over_a_plane() {
    let (friction, pull) = (0.3, 3.843);
    let bodies = format!(
        r#"
        [environment]
        ground = false
        [defaults.body]
        friction = {friction}
        [body.a]
        shape.box.size = [0.2, 0.1, 0.1]
        location = [0.2, 0.05, 0]
        mass = 1
        force = [{pull}, 0, 0]
        [body.row]
        shape.box.size = [0.2, 0.2, 0.5]
        location = ["0.2*i", -0.1, 0]
        fixed = true
        repeat = 12
        "#
    );
    for policy in POLICIES {
        let (_, brick) = end(policy, "duration = 0.8\ngravity = [0, -9.81, 0]", &bodies);
        let expected = 0.2 + 0.5 * (pull - friction * 9.81) * 0.8 * 0.8;
        assert!(
            (brick.location.x - expected).abs() < 2e-3,
            "{policy}: {} instead of {expected}",
            brick.location.x
        );
    }
}

/// Checks a box that slides along a row of boxes which it touches at its side, and does not press.
#[test]
fn a_box_slides_along_a_flush_wall() {
    let bodies = r#"
        [defaults.body]
        friction = 0
        [environment.ground]
        friction = 0
        [body.a]
        shape.box.size = [0.1, 0.1, 0.1]
        location = [0, 0.05, 0]
        velocity = [1, 0, 0]
        [body.row]
        shape.box.size = [0.3, 0.2, 0.2]
        location = ["0.3*i", 0.1, -0.15]
        fixed = true
        repeat = 12
    "#;
    for policy in POLICIES {
        let (_, body) = end(policy, "duration = 0.8\ngravity = [0, -9.81, 0]", bodies);
        assert!((body.location - DVec3::new(0.8, 0.05, 0.0)).length() < 1e-5, "{policy}: {}", body.location);
    }
}

/// Checks that a step which is no seam still stops what runs into it: a box that is one thousandth of its size lower than the next.
#[test]
fn a_low_step_is_an_obstacle() {
    let bodies = r#"
        [environment]
        ground = false
        [defaults.body]
        friction = 0
        [body.a]
        shape.box.size = [0.1, 0.1, 0.1]
        location = [0, 0.0499, 0]
        velocity = [1, 0, 0]
        [body.floor]
        shape.box.size = [0.6, 0.2, 0.5]
        location = [0, -0.1001, 0]
        fixed = true
        [body.step]
        shape.box.size = [0.6, 0.2, 0.5]
        location = [0.6, -0.1, 0]
        fixed = true
    "#;
    for policy in POLICIES {
        let (_, body) = end(policy, "duration = 0.4\ngravity = [0, -9.81, 0]", bodies);
        assert!(body.velocity.x < 0.9, "{policy}: {}", body.velocity);
    }
}
