//! Tests of bodies with a limited lifetime: their keys in the scene, the pictures and the tables.

use std::fmt::Write as _;
use std::fs;

use glam::DVec3;
use jabuka::physics::Presence;
use jabuka::simulate::{Frame, Frames, Recorded, survey};
use jabuka::{Run, Scene};

use crate::support::place::Place;
use crate::support::{jabuka, stderr, stdout};

fn scene(text: &str) -> Scene {
    Scene::parse(text).unwrap_or_else(|report| panic!("{}", report.to_text(false)))
}

fn frames(scene: &Scene) -> Vec<Frame> {
    Frames::new(scene).map(Result::unwrap).collect()
}

fn scripts(scene: &Scene) -> Vec<String> {
    let run = Run::new(scene).unwrap();
    run.frames().map(|frame| run.script(&frame.unwrap()).unwrap()).collect()
}

/// Returns the numbers of the bodies that exist in each frame.
fn present(scene: &Scene) -> Vec<Vec<usize>> {
    frames(scene).iter().map(|frame| frame.bodies.iter().map(|body| body.id).collect()).collect()
}

const SPARKS: &str = "
    simulation = { duration = 1, frame_rate = 10, gravity = [0, -10, 0], integrator = 'rk4' }
    environment.ground = false
    ";

#[test]
fn start_and_end_are_formulas_of_copies_and_defaults_of_all() {
    let scene = scene(&format!(
        "{SPARKS}
        [defaults.body]
        end = 0.8
        [body.spark]
        repeat = 3
        shape.sphere.radius = 0.1
        location = ['i', 0, 0]
        velocity = [0, 1, 0]
        start = '0.1*(i + 2)'
        [body.post]
        shape.sphere.radius = 0.1
        location = [9, 0, 0]
        fixed = true
        start = -1
        "
    ));
    // 0.1 (1 + 2) differs from 0.3 by rounding, but must count as the time of the third frame.
    assert_eq!(scene.bodies[1].presence, Presence::during(&[[0.3, 0.8]]));
    let mut expected = vec![vec![3]; 2];
    expected.extend([vec![0, 3], vec![0, 1, 3]]);
    expected.extend(vec![vec![0, 1, 2, 3]; 5]);
    expected.extend(vec![vec![]; 2]);
    assert_eq!(present(&scene), expected);
    // Each body's motion begins at its own start: 0.5 s later, v t − ½ g t² is −0.75 m.
    for (id, frame) in [(0, 7), (1, 8)] {
        let body = frames(&scene)[frame].body(id).copied().unwrap();
        let exact = DVec3::new([0.0, 1.0][id], -0.75, 0.0);
        assert!(body.location.abs_diff_eq(exact, 1e-12), "{}", body.location);
    }
}

/// Checks that scripts contain only the bodies that exist. The group of a material is left out if it has one member, as POV-Ray warns of a
/// union of one object.
#[test]
fn scripts_hold_the_bodies_that_are_there_and_no_others() {
    let scene = scene(&format!(
        "{SPARKS}
        [material.red]
        color = 'red'
        [body.a]
        shape.sphere.radius = 0.1
        material = 'red'
        start = 0.3
        [body.b]
        shape.box.size = [1, 1, 1]
        material = 'red'
        start = 0.5
        end = 0.7
        [body.floor]
        shape.plane = {{}}
        start = 0.4
        "
    ));
    let block = |frame: usize| {
        let script = &scripts(&scene)[frame];
        ["object {\n", "union {\n", "// a\n", "// b\n", "// floor\n"].map(|text| script.contains(text))
    };
    assert_eq!(block(2), [false; 5]);
    assert_eq!(block(3), [true, false, true, false, false]);
    assert_eq!(block(4), [true, false, true, false, true]);
    assert_eq!(block(6), [false, true, true, true, true]);
    assert_eq!(block(8), [true, false, true, false, true]);
}

#[test]
fn trails_and_ghosts_stay_and_arrows_coils_and_labels_go() {
    let scene = scene(&format!(
        "{SPARKS}
        [body.ball]
        shape.sphere.radius = 0.1
        velocity = [1, 0, 0]
        start = 0.2
        end = 0.6
        trail = true
        ghosts = {{ every = 0.2, arrows = false }}
        arrows.velocity = true
        axes = true
        [body.post]
        shape.sphere.radius = 0.1
        location = [0, 3, 0]
        fixed = true
        [force.s.spring]
        between = ['post', 'ball']
        stiffness = 1
        [label.beside]
        text = 'here'
        body = 'ball'
        [label.corner]
        text = 'x = ${{ball.x}}'
        "
    ));
    let scripts = scripts(&scene);
    let asks = [", trail", "Ghost_", "Arrow(", ", axes", "// s", "\"here\"", "\"x = ?\""];
    let says = |frame: usize| asks.map(|text| scripts[frame].rsplit("#end").next().unwrap().contains(text));
    assert_eq!(says(1), [false, false, false, false, false, false, true]);
    // At 0.6 s the body still exists.
    assert_eq!(says(6), [true, true, true, true, true, true, false]);
    assert_eq!(says(7), [true, true, false, false, false, false, true]);
    assert_eq!(says(10), says(7));
    // The trail ends at the body's last location, and does not grow afterwards.
    let trail = |frame: usize| frames(&scene)[frame].past.trails[0].points.clone();
    assert_eq!((trail(1).len(), trail(6).len(), trail(10)), (0, 5, trail(6)));
}

#[test]
fn a_trail_of_a_body_that_comes_back_begins_anew() {
    let place = Place::new(&[
        (
            "run.csv",
            "t,body,x,y,z\n0,a,0,0,0\n0,b,0,5,0\n1,a,1,0,0\n1,b,0,5,0\n2,b,0,5,0\n3,a,9,0,0\n3,b,0,5,0\n4,a,8,0,0\n4,b,0,5,0\n",
        ),
        (
            "scene.toml",
            "simulation = { duration = 4, frame_rate = 1 }\n[defaults.body]\nmotion.trajectory.file = 'run.csv'\n\
             [body.a]\nshape.sphere.radius = 0.1\ntrail = true\n[body.b]\nshape.sphere.radius = 0.1\n",
        ),
    ]);
    let scene = place.read("scene.toml");
    assert_eq!(present(&scene), [vec![0, 1], vec![0, 1], vec![1], vec![0, 1], vec![0, 1]]);
    let frames = frames(&scene);
    let points = |frame: usize| frames[frame].past.trails[0].points.iter().map(|point| point.location.x);
    assert_eq!(points(2).collect::<Vec<_>>(), [0.0, 1.0]);
    assert_eq!(points(4).collect::<Vec<_>>(), [9.0, 8.0]);
    // Next to the gap, velocities follow from the rows on the same side of the gap: 1 m/s before it, −1 m/s after it.
    let velocity = |frame: usize| frames[frame].body(0).unwrap().velocity.x;
    assert_eq!((velocity(1), velocity(3)), (1.0, -1.0));
}

/// Checks which missing rows are gaps in a body's presence. A body with rows at its own times has no gap, however many rows of other
/// bodies lie between. A missing row among regular ones is a gap.
#[test]
fn a_gap_is_where_a_body_lacks_rows_for_longer_than_usual() {
    let mut rows = String::from("t,body,x,y,z\n");
    for step in 0..=40 {
        let time = f64::from(step) * 0.1;
        let mut row = |name: &str| writeln!(rows, "{time:.1},{name},{step},0,0").unwrap();
        row("all");
        if step % 5 == 0 {
            row("few");
        }
        if ![20, 30, 31].contains(&step) {
            row("gaps");
        }
        if step == 7 {
            row("once");
        }
        if (10..=30).contains(&step) {
            row("some");
        }
    }
    let text = "simulation = { duration = 4, frame_rate = 10 }\n[defaults.body]\nshape.sphere.radius = 1\n\
        motion.trajectory.file = 'run.csv'\n[body.all]\n[body.few]\n[body.gaps]\n[body.once]\n[body.some]\n";
    let place = Place::new(&[("run.csv", &rows), ("scene.toml", text)]);
    let scene = place.read("scene.toml");
    let (first, last) = (f64::NEG_INFINITY, f64::INFINITY);
    let expected: [&[[f64; 2]]; 5] = [
        &[[first, last]],
        &[[first, last]],
        &[[first, 1.9], [2.1, 2.9], [3.2, last]],
        &[[0.7, 0.7]],
        &[[1.0, 3.0]],
    ];
    for (body, expected) in scene.bodies.iter().zip(expected) {
        assert_eq!(body.presence.intervals(), expected, "{}", body.name);
    }
    let there = present(&scene);
    assert_eq!((&there[7][..], &there[20][..]), (&[0, 1, 2, 3][..], &[0, 1, 4][..]));
    // Exporting the scene gives the table again, and so does exporting a scene that reads this exported table.
    let export = |scene: &str, file: &str| {
        let (scene, file) = (place.path(scene), place.path(file));
        let output = jabuka().arg("export").arg(scene).arg("-o").arg(&file).output().unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
        fs::read_to_string(file).unwrap()
    };
    let table = export("scene.toml", "out.csv");
    assert_eq!(table.lines().filter(|line| line.contains(",gaps,")).count(), 38);
    fs::write(place.path("again.toml"), text.replace("run.csv", "out.csv")).unwrap();
    assert_eq!(present(&place.read("again.toml")), there);
}

#[test]
fn a_file_that_is_shorter_than_the_run_is_said_once_and_bodies_that_are_never_there() {
    let rows = "t,body,x,y,z\n1,a,0,0,0\n1,b,0,0,0\n2,a,0,0,0\n2,b,0,0,0\n";
    let text = "simulation.duration = 4\n[defaults.body]\nshape.sphere.radius = 1\n\
        [body.a]\nmotion.trajectory.file = 'run.csv'\n[body.b]\nmotion.trajectory.file = 'run.csv'\nend = 0.5\n\
        [body.late]\nstart = 7\n[body.early]\nend = -1\n[camera]\nfollow.body = 'late'\n";
    let place = Place::new(&[("run.csv", rows), ("scene.toml", text)]);
    let output = jabuka().current_dir(place.0.path()).args(["check", "scene.toml"]).output().unwrap();
    assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
    let said = stderr(&output);
    for (text, count) in [
        ("warning[short-trajectory]: `run.csv` has no rows before 1 s, and none after 2 s", 1),
        ("warning[never-there]: `b` is never there", 1),
        ("warning[never-there]: `late` is never there", 1),
        ("warning[never-there]: `early` is never there", 1),
        ("warning[never-there]: the camera follows `late`, which is never there", 1),
        ("warning[", 5),
    ] {
        assert_eq!(said.matches(text).count(), count, "{text}\n{said}");
    }
}

/// Checks a camera that follows a body: after the body's end it stays where the body was last, also in a still. Before the body's start it
/// looks at the place of the start.
#[test]
fn a_camera_stays_where_the_body_was_that_it_follows() {
    for lag in ["", ", lag = 0.5"] {
        let scene = scene(&format!(
            "{SPARKS}
            [body.ball]
            shape.sphere.radius = 0.1
            location = [5, 0, 0]
            velocity = [1, 5, 0]
            start = 0.2
            end = 0.6
            [camera]
            follow = {{ body = 'ball', distance = 3{lag} }}
            "
        ));
        let run = Run::new(&scene).unwrap();
        let look_at = |frame: &Frame| run.emitter().plan().camera(frame).look_at();
        let frames: Vec<Frame> = run.frames().map(Result::unwrap).collect();
        assert_eq!(look_at(&frames[0]), DVec3::new(5.0, 0.0, 0.0));
        let last = look_at(&frames[6]);
        if lag.is_empty() {
            assert_eq!(last, frames[6].body(0).unwrap().location);
        }
        assert!(last.y > 0.1, "{last}");
        assert_eq!(look_at(&frames[10]), last);
        assert_eq!(look_at(&run.at(0.85).unwrap().frame), last);
    }
}

/// Checks that a formula for a motion needs a value only while its body exists.
#[test]
fn a_motion_has_to_be_known_while_the_body_is_there() {
    let scene = scene(&format!(
        "{SPARKS}
        [body.ball]
        shape.sphere.radius = 0.1
        motion.formula.location = ['sqrt(t - 0.4)', 0, 0]
        start = 0.5
        [body.free]
        shape.sphere.radius = 0.1
        [force.s.spring]
        between = ['ball', 'free']
        stiffness = 3
        "
    ));
    let last = frames(&scene).pop().unwrap();
    assert!((last.body(0).unwrap().location.x - libm::sqrt(0.6)).abs() < 1e-15);
    assert!(last.body(1).unwrap().location.is_finite());
}

/// Checks that bodies which appear inside each other cause no warning, as sparks do, but that a ball flying into another one does.
#[test]
fn bodies_that_are_born_in_each_other_belong_together() {
    let pair = |keys: &str| {
        scene(&format!(
            "{SPARKS}
            [body.one]
            shape.sphere.radius = 0.2
            velocity = [3, 0, 0]
            start = 0.3
            [body.other]
            shape.sphere.radius = 0.2
            velocity = [-1, 0, 0]
            {keys}
            "
        ))
    };
    let found = |keys: &str| survey(&pair(keys), |_| {}).unwrap().overlap.map(|overlap| overlap.time);
    assert_eq!(found("start = 0.3"), None);
    assert_eq!(found("location = [2, 0, 0]\nstart = 0.3"), Some(0.8));
    assert_eq!(found("location = [2, 0, 0]\nstart = 0.3\nend = 0.6"), None);
}

/// Checks the warning for bodies that pass through a plane without contacts. A body that starts above the floor passes it later; one that
/// starts below does not, and nothing passes a floor that does not exist at that time.
#[test]
fn planes_are_crossed_by_bodies_that_come_later() {
    let crossing = |floor: &str, height: f64| {
        let scene = scene(&format!(
            "{SPARKS}
            [body.floor]
            shape.plane = {{}}
            {floor}
            [body.ball]
            shape.sphere.radius = 0.1
            location = [0, {height}, 0]
            start = 0.25
            "
        ));
        survey(&scene, |_| {}).unwrap().crossings.first().map(|crossing| crossing.time)
    };
    // The body falls by ½ g t² > 0.3 m after 0.245 s.
    assert_eq!(crossing("", 0.4), Some(0.5));
    assert_eq!(crossing("", -0.4), None);
    assert_eq!(crossing("end = 0.4", 0.4), None);
    assert_eq!(crossing("start = 0.7", 0.4), None);
}

/// Checks that stills show exactly the existing bodies, also between two frames and in the moments of an open shutter.
#[test]
fn stills_show_who_is_there() {
    let scene = scene(&format!(
        "{SPARKS}
        [body.a]
        shape.sphere.radius = 0.1
        start = 0.33
        end = 0.36
        [body.b]
        shape.sphere.radius = 0.1
        [camera]
        shutter = 0.05
        samples = 5
        "
    ));
    let recorded = Recorded::new(&scene).unwrap();
    for (time, there) in [(0.32, 1), (0.33, 2), (0.35, 2), (0.36, 2), (0.37, 1)] {
        assert_eq!(recorded.at(time).unwrap().frame.bodies.len(), there, "{time}");
    }
    let shutter = scene.camera.shutter.unwrap();
    let exposure = recorded.at(0.3).unwrap();
    let seen: Vec<usize> = exposure.moments(shutter).map(|moment| moment.unwrap().bodies.len()).collect();
    // The moments are 0.305, 0.315, 0.325, 0.335 and 0.345 s.
    assert_eq!(seen, [1, 1, 1, 2, 2]);
}

/// Checks the automatic camera. If showing the whole run would make the bodies too small, the camera goes along with those that are there.
#[test]
fn no_body_comes_outside_of_what_an_automatic_camera_frames() {
    let scene = scene(
        "simulation = { duration = 10, frame_rate = 5 }
        [body.near]
        shape.sphere.radius = 0.1
        [body.far]
        shape.sphere.radius = 0.1
        location = [200, 0, 0]
        start = 3
        [body.alone]
        shape.sphere.radius = 0.1
        location = [0, 9, 0]
        velocity = [500, 0, 0]
        end = 1
        ",
    );
    let all_are_seen = |scene: &Scene| {
        let run = Run::new(scene).unwrap();
        assert!(run.emitter().plan().camera_moves());
        for frame in run.frames().map(Result::unwrap) {
            let screen = run.emitter().plan().camera(&frame).screen();
            for body in &frame.bodies {
                let spot = screen.project(body.location).unwrap();
                assert!(spot.x.abs() <= 1.0 && spot.y.abs() < 9.0 / 16.0, "{} at {} s", body.id, frame.time);
            }
        }
    };
    all_are_seen(&scene);
    let only = |keys: &str| {
        self::scene(&format!(
            "simulation = {{ duration = 30, gravity = [0, -9.81, 0] }}\n[body.ball]\nshape.sphere.radius = 0.1\n\
             velocity = [30, 90, 0]\n{keys}"
        ))
    };
    for keys in ["", "end = 9", "start = 4"] {
        all_are_seen(&only(keys));
    }
}

/// Checks a ball on a rod: when the hook disappears, the ball flies off, and only gravity changes its velocity.
#[test]
fn a_joint_holds_while_both_of_its_ends_are_there() {
    let scene = scene(&format!(
        "{SPARKS}
        [body.hook]
        shape.sphere.radius = 0.05
        fixed = true
        end = 0.5
        [body.ball]
        shape.sphere.radius = 0.1
        location = [1, 0, 0]
        [joint.string.rod]
        between = ['hook', 'ball']
        "
    ));
    let balls: Vec<_> = frames(&scene).iter().map(|frame| *frame.body(1).unwrap()).collect();
    assert!(balls[..=5].iter().all(|ball| (ball.location.length() - 1.0).abs() < 1e-9));
    for pair in balls[5..].windows(2) {
        let change = pair[1].velocity - pair[0].velocity;
        assert!(change.abs_diff_eq(DVec3::NEG_Y, 1e-12), "{change}");
    }
    assert!(balls[10].location.length() > 1.1);
}
