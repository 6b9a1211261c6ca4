//! Tests of users' own templates and of the shared layout.

use std::fs;
use std::path::Path;

use crate::support::{compile, contents, jabuka, scene, stderr};

/// Writes the built-in templates into a folder. Returns the path of the templates.
fn templates(folder: &Path) -> std::path::PathBuf {
    let templates = folder.join("templates");
    let output = jabuka().arg("templates").arg(&templates).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    templates
}

#[test]
fn the_built_in_templates_written_out_give_the_same_scripts() {
    let folder = tempfile::tempdir().unwrap();
    let templates = templates(folder.path());
    let (usual, own) = (folder.path().join("usual"), folder.path().join("own"));
    compile(&scene("tumbling_box"), &usual, &["--frames", "0,7"]);
    compile(&scene("tumbling_box"), &own, &["--frames", "0,7", "--templates", templates.to_str().unwrap()]);
    let scripts = |folder: &Path| contents(folder).into_iter().filter(|(name, _)| name.starts_with("frame_"));
    assert!(scripts(&usual).eq(scripts(&own)));
}

#[test]
fn one_template_changed_changes_only_what_it_says() {
    let folder = tempfile::tempdir().unwrap();
    let templates = folder.path().join("templates");
    fs::create_dir(&templates).unwrap();
    fs::write(
        templates.join("camera.inc"),
        "camera { location ${camera.location} look_at ${camera.look_at} }\n",
    )
    .unwrap();
    let (usual, own) = (folder.path().join("usual"), folder.path().join("own"));
    compile(&scene("tumbling_box"), &usual, &["--frames", "7"]);
    compile(&scene("tumbling_box"), &own, &["--frames", "7", "--templates", templates.to_str().unwrap()]);
    let parts = |folder: &Path| {
        let script = fs::read_to_string(folder.join("frame_0007.pov")).unwrap();
        let (before, rest) = script.split_once("camera {").unwrap();
        let (camera, after) = rest.split_once("\n\n").unwrap();
        [before, camera, after].map(str::to_owned)
    };
    let ([before, camera, after], own) = (parts(&usual), parts(&own));
    assert_eq!([&before, &after], [&own[0], &own[2]]);
    assert!(camera.contains("angle") && !own[1].contains("angle"));
}

#[test]
fn a_broken_template_is_an_error_at_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let templates = folder.path().join("templates");
    fs::create_dir(&templates).unwrap();
    for (text, place, words) in [
        ("// fine\n${camera.angl}\n", "camera.inc:2:3", "`camera.angl` is undefined"),
        ("// fine\n\n<% if %>\n", "camera.inc:3:", "syntax error"),
        ("${title}\n", "camera.inc:1:3", "no way to write none"),
    ] {
        fs::write(templates.join("camera.inc"), text).unwrap();
        let bare = folder.path().join("bare.toml");
        fs::write(&bare, "[body.ball]\nshape.sphere.radius = 1\n").unwrap();
        let mut command = jabuka();
        command.current_dir(folder.path()).arg("compile").arg(&bare).arg("--templates").arg(&templates);
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        let said = stderr(&output);
        assert!(
            said.contains("error[bad-template]") && said.contains(place) && said.contains(words),
            "{said}"
        );
        assert!(!folder.path().join("out").exists(), "nothing is written");
    }
}

#[test]
fn a_folder_without_templates_is_refused_and_files_that_are_there_stay() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = jabuka();
    command.arg("compile").arg(scene("tumbling_box")).arg("--templates").arg(folder.path());
    let output = command.output().unwrap();
    assert!(stderr(&output).contains("error[no-templates]"), "{}", stderr(&output));

    fs::write(folder.path().join("lights.inc"), "mine").unwrap();
    let output = jabuka().arg("templates").arg(folder.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(contents(folder.path()), [("lights.inc".to_owned(), b"mine".to_vec())]);
}

#[test]
fn templates_that_a_scene_brings_along_need_trust() {
    let folder = tempfile::tempdir().unwrap();
    templates(folder.path());
    let scene = folder.path().join("scene.toml");
    fs::write(&scene, "povray.templates = 'templates'\n[body.ball]\nshape.sphere.radius = 1\n").unwrap();
    let run = |arguments: &[&str]| {
        jabuka().current_dir(folder.path()).arg("compile").arg(&scene).args(arguments).output().unwrap()
    };
    let output = run(&[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("error[untrusted-templates]"), "{}", stderr(&output));
    assert!(run(&["--trust"]).status.success());
}

#[test]
fn in_the_shared_layout_what_never_changes_is_written_once() {
    let folder = tempfile::tempdir().unwrap();
    compile(&scene("tumbling_box"), folder.path(), &["--set", "output.layout=shared", "--frames", "0-9"]);
    let names: Vec<String> = contents(folder.path()).into_iter().map(|(name, _)| name).collect();
    assert!(names.contains(&"common.inc".to_owned()), "{names:?}");
    let script = fs::read_to_string(folder.path().join("frame_0003.pov")).unwrap();
    assert!(script.contains("#include \"common.inc\"") && script.len() < 600, "{script}");
    // A compilation with another layout removes the shared file.
    compile(&scene("tumbling_box"), folder.path(), &["--frames", "0-9"]);
    assert!(!folder.path().join("common.inc").exists());
}
