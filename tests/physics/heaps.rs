//! Tests of heaps: bodies with many contacts come to rest together, and stay at rest until a disturbance.

use glam::DVec3;
use jabuka::Scene;
use jabuka::physics::{ContactSnapshot, MotionLaw};
use jabuka::simulate::survey;

use crate::common::{drift, frames};

/// Checks that a ball that spins about the vertical keeps spinning: a point contact exerts no torque about its normal.
#[test]
fn what_spins_on_the_spot_goes_on_spinning() {
    let frames = frames(
        r#"
        [simulation]
        duration = 0.5
        frame_rate = 10
        integrator = "velocity-verlet"
        gravity = [0, -9.81, 0]
        contacts = "event-driven"
        [body.ball]
        shape.sphere.radius = 0.1
        mass = 1
        friction = 0.5
        location = [0, 0.1, 0]
        angular_velocity = [0, 3, 0]
        "#,
    );
    for frame in &frames {
        assert!((frame.bodies[0].angular_velocity.y - 3.0).abs() < 1e-12, "{}", frame.time);
    }
}

/// A scene in which balls are poured into a box, one after another.
const POURED: &str = r#"
    [simulation]
    duration = 3.2
    frame_rate = 25
    integrator = "velocity-verlet"
    gravity = [0, -9.81, 0]
    contacts = "event-driven"
    [defaults.body]
    friction = 0.4
    restitution = 0.3
    [body.ball]
    repeat = 16
    start = "0.08*i"
    shape.sphere.radius = 0.05
    mass = 0.5
    location = ["0.03*cos(2*i)", 0.8, "0.03*sin(2*i)"]
    velocity = [0, -2, 0]
    [body.wall]
    repeat = 4
    shape.box.size = [0.3, 0.6, 0.02]
    location = ["0.11*sin(pi*i/2)", 0.3, "0.11*cos(pi*i/2)"]
    orientation = [0, "90*i", 0]
    fixed = true
    collision_group = "walls"
"#;

/// Checks that poured balls come to rest without overlapping each other or a wall. The accounts hold the energy of the fall, up to the
/// energy of pushing apart bodies that overlap by 1e-4 of their size.
#[test]
fn what_is_poured_into_a_box_comes_to_rest() {
    let frames = frames(POURED);
    assert!(drift(&frames) < 1e-3, "{:e}", drift(&frames));
    let last = &frames[frames.len() - 1];
    let balls = &last.bodies[..16];
    for (i, a) in balls.iter().enumerate() {
        assert!(a.velocity.length() < 1e-6, "{i}: {}", a.velocity);
        assert!(a.location.y > 0.05 - 1e-5, "{i}: {}", a.location);
        assert!(a.location.x.abs() < 0.05 + 1e-5 && a.location.z.abs() < 0.05 + 1e-5, "{i}: {}", a.location);
        for b in &balls[..i] {
            let gap = (a.location - b.location).length() - 0.1;
            assert!(gap > -1e-5, "{i}: {gap:e}");
        }
    }
    // The contact forces on each ball must balance its weight.
    for ball in 0..16 {
        let on = |contact: &ContactSnapshot| match contact.bodies {
            [first, _] if first == ball => -(contact.force + contact.friction),
            [_, second] if second == ball => contact.force + contact.friction,
            _ => DVec3::ZERO,
        };
        let sum = last.contacts.iter().map(on).sum::<DVec3>() + DVec3::new(0.0, -0.5 * 9.81, 0.0);
        assert!(sum.length() < 1e-3, "{ball}: {sum}");
    }
}

/// Checks balls that fall into a bin hardly wider than two of them, with long steps. The walls hold balls by friction, and balls wedge
/// each other, but the simulation does not jam. The impacts take the balls' initial energy, except for what has not been dissipated yet.
#[test]
fn a_narrow_bin_jams_nothing() {
    let frames = frames(
        r#"
        [simulation]
        duration = 3.2
        frame_rate = 25
        step = 0.02
        integrator = "velocity-verlet"
        gravity = [0, -9.81, 0]
        contacts = "event-driven"
        [defaults.body]
        restitution = 0.3
        friction = 0.2
        [body.ball]
        repeat = 40
        start = "0.1*i"
        shape.sphere.radius = 0.006
        density = 7800
        location = ["0.005*sin(7*i)", 0.5, 0]
        velocity = [0, -1, 0]
        [body.bin]
        repeat = 2
        shape.box.size = [0.003, 0.6, 0.014]
        location = ["0.03*(i - 0.5)", 0.3, 0]
        fixed = true
        [body.glass]
        repeat = 2
        shape.box.size = [0.05, 0.6, 0.01]
        location = [0, 0.3, "0.024*(i - 0.5)"]
        friction = 0
        fixed = true
        "#,
    );
    assert_eq!(frames.len(), 81);
    assert!(drift(&frames) < 1e-3, "{:e}", drift(&frames));
    for pair in frames.windows(2) {
        let [before, after] = [&pair[0], &pair[1]].map(|frame| frame.balance.accounts.impacts);
        assert!(after < before + 1e-5, "{before} J, then {after} J");
    }
}

/// Checks that a body that appears far away does not change a bit of a heap at rest.
#[test]
fn births_leave_what_is_at_rest_alone() {
    let frames = frames(
        r#"
        [simulation]
        duration = 0.8
        frame_rate = 25
        integrator = "velocity-verlet"
        gravity = [0, -9.81, 0]
        contacts = "event-driven"
        [body.box]
        repeat = 3
        shape.box.size = [0.4, 0.4, 0.4]
        mass = 1
        location = [0, "0.2+0.4*i", 0]
        [body.ball]
        repeat = 5
        start = "0.3 + 0.1*i"
        shape.sphere.radius = 0.1
        mass = 0.5
        location = ["2 + i", 0.3, 0]
        "#,
    );
    let late: Vec<_> = frames.iter().filter(|frame| frame.time > 0.25).collect();
    for frame in &late {
        assert_eq!(frame.bodies[..3], late[0].bodies[..3], "{}", frame.time);
    }
    assert_eq!(late[late.len() - 1].bodies.len(), 8);
}

/// Returns a scene with rows of logs on each other, the longest row on the ground. `keys` are those of all bodies.
fn pile_of_logs(rows: usize, [radius, height]: [f64; 2], simulation: &str, keys: &str) -> String {
    let bodies = (0..rows).map(|row| {
        let (count, high) = (rows - row, row as f64);
        format!(
            "[body.row{row}]\nrepeat = {count}\n\
             location = ['{radius}*(2*i - {last})', '{radius}*(1 + sqrt(3)*{high})', 0]\n",
            last = count - 1,
        )
    });
    format!(
        r#"
        [simulation]
        gravity = [0, -9.81, 0]
        {simulation}
        [environment.ground]
        friction = 0.35
        [defaults.body]
        shape.cylinder = {{ radius = {radius}, height = {height} }}
        orientation = [90, 0, 0]
        {keys}
        {}
        "#,
        bodies.collect::<String>()
    )
}

/// Piles of logs whose friction is too small give way: they slide and roll apart in their plane. Nothing throws a log along its axis, and the
/// policies and two steps agree on where the outermost log is after a second.
#[test]
fn piles_of_logs_roll_apart() {
    let scene = |rows: usize, contacts: &str, friction: f64, step: f64| {
        let simulation = format!("duration = 1\nstep = {step}\ncontacts = '{contacts}'");
        pile_of_logs(rows, [0.1, 0.3], &simulation, &format!("friction = {friction}"))
    };
    for (rows, friction, expected) in [(2, 0.245, 0.2742), (2, 0.26, 0.1940), (3, 0.05, 0.8932)] {
        for (contacts, step) in [
            ("event-driven", 0.004),
            ("event-driven", 0.001),
            ("time-stepping", 0.004),
            ("time-stepping", 0.001),
        ] {
            let frames = frames(&scene(rows, contacts, friction, step));
            let farthest = |axis: fn(DVec3) -> f64| {
                let of = |frame: &jabuka::simulate::Frame| {
                    frame.bodies.iter().map(|body| axis(body.location).abs()).fold(0.0, f64::max)
                };
                frames.iter().map(of).fold(0.0, f64::max)
            };
            let [across, along] = [farthest(|at| at.x), farthest(|at| at.z)];
            assert!(along < 0.01, "{rows} rows, {contacts}, {step} s: a log went {along} m along its axis");
            assert!(
                (across - expected).abs() < 0.01 * expected,
                "{rows} rows, {contacts}, {step} s: {across}"
            );
        }
    }
}

/// Six logs roll apart. At the end, the top log lies on the middle log of the lowest row, and two others touch that one from both sides. The
/// contacts of these four logs nearly contradict each other, but they throw no log. The outermost logs roll on at a constant speed.
#[test]
fn a_log_on_top_of_another_throws_none() {
    for step in [0.004, 0.0005] {
        let simulation = format!("duration = 2\nstep = {step}\ncontacts = 'event-driven'");
        let frames = frames(&pile_of_logs(3, [0.2, 1.0], &simulation, "friction = 0.25\nrestitution = 0"));
        let fastest = frames.iter().flat_map(|frame| &frame.bodies).map(|body| body.velocity.length());
        let fastest = fastest.fold(0.0, f64::max);
        // The log on top falls by 0.35 m at most, and no other falls farther.
        assert!(fastest < (2.0 * 9.81 * 0.35_f64).sqrt(), "{step} s: {fastest} m/s");
        let [left, right] = [0, 2].map(|log| frames[frames.len() - 1].bodies[log]);
        for (log, side) in [(left, -1.0), (right, 1.0)] {
            let rolling = side * log.velocity.x - 0.98;
            assert!(rolling.abs() < 1e-3, "{step} s: {} m/s", log.velocity);
            assert!((side * log.location.x - 1.976).abs() < 1e-3, "{step} s: {} m", log.location);
        }
    }
}

/// Sixty cans tumble into a box. A can that is jammed between two contacts may leave both: friction that holds it there would add energy.
#[test]
fn cans_that_tumble_into_a_box_get_no_energy() {
    let text = r#"
        [simulation]
        duration = 1.5
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [defaults.body]
        restitution = 0.3
        friction = 0.8
        [body.can]
        shape.cylinder = { radius = 0.1, height = 0.2 }
        location = ["0.36*(i % 4) - 0.54", "0.3 + 0.36*floor(i/16)", "0.36*(floor(i/4) % 4) - 0.54"]
        orientation = ["29*i % 90", 0, "53*i % 90"]
        density = 1000
        repeat = 60
        [body.wall]
        shape.box.size = [4, 2, 1]
        location = [0, 1, "2.6*i - 1.3"]
        repeat = 2
        fixed = true
        [body.side]
        shape.box.size = [1, 2, 4]
        location = ["2.6*i - 1.3", 1, 0]
        repeat = 2
        fixed = true
    "#;
    let scene = Scene::parse(text).unwrap();
    let survey = survey(&scene, |_| {}).unwrap();
    assert!(!scene.is_for_many_bodies());
    // The residual is recorded only if it is not zero.
    let added = survey.laws.iter().find(|residual| residual.law == MotionLaw::Energy);
    assert!(added.is_none_or(|added| added.amount < 1e-5), "{added:?}");
    // Impacts take most of the energy.
    assert!(survey.contacts.unwrap().lost > 1000.0);
}
