//! Tests of `compile --check`, which compares the scripts of a folder with those that the scene gives.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::support::{compile, contents, jabuka, scene, stderr, stdout};

fn check(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = jabuka();
    command.arg("compile").arg(scene("damped_spring")).arg("--check").arg("-o").arg(folder);
    command.args(arguments).output().unwrap()
}

#[test]
fn passes_on_what_was_compiled_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    compile(&scene("damped_spring"), folder.path(), &[]);
    // The manifest is not compared and may be missing: users may keep only the scripts.
    fs::remove_file(folder.path().join("manifest.json")).unwrap();
    fs::remove_file(folder.path().join(".jabuka-lock")).unwrap();
    let before = contents(folder.path());
    let output = check(folder.path(), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).ends_with("151 scripts are as the scene gives them\n"), "{}", stdout(&output));
    assert!(before == contents(folder.path()));
}

#[test]
fn fails_with_frame_line_old_and_new_when_a_digit_changes() {
    let folder = tempfile::tempdir().unwrap();
    compile(&scene("damped_spring"), folder.path(), &["--frames", "2,3"]);
    let output = check(folder.path(), &["--frames", "2", "--set", "force.spring.spring.damping=2.1"]);
    assert_eq!(output.status.code(), Some(1));
    insta::assert_snapshot!(stdout(&output).replace(folder.path().to_str().unwrap(), "DIR"));
}

#[test]
fn fails_where_a_script_is_missing_or_too_many() {
    let folder = tempfile::tempdir().unwrap();
    compile(&scene("damped_spring"), folder.path(), &[]);
    fs::rename(folder.path().join("frame_0007.pov"), folder.path().join("frame_0151.pov")).unwrap();
    let output = check(folder.path(), &[]);
    assert_eq!(output.status.code(), Some(1));
    let said = stdout(&output);
    assert!(said.contains("frame 7: frame_0007.pov is missing\n"), "{said}");
    assert!(said.contains("frame 151: frame_0151.pov is not a script of this scene\n"), "{said}");
    // With `--frames`, only the selected frames are compared.
    assert_eq!(check(folder.path(), &["--frames", "0-6"]).status.code(), Some(0));
}

#[test]
fn fails_without_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let output = check(&folder.path().join("none"), &[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("there is no folder"), "{}", stderr(&output));
}
