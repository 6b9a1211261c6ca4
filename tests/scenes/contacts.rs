//! Tests of contacts in labels, drawings and tables, mostly with made-up impacts. The physics of impacts is tested in `tests/physics`.

use crate::support::{jabuka, stderr, stdout};
use glam::DVec3;
use jabuka::export::write_events;
use jabuka::physics::{Breakdown, Dynamics, Impact, Snapshot, World};
use jabuka::simulate::{Recorded, world};
use jabuka::{Run, Scene};

/// A world that reports given impacts, which did not happen.
struct Told {
    world: World,
    impacts: Vec<Impact>,
}

impl Dynamics for Told {
    fn time(&self) -> f64 {
        Dynamics::time(&self.world)
    }

    fn advance(&mut self, t: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) -> Result<(), Breakdown> {
        self.world.advance(t, moments, see)
    }

    fn snapshot(&mut self) -> Result<Snapshot, Breakdown> {
        self.world.snapshot()
    }

    fn impacts(&mut self) -> Vec<Impact> {
        let now = Dynamics::time(&self.world);
        let later = self.impacts.split_off(self.impacts.partition_point(|impact| impact.time <= now));
        std::mem::replace(&mut self.impacts, later)
    }

    fn steps(&self) -> u64 {
        self.world.steps()
    }
}

const SCENE: &str = "
    [simulation]
    duration = 1
    frame_rate = 10
    integrator = 'rk4'
    contacts = 'event-driven'
    [body.a]
    shape.sphere.radius = 1
    location = [0, 5, 0]
    [body.b]
    shape.sphere.radius = 1
    location = [5, 5, 0]
    [label.count]
    text = '${impacts} in all, ${a.impacts} of a, ${b.impacts.a} of both, ${a.impacts.ground}'
    [label.b]
    body = 'b'
    text = 'b: ${impacts}'
    ";

/// Returns three impacts in the second interval, one of them at the time of its frame, and one before the last frame.
fn impacts() -> Vec<Impact> {
    let impact = |(time, bodies): (f64, [usize; 2])| Impact {
        time,
        bodies,
        place: DVec3::new(time, -0.5, 0.0),
        normal: DVec3::X,
        impulse: DVec3::new(2.5, 0.0, -1.0),
        energy: 0.125,
    };
    [(0.11, [0, 1]), (0.15, [0, 2]), (0.2, [1, 2]), (0.93, [0, 1])].map(impact).into()
}

fn recorded(scene: &Scene) -> Recorded<'_> {
    Recorded::of(scene, Box::new(Told { world: world(scene), impacts: impacts() })).unwrap()
}

#[test]
fn labels_count_the_impacts_up_to_their_frame() {
    let scene = Scene::parse(SCENE).unwrap();
    let run = Run::of(recorded(&scene)).unwrap();
    let said = |frame: usize, words: &str| {
        let script = run.script(&run.frames().nth(frame).unwrap().unwrap()).unwrap();
        assert!(script.contains(words), "frame {frame}: {words}\n{script}");
    };
    said(1, "0 in all, 0 of a, 0 of both, 0");
    said(2, "3 in all, 2 of a, 1 of both, 1");
    said(2, "b: 2");
    said(10, "4 in all, 3 of a, 2 of both, 1");
    // A single moment counts the impacts before it, too.
    let exposures: Vec<_> = [0.1, 0.2].map(|time| run.at(time).unwrap().frame.impacts).into();
    assert_eq!((exposures[0].of_run(), exposures[1].of_run()), (0.0, 3.0));
}

/// Checks that each moment of an open shutter counts the impacts before it, and each impact only once.
#[test]
fn moments_between_frames_count_what_was_before_them() {
    let scene = Scene::parse(&format!("{SCENE}\n[camera]\nshutter = 0.08\nsamples = 2")).unwrap();
    let run = recorded(&scene);
    let shutter = scene.camera.shutter.unwrap();
    let exposure = run.at(0.1).unwrap();
    let counts: Vec<f64> = exposure.moments(shutter).map(|moment| moment.unwrap().impacts.of_run()).collect();
    assert_eq!(counts, [1.0, 2.0], "at 0.12 s and 0.16 s");
    assert_eq!(run.impacts().count(), 4);
}

#[test]
fn events_are_a_table_of_all_impacts() {
    let scene = Scene::parse(SCENE).unwrap();
    let mut table = Vec::new();
    let rows = write_events(&recorded(&scene), &mut table).unwrap();
    let table = String::from_utf8(table).unwrap();
    assert_eq!(rows, 4);
    insta::assert_snapshot!(table, @r"
    t [s],body,other,x [m],y [m],z [m],nx,ny,nz,jx [N·s],jy [N·s],jz [N·s],lost [J]
    0.11,a,b,0.11,-0.5,0,1,0,0,2.5,0,-1,0.125
    0.15,a,ground,0.15,-0.5,0,1,0,0,2.5,0,-1,0.125
    0.2,b,ground,0.2,-0.5,0,1,0,0,2.5,0,-1,0.125
    0.93,a,b,0.93,-0.5,0,1,0,0,2.5,0,-1,0.125
    ");
}

#[test]
fn events_need_contacts_and_a_table() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, SCENE).unwrap();
    let export = |file: &str, more: &[&str]| {
        let file = folder.path().join(file);
        jabuka().arg("export").arg(&scene).arg("-o").arg(file).arg("--events").args(more).output().unwrap()
    };
    let output = export("events.csv", &[]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stdout(&output).ends_with("events.csv: 0 impacts\n"), "{}", stdout(&output));
    assert!(stderr(&export("events.glb", &[])).contains("`--events` makes a table"));
    assert_eq!(export("events.csv", &["--frames", "1"]).status.code(), Some(2));
    std::fs::write(&scene, "[body.a]\nshape.sphere.radius = 1\n").unwrap();
    let said = stderr(&export("events.csv", &[]));
    assert!(said.contains("`simulation.contacts = \"event-driven\"` finds them"), "{said}");
}

/// Checks that `--events FILE`, `--events -o FILE`, and the option before the scene write the same table.
#[test]
fn the_file_of_events_can_be_named_in_three_ways() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    let export = |words: &[&str]| {
        let output = jabuka().current_dir(folder.path()).arg("export").args(words).output().unwrap();
        (output.status.code(), stderr(&output))
    };
    let ways: [(&str, &[&str]); 3] = [
        ("a.csv", &["scene.toml", "--events", "a.csv"]),
        ("b.csv", &["scene.toml", "--events", "-o", "b.csv"]),
        ("c.csv", &["-o", "c.csv", "--events", "scene.toml"]),
    ];
    for (file, words) in ways {
        assert_eq!(export(words), (Some(0), String::new()), "{words:?}");
        let table = std::fs::read_to_string(folder.path().join(file)).unwrap();
        assert!(table.starts_with("t [s],body,other,"), "{table}");
    }
    for (words, said) in [
        (&["scene.toml", "--events", "a.csv", "-o", "b.csv"][..], "leave one out"),
        (&["scene.toml", "--events"][..], "name the file to write: `--events FILE.csv`"),
        (&["--events"][..], "name the scene file"),
        (&["scene.toml"][..], "--output"),
    ] {
        let (code, text) = export(words);
        assert_eq!(code, Some(2), "{text}");
        assert!(text.contains(said), "{text}");
    }
}

/// Checks that a scene whose bodies never touch gives the same frames with and without contacts, and that the ground is not one of the
/// bodies.
#[test]
fn the_ground_is_no_body_of_any_frame() {
    let scene = Scene::parse(SCENE).unwrap();
    let run = recorded(&scene);
    assert!(run.frames().all(|frame| frame.unwrap().bodies.len() == 2));
    let without = SCENE.replace("contacts = 'event-driven'", "");
    let (without, _) = without.split_once("[label").unwrap();
    let without = Scene::parse(without).unwrap();
    let plain = Recorded::new(&without).unwrap();
    for (one, other) in Recorded::new(&scene).unwrap().frames().zip(plain.frames()) {
        let (one, other) = (one.unwrap(), other.unwrap());
        assert_eq!((one.bodies, one.balance), (other.bodies, other.balance));
    }
}

#[test]
fn arrows_show_weight_from_the_centre_in_front_of_the_body() {
    let text = "simulation = { duration = 0, contacts = 'event-driven', gravity = [0, -10, 0], integrator = 'rk4' }
        [body.a]\nshape.sphere.radius = 1\nlocation = [0, 5, 0]\narrows = { weight.scale = 0.1, normal = true, friction = true }
        camera = { location = [0, 5, 10], look_at = [0, 5, 0], projection = 'orthographic' }";
    let (bodies, camera) = text.split_once("camera = ").unwrap();
    let scene = Scene::parse(&format!("camera = {camera}\n{bodies}")).unwrap();
    let run = Run::new(&scene).unwrap();
    let frame = run.frames().next().unwrap().unwrap();
    let script = run.script(&frame).unwrap();
    let line = script.lines().find(|line| line.ends_with("// a, weight")).unwrap_or(&script);
    assert!(line.starts_with("Arrow(<0, 5, 1."), "in front of the ball, which reaches to z = 1: {line}");
    assert!(script.contains("#macro Arrow("), "{script}");
    assert!(!script.contains("// a, normal"), "nothing touches it");
}

/// Checks the number of impacts in the scene of colliding blocks, for mass ratios set on the command line: it has the digits of π.
#[test]
fn the_scene_spells_pi_for_every_ratio() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/pi_by_collisions.toml");
    for (ratio, count) in
        [("1", 3), ("100", 31), ("1e4", 314), ("1e6", 3141), ("1e8", 31415), ("1e10", 314_159)]
    {
        let folder = tempfile::tempdir().unwrap();
        let ratio = format!("variables.ratio={ratio}");
        let mut command = jabuka();
        command.args(["compile", scene, "--frames", "125", "--no-cache", "--set", &ratio, "-o"]);
        let output = command.arg(folder.path()).output().unwrap();
        assert!(output.status.success(), "{output:?}");
        let said = stdout(&output);
        assert!(
            said.contains(&format!("impacts   {count}; contacts took 0 J; friction took 0 J")),
            "{ratio}: {said}"
        );
    }
}
