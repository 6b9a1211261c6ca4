//! Tests of friction at several points at once: bodies stay as long as any forces within the cones of friction hold them, and slide from
//! then on, against closed forms.
//!
//! Each scene is tried twice: once along the x axis, and once turned by 30° about the vertical, with all masses times 7.

use glam::{DQuat, DVec3};
use jabuka::simulate::Frame;

use crate::common::frames;

const G: f64 = 9.81;
/// The length of a step, s.
const STEP: f64 = 1.0 / 240.0;
/// The turns about the vertical, in degrees, each with a factor on all masses.
const TURNS: [(f64, f64); 2] = [(0.0, 1.0), (30.0, 7.0)];

fn list(vector: DVec3) -> String {
    format!("[{:e}, {:e}, {:e}]", vector.x, vector.y, vector.z)
}

fn turned(turn: f64, vector: DVec3) -> DVec3 {
    DQuat::from_rotation_y(turn.to_radians()) * vector
}

/// Returns the table of a box. `tilt` rotates it about z, in degrees, before the turn about the vertical.
fn block(name: &str, size: DVec3, place: DVec3, (turn, tilt): (f64, f64), rest: &str) -> String {
    let rotation = DQuat::from_rotation_y(turn.to_radians()) * DQuat::from_rotation_z(tilt.to_radians());
    let [x, y, z, w] = rotation.to_array();
    format!(
        "[body.{name}]
        shape.box.size = {}
        location = {}
        orientation.quaternion = [{x:e}, {y:e}, {z:e}, {w:e}]
        {rest}\n",
        list(size),
        list(turned(turn, place)),
    )
}

/// Returns the table of a force on a body that grows with time by `rate`, N/s.
fn growing(body: &str, rate: DVec3) -> String {
    let [x, y, z] = rate.to_array();
    format!("[force.pull.formula]\non = ['{body}']\nforce = ['{x:e}*t', '{y:e}*t', '{z:e}*t']\n")
}

/// Simulates bodies under gravity, and checks that the friction of each contact is at most `friction(bodies)` times the normal force. The
/// tolerance is that of the solver.
fn simulate(duration: f64, gravity: DVec3, friction: impl Fn([usize; 2]) -> f64, bodies: &str) -> Vec<Frame> {
    let frames = frames(&format!(
        "[simulation]
        duration = {duration}
        frame_rate = 20
        step = {STEP}
        gravity = {}
        contacts = 'event-driven'
        integrator = 'velocity-verlet'
        [environment]
        ground = false
        {bodies}",
        list(gravity)
    ));
    for frame in &frames {
        let loads = frame.contacts.iter().map(|contact| contact.force.length());
        let largest = loads.fold(0.0, f64::max);
        for contact in &frame.contacts {
            let most = friction(contact.bodies) * contact.force.dot(contact.normal);
            let outside = contact.friction.length() - most;
            assert!(outside < 1e-6 * largest, "t = {}: {outside} {contact:?}", frame.time);
        }
    }
    frames
}

fn floor(friction: f64) -> String {
    format!("[body.floor]\nshape.plane.normal = [0, 1, 0]\nfriction = {friction:e}\n")
}

fn down() -> DVec3 {
    DVec3::new(0.0, -G, 0.0)
}

/// Returns the displacement of a body, by index, from the first to the last frame.
fn way(frames: &[Frame], body: usize) -> DVec3 {
    frames[frames.len() - 1].bodies[body].location - frames[0].bodies[body].location
}

fn velocity(frames: &[Frame], body: usize) -> DVec3 {
    frames[frames.len() - 1].bodies[body].velocity
}

/// A box on a slope stays up to tan θ = μ. Beyond, it slides with g (sin θ − μ cos θ). The slope is a tilted gravity.
#[test]
fn a_box_on_a_slope_slides_from_the_angle_of_friction_on() {
    let friction = 0.5;
    for ((turn, mass), part) in TURNS.into_iter().flat_map(|t| [0.9, 0.999, 1.001, 1.1].map(|p| (t, p))) {
        let (sin, cos) = libm::sincos(libm::atan(part * friction));
        let gravity = turned(turn, DVec3::new(sin, -cos, 0.0)) * G;
        let rest = format!("mass = {mass}\nfriction = {friction}");
        let size = DVec3::new(1.0, 0.5, 0.8);
        let text = floor(friction) + &block("box", size, DVec3::Y * 0.25, (turn, 0.0), &rest);
        let frames = simulate(0.5, gravity, |_| friction, &text);
        let exact = 0.125 * G * (sin - friction * cos).max(0.0) * turned(turn, DVec3::X);
        let off = way(&frames, 1) - exact;
        assert!(off.length() < 1e-9, "{turn} {part}: {off}");
    }
}

/// A force 10 m t N on a box of mass m (kg) moves it from t₀ = μ g / 10 on: v = 5 (t − t₀)². The four corners carry different loads, so
/// their friction would reach its limits one after another. The step in which it starts is not exact: its error is of the order 10 h².
#[test]
fn a_box_starts_when_the_pull_exceeds_all_friction() {
    let friction = 0.5;
    let start = 0.1 * friction * G;
    for ((turn, mass), way_of_pull) in TURNS.into_iter().flat_map(|t| [0.0, 20.0, 45.0].map(|w| (t, w))) {
        let along = turned(way_of_pull, DVec3::X);
        let rest = format!("mass = {mass}\nfriction = {friction}");
        for size in [DVec3::ONE, DVec3::new(1.0, 0.5, 0.8)] {
            let place = DVec3::Y * 0.5 * size.y;
            let text = floor(friction)
                + &block("box", size, place, (turn, 0.0), &rest)
                + &growing("box", 10.0 * mass * along);
            let frames = simulate(0.8, down(), |_| friction, &text);
            let left = 0.8 - start;
            let off = velocity(&frames, 1) - 5.0 * left * left * along;
            assert!(off.length() < 10.0 * STEP * STEP, "{turn} {way_of_pull}: {off}");
            let off = way(&frames, 1) - 10.0 / 6.0 * left * left * left * along;
            assert!(off.length() < 10.0 * STEP * STEP, "{turn} {way_of_pull}: {off}");
        }
    }
}

/// A plank lies on two supports at different distances, with eight contact points. In each direction of the pull, it starts when the pull
/// exceeds μ m g, and does not turn.
#[test]
fn a_plank_on_two_supports_slides_straight() {
    let friction = 0.4;
    let start = 0.1 * friction * G;
    for ((turn, mass), way_of_pull) in TURNS.into_iter().flat_map(|t| [0.0, 90.0, 30.0].map(|w| (t, w))) {
        let along = turned(turn + way_of_pull, DVec3::X);
        let support = |name: &str, x: f64| {
            let rest = format!("fixed = true\nfriction = {friction}");
            block(name, DVec3::new(0.2, 0.5, 1.0), DVec3::new(x, 0.25, 0.0), (turn, 0.0), &rest)
        };
        let rest = format!("mass = {mass}\nfriction = {friction}");
        let text = support("left", -1.2)
            + &support("right", 0.7)
            + &block("plank", DVec3::new(4.0, 0.1, 0.6), DVec3::Y * 0.55, (turn, 0.0), &rest)
            + &growing("plank", 10.0 * mass * along);
        let frames = simulate(0.6, down(), |_| friction, &text);
        let left = 0.6 - start;
        let off = velocity(&frames, 2) - 5.0 * left * left * along;
        assert!(off.length() < 10.0 * STEP * STEP, "{turn} {way_of_pull}: {off}");
    }
}

/// A thin ladder of length L and thickness d leans against a wall at the angle α to the floor. At the limit, the floor pushes with N and
/// μ N, the wall with μ N and μ' μ N, and their moment about the center of mass is 0: this gives the textbook's angle. Below it, the
/// ladder slips.
#[test]
fn a_ladder_slips_below_the_angle_of_the_textbook() {
    let (long, thick, friction): (f64, f64, f64) = (3.0, 0.1, 0.4);
    for ((turn, mass), of_wall) in TURNS.into_iter().flat_map(|t| [0.0, 0.3].map(|w| (t, w))) {
        // The moment about the center of mass in units of N, as a function of cot α.
        let moment = |cot: f64| {
            let (sin, cos) = (1.0 / (1.0 + cot * cot).sqrt(), cot / (1.0 + cot * cot).sqrt());
            let middle =
                DVec3::new(0.5 * long * cos + 0.5 * thick * sin, 0.5 * long * sin + 0.5 * thick * cos, 0.0);
            let foot = (DVec3::X * long * cos - middle).cross(DVec3::new(-friction, 1.0, 0.0));
            let top = (DVec3::Y * long * sin - middle).cross(DVec3::new(friction, of_wall * friction, 0.0));
            (foot + top).z
        };
        let (mut low, mut high) = (0.0, 10.0);
        for _ in 0..100 {
            let cot = 0.5 * (low + high);
            if moment(cot) > 0.0 { high = cot } else { low = cot }
        }
        let limit = libm::atan(1.0 / low);
        if of_wall == 0.0 {
            assert!((1.0 / libm::tan(limit) - (2.0 * friction + thick / long)).abs() < 1e-12);
        }
        for part in [0.999, 1.001] {
            let angle = part * limit;
            let (sin, cos) = libm::sincos(angle);
            let place =
                DVec3::new(0.5 * long * cos + 0.5 * thick * sin, 0.5 * long * sin + 0.5 * thick * cos, 0.0);
            let wall = format!(
                "[body.wall]\nshape.plane.normal = {}\nfriction = {of_wall}\n",
                list(turned(turn, DVec3::X))
            );
            let size = DVec3::new(long, thick, 0.6);
            let tilt = 180.0 - angle.to_degrees();
            let text = floor(friction)
                + &wall
                + &block("ladder", size, place, (turn, tilt), &format!("mass = {mass}"));
            let of = |bodies: [usize; 2]| if bodies[0] == 0 { friction } else { of_wall };
            let frames = simulate(0.25, down(), of, &text);
            let way = way(&frames, 2).length();
            assert!(if part > 1.0 { way < 1e-8 } else { way > 1e-5 }, "{turn} {of_wall} {part}: {way:e}");
        }
    }
}

/// A box lies on another one, which a force k t pulls. Both start together, when the force exceeds μ₂ (m₁ + m₂) g. The upper one is left
/// behind when the acceleration exceeds μ₁ g, and then follows with this acceleration.
#[test]
fn the_upper_of_two_boxes_is_left_behind() {
    let [above, below] = [0.5, 0.3];
    for (turn, way_of_pull, upper, lower) in
        [(0.0, 0.0, 1.0, 1.0), (30.0, 35.0, 2.0, 5.0), (0.0, 35.0, 5.0, 2.0)]
    {
        let both = upper + lower;
        let rate = 10.0 * both;
        let along = turned(turn + way_of_pull, DVec3::X);
        let text = floor(below * below / 0.4)
            + &block(
                "lower",
                DVec3::new(1.6, 0.5, 1.4),
                DVec3::Y * 0.25,
                (turn, 0.0),
                &format!("mass = {lower}\nfriction = 0.4"),
            )
            + &block(
                "upper",
                DVec3::new(0.6, 0.4, 0.8),
                DVec3::Y * 0.7,
                (turn, 0.0),
                &format!("mass = {upper}\nfriction = {}", above * above / 0.4),
            )
            + &growing("lower", rate * along);
        let of = |bodies: [usize; 2]| if bodies[0] == 0 { below } else { above };
        let frames = simulate(1.0, down(), of, &text);
        let (start, parts) = (below * both * G / rate, (above + below) * G * both / rate);
        let together = 0.5 * rate * (parts * parts - start * start) / both - below * G * (parts - start);
        let left = 1.0 - parts;
        let slower = together + above * G * left;
        let pull = 0.5 * rate * (1.0 - parts * parts);
        let faster = together + (pull - (below * both + above * upper) * G * left) / lower;
        for (body, exact) in [(1, faster), (2, slower)] {
            let off = velocity(&frames, body) - exact * along;
            // The steps in which they start, and in which they part, are not exact.
            assert!(off.length() < 20.0 * STEP * STEP, "{turn} {upper} {lower}, body {body}: {off}");
        }
    }
}

/// A beam stands on the floor and leans on the edge of a box. A linear program over all forces within the cones says which friction the
/// foot of the beam needs, and which the box needs.
#[test]
fn a_beam_leans_on_a_box_as_long_as_forces_can_hold_it() {
    let (angle, long, thick) = (35.0_f64.to_radians(), 1.4, 0.1);
    let (sin, cos) = libm::sincos(angle);
    let axis = DVec3::new(cos, sin, 0.0);
    let foot = DVec3::new(0.0, 0.5, 0.0) - axis * 0.5 / sin;
    let place = foot + 0.5 * long * axis + 0.5 * thick * DVec3::new(-sin, cos, 0.0);
    // The friction of the foot, that of the box on the floor, and which of the two is at its limit.
    let of_edge = 0.3;
    for (turn, mass) in TURNS {
        for (of_foot, of_box) in [(0.538_250_54, 0.8), (0.8, 0.149_595_785)] {
            for part in [0.999, 1.001] {
                let (of_foot, of_box) =
                    if of_box == 0.8 { (part * of_foot, of_box) } else { (of_foot, part * of_box) };
                let text = floor(of_foot * of_box / of_edge)
                    + &block(
                        "box",
                        DVec3::new(0.6, 0.5, 0.8),
                        DVec3::new(0.3, 0.25, 0.0),
                        (turn, 0.0),
                        &format!("mass = {}\nfriction = {:e}", 1.5 * mass, of_box * of_edge / of_foot),
                    )
                    + &block(
                        "beam",
                        DVec3::new(long, thick, 0.5),
                        place,
                        (turn, 35.0),
                        &format!("mass = {}\nfriction = {:e}", 2.0 * mass, of_foot * of_edge / of_box),
                    );
                let of = |bodies: [usize; 2]| match bodies {
                    [0, 1] => of_box,
                    [0, 2] => of_foot,
                    _ => of_edge,
                };
                let frames = simulate(0.25, down(), of, &text);
                let way = way(&frames, 1).length().max(way(&frames, 2).length());
                let is_right = if part > 1.0 { way < 1e-8 } else { way > 1e-5 };
                assert!(is_right, "{turn} {of_foot} {of_box}: {way:e}");
            }
        }
    }
}

/// A torque turns a plate on four corners when it exceeds μ m g r, where r is half the diagonal. A pull of half of μ m g leaves less of it,
/// as the largest torque over all forces within the cones says (a linear program).
#[test]
fn a_plate_turns_when_a_torque_exceeds_what_its_corners_hold() {
    let friction = 0.5;
    let size = DVec3::new(1.0, 1e-3, 0.6);
    for ((turn, mass), part) in TURNS.into_iter().flat_map(|t| [0.99, 0.999, 1.001, 1.01].map(|p| (t, p))) {
        let half_diagonal = 0.5 * libm::hypot(size.x, size.z);
        for (pull, most) in [(0.0, friction * G * half_diagonal), (0.5, 2.379_108_8)] {
            let along = turned(turn, DVec3::X);
            let rest = format!("mass = {mass}\nfriction = {friction}");
            let text = floor(friction)
                + &block("plate", size, DVec3::Y * 0.5 * size.y, (turn, 0.0), &rest)
                + &format!(
                    "[force.push.constant]\non = ['plate']\nforce = {}\ntorque = [0, {:e}, 0]",
                    list(pull * friction * mass * G * along),
                    part * most * mass
                );
            let frames = simulate(0.25, down(), |_| friction, &text);
            let spin = frames[frames.len() - 1].bodies[1].angular_velocity.y;
            if part < 1.0 {
                assert!(
                    spin.abs() < 1e-9 && way(&frames, 1).length() < 1e-9,
                    "{turn} {pull} {part}: {spin:e}"
                );
            } else if pull == 0.0 {
                let inertia = (size.x * size.x + size.z * size.z) / 12.0;
                let exact = 0.25 * (part - 1.0) * most / inertia;
                // While the slip is slow, the friction keeps its direction, and the plate turns by up to 0.008 rad meanwhile.
                let error = 0.25 * 0.5 * 0.008 * 0.008 * most / inertia;
                assert!((spin - exact).abs() < error, "{turn} {part}: {spin} {exact}");
            } else {
                assert!(spin > 1e-3 * (part - 1.0), "{turn} {part}: {spin:e}");
            }
        }
    }
}
