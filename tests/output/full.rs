//! Tests of a full disk: no file is left half-written, and each command reports the state of the folder.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

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

/// Runs `jabuka` with its standard output on a full disk.
fn on_a_full_disk(folder: &Path, arguments: &[&str]) -> Output {
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let mut command = jabuka();
    command.current_dir(folder).args(arguments).stdout(full).stderr(Stdio::piped());
    command.spawn().unwrap().wait_with_output().unwrap()
}

/// The commands that this file runs with their standard output on a full disk, and those that need other programs, print nothing there, or
/// print to an editor.
const ELSEWHERE: &[&str] = &["average", "preview", "render", "still", "help", "lsp"];

#[test]
fn a_full_disk_is_an_error_of_every_command_that_prints() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "simulation.duration = 0.2\n[body.ball]\nshape.sphere.radius = 1\nvelocity = [1, 0, 0]\n";
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    compile(&folder.path().join("scene.toml"), &folder.path().join("there"), &[]);
    let commands: &[&[&str]] = &[
        &["--help"],
        &["--version"],
        &["--version", "--verbose"],
        &["help", "compile"],
        &["check", "--help"],
        &["new", "ball"],
        &["compile", "scene.toml"],
        &["compile", "scene.toml", "-o", "there", "--check"],
        &["batch", "scene.toml", "--engine", "slurm"],
        &["export", "scene.toml", "-o", "table.csv"],
        &["status", "there"],
        &["check", "scene.toml"],
        &["check", "scene.toml", "--format", "json"],
        &["report", "scene.toml", "--format", "json"],
        &["cache"],
        &["doctor"],
        &["templates", "mine"],
        &["explain"],
        &["explain", "unknown-key"],
        &["list"],
        &["list", "integrators"],
        &["schema"],
        &["completions", "bash"],
        &["man"],
        &["sandbox"],
    ];
    std::thread::scope(|scope| {
        for &arguments in commands {
            let folder = folder.path();
            scope.spawn(move || {
                let output = on_a_full_disk(folder, arguments);
                assert_eq!(output.status.code(), Some(1), "{arguments:?}: {}", stderr(&output));
                let error = "error[cannot-write]: cannot write to standard output: No space left on device";
                assert!(stderr(&output).contains(error), "{arguments:?}: {}", stderr(&output));
            });
        }
    });
    // The files are complete all the same.
    assert!(
        jabuka()
            .current_dir(folder.path())
            .args(["compile", "scene.toml", "--check"])
            .status()
            .unwrap()
            .success()
    );
    let help = stdout(&jabuka().arg("help").output().unwrap());
    let names =
        help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names: Vec<&str> = names.filter_map(|line| line.strip_prefix("  ")?.split(' ').next()).collect();
    assert!(names.len() > 15, "{help}");
    for name in names.into_iter().filter(|name| !name.is_empty()) {
        assert!(ELSEWHERE.contains(&name) || commands.iter().any(|words| words[0] == name), "{name}");
    }
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    for arguments in [&["schema"][..], &["list", "integrators"], &["--help"]] {
        let mut child =
            jabuka().args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{arguments:?}");
        assert_eq!(stderr(&output), "", "{arguments:?}");
    }
}

/// Checks that the limit on the size of files, which the shell's `ulimit -f` sets, acts like a full disk: it does not kill jabuka, and no temporary
/// file is left.
#[test]
fn a_file_that_would_be_too_large_is_an_error_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("scene.toml"),
        "[body.ball]\nshape.sphere.radius = 1\nvelocity = [1, 0, 0]\n",
    )
    .unwrap();
    let limited = |kilobytes: u32, arguments: &[&str]| {
        let script = format!("ulimit -f {kilobytes}; exec \"$@\"");
        let mut command = Command::new("bash");
        command.args(["-c", &script, "bash", env!("CARGO_BIN_EXE_jabuka")]).args(arguments);
        command.current_dir(folder.path()).env("JABUKA_CACHE_SIZE", "0").output().unwrap()
    };
    for arguments in [
        &["compile", "scene.toml", "-o", "out"][..],
        &["export", "scene.toml", "-o", "x.csv"],
        &["templates", "mine"],
    ] {
        let output = limited(1, arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains("File too large"), "{arguments:?}: {}", stderr(&output));
    }
    let left = Command::new("find")
        .arg(folder.path())
        .args(["-name", "*.tmp", "-o", "-name", "*.csv"])
        .output()
        .unwrap();
    assert_eq!(stdout(&left), "");
    // Other programs are killed by the signal, as usual.
    let script = "dd if=/dev/zero of=$TMPDIR/x bs=4096 count=1 2>/dev/null; test $? -eq 153";
    let output = limited(1, &["sandbox", "--write", ".", "--", "bash", "-c", script]);
    assert!(output.status.success(), "{}", stderr(&output));
}
