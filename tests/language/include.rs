//! Tests of scenes that include other files.

use std::fs;
use std::path::Path;

use jabuka::Scene;
use jabuka::diagnostic::{Code, Report};
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
    assert_eq!(scene.simulation.duration, 3.0);
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
    assert!(matches!(scene.bodies[0].shape, jabuka::dynamics::Shape::Box { .. }));
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
