//! A run that is killed at any moment is made good by running it again.

use std::process::Stdio;
use std::thread::sleep;
use std::time::Instant;

use crate::support::{compile, contents, jabuka, scene};

#[test]
fn killed_at_any_moment_and_run_again_the_folder_is_the_undisturbed_one() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["--set", "simulation.duration=60"];
    let start = Instant::now();
    let undisturbed = folder.path().join("undisturbed");
    compile(&scene("parabola"), &undisturbed, &arguments);
    let whole = start.elapsed();
    let expected = contents(&undisturbed);

    let disturbed = folder.path().join("disturbed");
    let (mut killed, mut unfinished) = (0, 0);
    // Twenty moments, spread over the run and a little beyond, in an order that jumps about.
    for round in 0u32..20 {
        let moment = whole.mul_f64(f64::from((round * 7) % 20) / 18.0);
        // Every other run is of another scene, so that kills also fall on the removal of its scripts.
        let mass = if round % 2 == 0 { "body.ball.mass=2" } else { "body.ball.mass=1.0" };
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
        sleep(moment);
        child.kill().unwrap();
        let status = child.wait().unwrap();
        killed += usize::from(!status.success());
        let manifest = std::fs::read_to_string(disturbed.join("manifest.json")).unwrap_or_default();
        unfinished += usize::from(!manifest.contains("\"state\": \"complete\""));
        if round % 5 == 4 {
            compile(&scene("parabola"), &disturbed, &arguments);
            assert!(expected == contents(&disturbed), "after round {round}");
        }
    }
    assert!(killed >= 10, "only {killed} of 20 runs were killed before they had ended");
    assert!(unfinished >= 1, "no kill fell into the writing");
}

#[test]
fn killed_while_some_frames_are_written_the_others_stay() {
    let folder = tempfile::tempdir().unwrap();
    compile(&scene("damped_spring"), folder.path(), &[]);
    let expected = contents(folder.path());
    // What a kill leaves: the manifest of the first moment, and a half-written file.
    let manifest = std::fs::read_to_string(folder.path().join("manifest.json")).unwrap();
    let (head, _) = manifest.split_once(",\n  \"files\"").unwrap();
    let writing = head.replace("complete", "writing") + ",\n  \"planned\": \"3\",\n  \"files\": [\n  ]\n}\n";
    std::fs::write(folder.path().join("manifest.json"), writing).unwrap();
    std::fs::write(folder.path().join(".jabuka-frame_0003.pov.tmp"), "// fra").unwrap();
    compile(&scene("damped_spring"), folder.path(), &["--frames", "3"]);
    assert!(expected == contents(folder.path()));
}
