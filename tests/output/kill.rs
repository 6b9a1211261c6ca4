//! Tests that a run killed at any moment is completed by running it again.

use std::path::Path;
use std::process::Stdio;

use crate::support::{compile, contents, jabuka, scene};

/// Returns the written fraction of a run's scripts, 0 to 1. `None` while the manifest is still that of the previous run.
fn progress(folder: &Path, manifest_before: &str) -> Option<f64> {
    let manifest = std::fs::read_to_string(folder.join("manifest.json")).unwrap_or_default();
    if manifest == manifest_before {
        return None;
    }
    if !manifest.contains("\"state\": \"writing\"") {
        return Some(if manifest.contains("\"state\": \"complete\"") { 1.0 } else { 0.0 });
    }
    let scripts = std::fs::read_dir(folder).ok()?.filter(|entry| {
        entry.as_ref().is_ok_and(|entry| entry.file_name().to_string_lossy().starts_with("frame_"))
    });
    Some(scripts.count() as f64 / 1501.0)
}

#[test]
fn killed_at_any_moment_and_run_again_the_folder_is_the_undisturbed_one() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["--set", "simulation.duration=60"];
    let undisturbed = folder.path().join("undisturbed");
    compile(&scene("parabola"), &undisturbed, &arguments);
    let expected = contents(&undisturbed);

    let disturbed = folder.path().join("disturbed");
    let (mut killed, mut unfinished) = (0, 0);
    // Twenty moments, spread over the whole run, in a shuffled order.
    for round in 0..20 {
        let moment = f64::from((round * 7) % 20) / 20.0;
        // Each run has another scene than the previous run, so that some kills happen while the old scripts are removed.
        let mass = if round % 2 == 0 { "body.ball.mass=2" } else { "body.ball.mass=3" };
        let before = std::fs::read_to_string(disturbed.join("manifest.json")).unwrap_or_default();
        let mut child = jabuka()
            .arg("compile")
            .arg(scene("parabola"))
            .args(arguments)
            .args(["--set", mass, "-o"])
            .arg(&disturbed)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        while child.try_wait().unwrap().is_none() && progress(&disturbed, &before).is_none_or(|p| p < moment)
        {
            std::thread::sleep(std::time::Duration::from_micros(300));
        }
        child.kill().unwrap();
        killed += usize::from(!child.wait().unwrap().success());
        let manifest = std::fs::read_to_string(disturbed.join("manifest.json")).unwrap_or_default();
        unfinished += usize::from(!manifest.contains("\"state\": \"complete\""));
        if round % 4 == 3 {
            compile(&scene("parabola"), &disturbed, &arguments);
            assert!(expected == contents(&disturbed), "after round {round}");
        }
    }
    assert!(
        killed >= 10 && unfinished >= 10,
        "of 20 runs only {killed} were killed, {unfinished} in the writing"
    );
}

#[test]
fn killed_while_some_frames_are_written_the_others_stay() {
    let folder = tempfile::tempdir().unwrap();
    compile(&scene("damped_spring"), folder.path(), &[]);
    let expected = contents(folder.path());
    // Build by hand the state that a kill leaves: the manifest from the beginning of the writing, and a temporary file.
    let manifest = std::fs::read_to_string(folder.path().join("manifest.json")).unwrap();
    let (head, _) = manifest.split_once(",\n  \"files\"").unwrap();
    let writing = head.replace("complete", "writing") + ",\n  \"planned\": \"3\",\n  \"files\": [\n  ]\n}\n";
    std::fs::write(folder.path().join("manifest.json"), writing).unwrap();
    std::fs::write(folder.path().join(".jabuka-frame_0003.pov.tmp"), "// fra").unwrap();
    compile(&scene("damped_spring"), folder.path(), &["--frames", "3"]);
    assert!(expected == contents(folder.path()));
}
