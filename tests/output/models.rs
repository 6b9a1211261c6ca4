//! Tests of exports that are refused.

use std::fs;

use crate::support::{jabuka, scene, stderr, stdout};

#[test]
fn what_is_no_known_kind_of_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["run.gltf", "run", "run.toml"] {
        let path = folder.path().join(name);
        let scene = scene("parabola");
        let output = jabuka().arg("export").arg(scene).arg("-o").arg(&path).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
        assert!(
            stderr(&output)
                .contains("an export is a table, `.csv`, or a model, `.glb`, or a web page, `.html`; `"),
            "{}",
            stderr(&output)
        );
        assert!(!path.exists());
    }
}

#[test]
fn a_body_beyond_the_numbers_of_the_format_is_an_error_and_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, file] = ["far.toml", "far.glb"].map(|name| folder.path().join(name));
    fs::write(&scene, "[body.probe]\nshape.sphere.radius = 1\nlocation = [1e39, 0, 0]\n").unwrap();
    let output = jabuka().arg("export").arg(&scene).arg("-o").arg(&file).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.contains("error[cannot-export]: `") && said.contains("`probe` is farther away"), "{said}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left over");
}

/// Tables and models show a wrong motion as well as pictures do, so `export` gives the same warnings as `compile`.
#[test]
fn a_motion_that_passes_through_the_ground_gets_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, file] = ["fall.toml", "fall.csv"].map(|name| folder.path().join(name));
    fs::write(&scene, "[simulation]\ngravity = [0, -9.81, 0]\n[environment]\nground.height = -1\n[body.ball]\nshape.sphere.radius = 0.1\n")
        .unwrap();
    let output = jabuka().arg("export").arg(&scene).arg("-o").arg(&file).output().unwrap();
    let said = stderr(&output);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("warning[crossing]"), "{said}");
    assert!(file.exists());
}

#[test]
fn a_page_of_some_frames_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("run.html");
    let mut export = jabuka();
    export.arg("export").arg(scene("parabola")).args(["--frames", "0-3", "-o"]).arg(&page);
    let output = export.output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("holds all frames of a run: leave out `--frames`"),
        "{}",
        stderr(&output)
    );
    assert!(!page.exists());
}

#[test]
fn a_page_that_no_browser_could_read_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, page] = ["many.toml", "many.html"].map(|name| folder.path().join(name));
    let text = "simulation = { duration = 400, frame_rate = 25 }
        [body.a]\nshape.sphere.radius = 0.1\nlocation = ['i', 0, 0]\nrepeat = 1000\n";
    fs::write(&scene, text).unwrap();
    let output = jabuka().arg("export").arg(&scene).arg("-o").arg(&page).output().unwrap();
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("would hold 560 MB of motion"), "{said}");
    assert!(!page.exists());
}
