//! Tests of a full disk: no file is left half-written, and each command reports the state of the folder.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::{Command, Output};

use crate::support::{compile, jabuka, stderr, stdout};

/// Runs `jabuka` in a folder with a limit on the size of each written file, kB. The limit acts like a full disk on any machine.
fn limited(folder: &Path, kilobytes: u32, arguments: &[&str]) -> Output {
    let script = format!("trap '' XFSZ; ulimit -f {kilobytes}; exec \"$@\"");
    Command::new("bash")
        .args(["-c", &script, "bash", env!("CARGO_BIN_EXE_jabuka")])
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

#[test]
fn a_new_scene_or_template_that_cannot_be_written_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let output = limited(folder.path(), 0, &["new", "ball"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).starts_with("error: cannot write the scene `ball`: "), "{}", stderr(&output));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);

    let output = limited(folder.path(), 0, &["templates", "mine"]);
    assert_eq!(output.status.code(), Some(1));
    let left = fs::read_dir(folder.path().join("mine")).unwrap();
    assert!(left.map(Result::unwrap).all(|entry| entry.path().is_dir()), "no half-written template");
}

#[test]
fn a_folder_that_ran_out_of_space_is_called_so_by_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    fs::write(&scene, "simulation.duration = 8\n[body.ball]\nshape.sphere.radius = 1\n").unwrap();
    compile(&scene, &folder.path().join("out/scene"), &[]);
    // The scripts are smaller than the limit; the manifest, which lists 201 of them, is larger.
    let change = ["compile", "scene.toml", "--set", "title='changed'"];
    let output = limited(folder.path(), 16, &change);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).starts_with("error[cannot-write]: "), "{}", stderr(&output));

    let run = |arguments: &[&str]| jabuka().current_dir(folder.path()).args(arguments).output().unwrap();
    // A stand-in for POV-Ray that only prints its version; the commands need no more.
    let povray = folder.path().join("povray");
    fs::write(&povray, "#!/bin/sh\necho 'POV-Ray 3.7.0.10'\n").unwrap();
    fs::set_permissions(&povray, fs::Permissions::from_mode(0o755)).unwrap();
    for arguments in
        [&["render", "out/scene", "--povray", "./povray"][..], &["batch", "out/scene", "--engine", "slurm"]]
    {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(stderr(&output).starts_with("error[incomplete-scripts]: "), "{}", stderr(&output));
    }
    let output = run(&["status", "out/scene"]);
    assert_eq!(output.status.code(), Some(1));
    let text = "scripts  not all there: what writes them was interrupted; run it again\n";
    assert!(stdout(&output).starts_with(text), "{}", stdout(&output));
    assert!(
        stdout(&run(&["status", "out/scene", "--format", "json"])).contains("\"unfinished_scripts\": true")
    );
    // Without the limit, the same command succeeds and completes the folder.
    assert!(run(&change).status.success());
    assert!(stdout(&run(&["status", "out/scene"])).starts_with("done     0 of 201\n"));
}
