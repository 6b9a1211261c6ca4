//! Tests of `--view`: the scripts of each camera go into their own folder.

use std::fs;

use crate::support::{jabuka, stderr, stdout};

const SCENE: &str = "
    simulation.duration = 0.2
    [body.ball]
    shape.sphere.radius = 1
    [camera]
    angle = 50
    [view.top]
    location = [0, 20, 0]
    [view.plan]
    projection = 'orthographic'
    width = 12
";

/// Writes the scene into a folder, and runs `jabuka compile` there.
fn run(folder: &std::path::Path, arguments: &[&str]) -> std::process::Output {
    fs::write(folder.join("scene.toml"), SCENE).unwrap();
    jabuka().current_dir(folder).args(["compile", "scene.toml"]).args(arguments).output().unwrap()
}

/// Returns the text of the camera in the first script of a folder.
fn camera(folder: &std::path::Path) -> String {
    let script = fs::read_to_string(folder.join("frame_0000.pov")).unwrap();
    let (_, camera) = script.split_once("camera {").unwrap();
    camera.split_once("\n}").unwrap().0.to_owned()
}

#[test]
fn all_cameras_are_written_each_into_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    assert!(run(folder.path(), &["--view", "all"]).status.success());
    let [main, top, plan] =
        ["scene", "scene-top", "scene-plan"].map(|name| camera(&folder.path().join("out").join(name)));
    assert!(main.contains("angle 50"), "{main}");
    assert!(top.contains("angle 50") && top.contains("location <0, 20, 0>"), "a view inherits: {top}");
    assert!(plan.contains("orthographic") && plan.contains("right -x*12"), "{plan}");
    // `--check` compares each camera's folder with its own scripts.
    let output = run(folder.path(), &["--view", "all", "--check"]);
    assert!(output.status.success(), "{}", stdout(&output));
}

#[test]
fn one_view_goes_into_the_folder_that_is_given() {
    let folder = tempfile::tempdir().unwrap();
    assert!(run(folder.path(), &["--view", "plan", "-o", "here"]).status.success());
    assert!(camera(&folder.path().join("here")).contains("orthographic"));
    assert!(!folder.path().join("out").exists());
    // Another camera in the same folder is another sequence: its scripts replace the old ones.
    let output = run(folder.path(), &["-o", "here", "--frames", "0"]);
    assert!(stdout(&output).contains("5 others of another scene removed"), "{}", stdout(&output));
}

#[test]
fn a_view_that_is_not_there_is_wrong_usage() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &["--view", "side"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("the views of this scene are top, plan"), "{}", stderr(&output));
}
