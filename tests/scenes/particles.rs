//! Tests of particle emitters from the scene to the scripts.

use glam::DVec3;
use jabuka::simulate::{Frame, Frames, Recorded, Selection};
use jabuka::{Run, Scene};

fn scene(text: &str) -> Scene {
    Scene::parse(text).unwrap_or_else(|report| panic!("{}", report.to_text(false)))
}

fn frames(scene: &Scene) -> Vec<Frame> {
    Frames::new(scene).map(Result::unwrap).collect()
}

/// A scene with every kind of lifetime and force for particles: a thrown, rotating body emits charged particles.
const ALL: &str = "
    [simulation]
    duration = 2
    frame_rate = 10
    gravity = [0, -9.81, 0]
    integrator = 'rk4'
    [body.wheel]
    shape.cylinder = { radius = 0.5, height = 0.2 }
    mass = 3
    location = [0, 1, 0]
    velocity = [1, 5, 0]
    angular_velocity = [0, 3, 40]
    [body.sun]
    shape.sphere.radius = 0.5
    mass = 1e10
    location = [9, 0, 0]
    fixed = true
    [emitter.sparks]
    shape.sphere.radius = 0.01
    from.surface = 'wheel'
    rate = 301
    lifetime = 'uniform(0.2, 0.45)'
    speed = 'normal(2, 0.5) + t'
    spread = 40
    charge = 1e-3
    [emitter.bursts]
    shape.sphere.radius = 0.01
    from = { box = { size = [1, 2, 3] }, body = 'wheel' }
    burst = 20
    every = 0.33
    start = -1
    lifetime = 0.5
    [force.air.drag]
    linear = 0.1
    [force.field.lorentz]
    magnetic = [0, 300, 0]
    on = ['sparks']
    [force.newton.gravitation]
    on = ['sun', 'sparks', 'bursts']
    ";

#[test]
fn a_selection_of_frames_has_the_particles_of_the_whole_run() {
    selections_agree(ALL);
    // A trail needs all earlier frames.
    selections_agree(&ALL.replace("mass = 3", "mass = 3\n    trail = true"));
}

fn selections_agree(text: &str) {
    let scene = scene(text);
    let whole = frames(&scene);
    let recorded = Recorded::new(&scene).unwrap();
    assert!(whole.iter().all(|frame| frame.index < 2 || frame.particles.iter().all(|some| some.len() > 15)));
    let read: Vec<Frame> = recorded.frames().map(Result::unwrap).collect();
    assert_eq!(read, whole);
    for list in ["0-20", "13", "3,4,17-19", "20"] {
        let selection: Selection = list.parse().unwrap();
        for exposure in recorded.exposures(&selection) {
            let frame = exposure.unwrap().frame;
            assert_eq!(frame.particles, whole[frame.index].particles, "{} of {list}", frame.index);
        }
    }
    for frame in &whole {
        assert_eq!(recorded.at(frame.time).unwrap().frame.particles, frame.particles);
    }
}

#[test]
fn moments_between_frames_have_particles_of_their_own() {
    let text = "simulation = { duration = 1, frame_rate = 10, gravity = [0, -10, 0], integrator = 'rk4' }
        [emitter.one]\nshape.sphere.radius = 0.1\nburst = 1\nstart = 0.2\nspeed = 5";
    let scene = scene(text);
    let recorded = Recorded::new(&scene).unwrap();
    for (time, y) in [(0.2, 0.0), (0.25, 0.25 - 0.0125), (0.7, 2.5 - 1.25)] {
        let frame = recorded.at(time).unwrap().frame;
        assert!((frame.particles[0][0].location.y - y).abs() < 1e-12, "{time}");
    }
    assert!(recorded.at(0.19).unwrap().frame.particles[0].is_empty());
    let blurred = self::scene(&format!("{text}\n[camera]\nshutter = 0.05\nsamples = 3"));
    let run = Run::new(&blurred).unwrap();
    let exposure = run.at(0.3).unwrap();
    let script = run.shutter_script(&exposure).unwrap().unwrap();
    assert_eq!(script.matches("sphere { <0, ").count(), 3, "{script}");
    let first = script.lines().find(|line| line.starts_with("  sphere")).unwrap();
    // The first particle is 0.1083 s old: 5 t − 5 t² is 0.4829 m, written with an accuracy of 1 mm.
    assert_eq!(first.trim(), "sphere { <0, 0.483, 0>, 0.1 }");
}

/// Checks that a spark leaves the rim of a wheel with the velocity of the rim, perpendicular to the spoke.
#[test]
fn what_a_body_sends_out_has_its_velocity() {
    let scene = scene(
        "simulation = { duration = 0.4, frame_rate = 25, integrator = 'rk4' }
        [body.wheel]\nshape.cylinder = { radius = 0.5, height = 0.1 }
        motion.formula = { location = ['2*t', 0, 0], orientation = [90, 0, 'deg(200*t)'] }
        [emitter.rim]\nshape.sphere.radius = 0.01\nrate = 100
        from = { point = [0.5, 0, 0], body = 'wheel' }",
    );
    let last = frames(&scene).pop().unwrap();
    for spark in last.particles[0].iter() {
        let (sin, cos) = libm::sincos(200.0 * spark.born);
        let velocity = DVec3::new(2.0 - 100.0 * sin, 100.0 * cos, 0.0);
        // The wheel turns by 8 rad per frame. Between two frames, its angular velocity at the first of them is used.
        assert!(spark.velocity.abs_diff_eq(velocity, 1e-9), "{} {velocity}", spark.velocity);
        let left = DVec3::new(2.0 * spark.born + 0.5 * cos, 0.5 * sin, 0.0);
        assert!(spark.location.abs_diff_eq(left + (0.4 - spark.born) * velocity, 1e-9));
    }
    assert_eq!(last.particles[0].len(), 41);
}

#[test]
fn forces_act_on_all_particles_or_on_those_that_are_named() {
    let scene = scene(
        "simulation = { duration = 1, frame_rate = 1, integrator = 'rk4' }
        defaults.force.constant.force = [1, 0, 0]
        [body.ball]\nshape.sphere.radius = 1
        [emitter.a]\nshape.sphere.radius = 0.1\nburst = 1
        [emitter.b]\nshape.sphere.radius = 0.1\nburst = 1\nmass = 0.5
        [force.all.constant]
        [force.body.constant]\non = ['ball']
        [force.both.constant]\nforce = [0, 1, 0]\non = ['b', 'ball']",
    );
    let last = frames(&scene).pop().unwrap();
    let velocity = |number: usize| last.particles[number][0].velocity;
    assert!(velocity(0).abs_diff_eq(DVec3::new(1.0, 0.0, 0.0), 1e-12));
    assert!(velocity(1).abs_diff_eq(DVec3::new(2.0, 2.0, 0.0), 1e-12));
    assert!(last.bodies[0].velocity.abs_diff_eq(DVec3::new(2.0, 1.0, 0.0), 1e-12));
}

#[test]
fn particles_change_nothing_that_bodies_do() {
    let without =
        ALL.split("[emitter.sparks]").next().unwrap().to_owned() + "[force.air.drag]\nlinear = 0.1\n";
    let with = ALL.replace("[force.newton.gravitation]\n    on = ['sun', 'sparks', 'bursts']", "");
    let [with, without] = [with, without].map(|text| frames(&scene(&text)));
    for (with, without) in with.iter().zip(&without) {
        assert_eq!(with.bodies, without.bodies);
        assert_eq!(with.balance, without.balance);
    }
}

#[test]
fn the_camera_sees_where_particles_go() {
    let scene = scene(
        "simulation = { duration = 2, gravity = [0, -10, 0] }
        [emitter.jet]\nshape.sphere.radius = 0.01\nrate = 50000\nlifetime = 1\nspeed = 10\nspread = 5",
    );
    let bounds = Run::new(&scene).unwrap().survey().bounds().unwrap();
    // The particles rise by 5 m, up to the error of the first-order method, and after 2 s have returned or ended.
    assert!((4.9..5.1).contains(&bounds.max.y) && bounds.min.y.abs() < 0.1, "{bounds:?}");
    assert!(bounds.max.x > 0.5 && bounds.min.z < -0.5, "{bounds:?}");
}

#[test]
fn looks_follow_the_age() {
    let scene = scene(
        "simulation = { duration = 1, frame_rate = 1 }
        [emitter.dots]\nshape.sphere.radius = 0.1\nburst = 1\nevery = 0.5\nstart = 0\nlifetime = 1.25
        color = ['#ff0000', '#0000ff']\nsize = [1, 0]\nglow = 2\nspeed = 1\nstreak = 0.25",
    );
    let run = Run::new(&scene).unwrap();
    let frame = run.frames().nth(1).unwrap().unwrap();
    let script = run.script(&frame).unwrap();
    // The particles are born at 0, 0.5 and 1 s. At 1 s, the fractions 0.8, 0.4 and 0 of their lifetimes have passed, which are the groups
    // 25, 12 and 0 of 32.
    let lines: Vec<&str> =
        script.split("// dots\n").skip(1).map(|rest| rest.lines().next().unwrap()).collect();
    assert_eq!(
        lines,
        [
            "  sphere { <0, 0, 0>, 0.1 }",
            "  cone { <0, 0.25, 0>, 0, <0, 0.5, 0>, 0.0612903226 }",
            "  cone { <0, 0.75, 0>, 0, <0, 1, 0>, 0.0193548387 }"
        ]
    );
    assert!(
        script.contains("color srgb <1, 0, 0>")
            && script.contains("emission 2")
            && script.contains("no_shadow")
    );
}
