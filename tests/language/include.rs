//! Tests of scenes that include other files.

use std::fs;
use std::path::Path;

use jabuka::Scene;
use jabuka::diagnostic::{Code, Diagnostic, Report};
use jabuka::scene::source::parse;
use jabuka::scene::{Options, Override};

/// Writes files into a folder. Each entry holds a relative path and the text.
fn write(folder: &Path, files: &[(&str, &str)]) {
    for (name, text) in files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

/// Writes the files into a temporary folder, and reads `scene.toml` with the overrides `sets`, as `--set` gives them.
fn read(files: &[(&str, &str)], sets: &[&str]) -> Result<Scene, Report> {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), files);
    let overrides = sets.iter().map(|set| Override::new(*set)).collect();
    let options = Options { overrides, ..Options::default() };
    Scene::from_path_with(folder.path().join("scene.toml"), &options)
}

fn names(scene: &Scene) -> Vec<&str> {
    scene.bodies.iter().map(|body| &*body.name).collect()
}

const BALL: (&str, &str) = ("ball.toml", "[body.ball]\nshape.sphere.radius = 2\nmass = 3\n");

#[test]
fn what_is_included_is_as_if_it_stood_there_and_comes_first() {
    let scene = "include = ['ball.toml', 'parts/look.toml']\n[body.own]\nshape.sphere.radius = 'r'\nmaterial = 'shiny'\nlocation = [5, 0, 0]";
    let look = (
        "parts/look.toml",
        "variables.r = 0.5\n[material.shiny]\nfinish = 'metal'\n[simulation]\nduration = 3\n",
    );
    let scene = read(&[("scene.toml", scene), BALL, look], &[]).unwrap();
    assert_eq!(names(&scene), ["ball", "own"]);
    assert_eq!(scene.simulation.timeline.duration, 3.0);
    assert_eq!(scene.materials[scene.bodies[1].material.unwrap()].name, "shiny");
}

#[test]
fn what_a_file_says_itself_counts_key_by_key_and_settings_count_most() {
    let scene = "include = ['ball.toml']\n[body.ball]\nmass = 5\nvelocity = [1, 0, 0]\n";
    let scene = read(&[("scene.toml", scene), BALL], &["body.ball.velocity=[2, 0, 0]"]).unwrap();
    let start = &scene.bodies[0].start;
    assert_eq!((start.mass, start.velocity.x), (5.0, 2.0));
    let other = "include = ['ball.toml']\n[body.ball]\nshape.box.size = [1, 1, 1]\n";
    let scene = read(&[("scene.toml", other), BALL], &[]).unwrap();
    assert!(matches!(scene.bodies[0].shape, jabuka::physics::Shape::Box { .. }));
}

#[test]
fn names_start_from_the_folder_of_the_file_that_they_stand_in() {
    let files = [
        ("scene.toml", "include = ['parts/car.toml']"),
        ("parts/car.toml", "include = ['wheels/front.toml', '../ball.toml']"),
        ("parts/wheels/front.toml", "[body.wheel]\nshape.sphere.radius = 1\nlocation = [9, 0, 0]"),
        BALL,
    ];
    assert_eq!(names(&read(&files, &[]).unwrap()), ["wheel", "ball"]);
}

#[test]
fn a_file_that_is_included_twice_is_there_once() {
    let files = [
        ("scene.toml", "include = ['a.toml', 'b.toml', 'ball.toml']"),
        ("a.toml", "include = ['ball.toml']"),
        ("b.toml", "include = ['./ball.toml']"),
        BALL,
    ];
    assert_eq!(names(&read(&files, &[]).unwrap()), ["ball"]);
}

#[test]
fn defaults_are_for_all_files_and_their_own_keys_count_more() {
    let style = ("style.toml", "[defaults.body]\nmass = 7\nvelocity = [1, 0, 0]\n");
    let scene = "include = ['style.toml', 'ball.toml']\n[defaults.body]\nvelocity = [2, 0, 0]\n\
                 [body.own]\nshape.sphere.radius = 1\nlocation = [5, 0, 0]";
    let scene = read(&[("scene.toml", scene), style, BALL], &[]).unwrap();
    let starts: Vec<_> = scene.bodies.iter().map(|body| (body.start.mass, body.start.velocity.x)).collect();
    assert_eq!(starts, [(3.0, 2.0), (7.0, 2.0)]);
}

#[test]
fn random_numbers_are_those_of_the_body_in_whatever_file_it_stands() {
    let body = "[body.a]\nshape.sphere.radius = 'uniform(1, 2)'\n";
    let alone = Scene::parse(body).unwrap();
    let included = read(&[("scene.toml", "include = ['a.toml']"), ("a.toml", body)], &[]).unwrap();
    assert_eq!(included.bodies[0].shape, alone.bodies[0].shape);
}

#[test]
fn the_digest_is_that_of_all_files() {
    let digest = |mass: &str| {
        let ball = format!("[body.ball]\nshape.sphere.radius = 2\nmass = {mass}\n");
        read(&[("scene.toml", "include = ['ball.toml']"), ("ball.toml", &ball)], &[]).unwrap().digest
    };
    assert_ne!(digest("1"), digest("2"));
}

#[test]
fn nothing_outside_of_the_folder_of_the_scene_is_included_without_trust() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &[("inner/scene.toml", "include = ['../ball.toml']"), BALL]);
    let scene = folder.path().join("inner/scene.toml");
    let report = Scene::from_path(&scene).unwrap_err();
    assert_eq!(report.diagnostics[0].code, Code::UntrustedPath, "{report}");
    let options = Options { trust: true, ..Options::default() };
    assert_eq!(names(&Scene::from_path_with(&scene, &options).unwrap()), ["ball"]);
}

#[test]
fn what_is_no_text_is_said_to_be_none() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &[("scene.toml", "include = ['image.toml']")]);
    fs::write(folder.path().join("image.toml"), [0xff, 0xfe, 0]).unwrap();
    let report = Scene::from_path(folder.path().join("scene.toml")).unwrap_err();
    let said = report.to_text(false);
    assert!(
        said.contains("error[cannot-include]: cannot include `image.toml`: the file is not UTF-8"),
        "{said}"
    );
    assert!(said.contains("scene.toml:1:12"), "{said}");
}

#[test]
fn a_long_chain_of_files_ends_with_an_error() {
    let files: Vec<(String, String)> = (0..100)
        .map(|n| (format!("f{n}.toml"), format!("include = ['f{}.toml']", n + 1)))
        .chain([("scene.toml".to_owned(), "include = ['f0.toml']".to_owned())])
        .collect();
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let report = read(&files, &[]).unwrap_err();
    assert!(report.diagnostics[0].message.contains("more than 50 deep"), "{report}");
}

/// Returns the name, line and column of each diagnostic, after it has been shown as text and as JSON. Checks that each fix, applied, gives
/// a text that can be parsed.
fn places(report: &Report) -> Vec<(&'static str, String, usize, usize)> {
    report.to_text(true);
    report.to_json();
    let place = |diagnostic: &Diagnostic| {
        let span = diagnostic.span().unwrap();
        if let Some(fix) = &diagnostic.fix {
            let (source, text) = fix.applied(&report.sources).unwrap();
            let mut said = Vec::new();
            if report.sources.get(source).name == "--set" {
                assert!(Override::new(text.as_str()).is_setting(), "{text}");
            } else {
                parse(&text, source, &mut said);
            }
            assert!(said.is_empty(), "{text}\n{said:?}");
        }
        let (at, name) = (report.sources.start(span), &report.sources.get(span.source()).name);
        let name = Path::new(name).file_name().unwrap().to_string_lossy().into_owned();
        (diagnostic.code.name(), name, at.line, at.column)
    };
    report.diagnostics.iter().map(place).collect()
}

/// A key at the top that belongs to `[simulation]`, which is in another text.
#[test]
fn a_key_of_a_table_in_another_text_is_an_error_in_its_own_text() {
    let scene = "# A ball.\n[simulation]\nduration = 1\n[body.ball]\nshape.sphere.radius = 0.5\n";
    let error = |name: &str, line| vec![("unknown-key", name.to_owned(), line, 1)];
    for key in ["gravity=[0, -1, 0]", "frame_rate=30", "step=0.01", "contacts=\"event-driven\""] {
        let report = read(&[("scene.toml", scene)], &[key]).unwrap_err();
        assert_eq!(places(&report), error("--set", 1), "{report}");
        assert!(report.to_text(false).contains("simulation"), "{report}");

        let part = ("part.toml", &*format!("# Of all scenes.\n{key}\n"));
        let scene = format!("include = ['part.toml']\n{scene}");
        let report = read(&[("scene.toml", &scene), part], &[]).unwrap_err();
        assert_eq!(places(&report), error("part.toml", 2), "{report}");
        // And the other way round: the table is in the included file.
        let report = read(
            &[("scene.toml", &format!("include = ['part.toml']\n{key}\n")), ("part.toml", &scene[23..])],
            &[],
        )
        .unwrap_err();
        assert_eq!(places(&report), error("scene.toml", 2), "{report}");
    }
}

/// Keys of a body whose table is in another text, longer than the text with the key.
#[test]
fn a_mistake_about_a_table_of_another_text_is_shown_in_its_own_text() {
    let comment = "# A long line that moves all places of this file away from those of the others.\n";
    let ball = format!("{comment}[body.ball]\nshape.sphere.radius = 0.5\n");
    for key in [
        "body.ball.radius=1",
        "body.ball.orientation={ axis = [0, 1, 0] }",
        "body.ball.gravity=[0, -1, 0]",
        "body.ball.color=\"red\"",
        "body.ball.material=[1, 0, 0]",
        "body.ball.motion=\"a.csv\"",
        "camera.look_at=\"ball\"",
        "body.ball.collides=5",
        "force.g.gravity=true",
        "body.ball.friction=0.3",
        "sphere.radius=3",
    ] {
        for sets in [true, false] {
            let scene = if sets { ball.clone() } else { format!("include = ['part.toml']\n{ball}") };
            let (part, settings) = if sets { ("", vec![key]) } else { (key, Vec::new()) };
            let Err(report) = read(&[("scene.toml", &scene), ("part.toml", part)], &settings) else {
                continue;
            };
            let text = if sets { "--set" } else { "part.toml" };
            assert!(places(&report).iter().any(|(_, name, ..)| name == text), "{report}");
        }
    }
}

/// The size of a body is found before its keys are checked, so that copies do not overlap.
#[test]
fn an_axis_without_an_angle_is_one_error_also_where_copies_are_kept_apart() {
    let body = "[body.a]\nshape.sphere.radius = 0.1\n";
    let turned = "orientation = { axis = [0, 1, 0] }\n";
    for repeat in [
        "scatter = { count = 2, within.sphere.radius = 2 }",
        "ring = { count = 3, radius = 2 }",
        "scatter = { count = 2, within.box.size = [3, 3, 3] }",
    ] {
        let repeat = format!("repeat.{repeat}\n");
        let one = |name: &str, line| vec![("missing-key", name.to_owned(), line)];
        let where_it_is = |report: Report| -> Vec<_> {
            places(&report).into_iter().map(|(code, name, line, _)| (code, name, line)).collect()
        };
        let scene = format!("{body}{turned}{repeat}");
        let report = read(&[("scene.toml", &scene)], &[]).unwrap_err();
        assert!(report.to_text(false).contains("`angle`"), "{report}");
        assert_eq!(where_it_is(report), one("scene.toml", 3));
        let set = "body.a.orientation={ axis = [0, 1, 0] }";
        let report = read(&[("scene.toml", &format!("{body}{repeat}"))], &[set]).unwrap_err();
        assert_eq!(where_it_is(report), one("--set", 1));
        let files = [("scene.toml", "include = ['part.toml']"), ("part.toml", &*scene)];
        assert_eq!(where_it_is(read(&files, &[]).unwrap_err()), one("part.toml", 3));
    }
}
