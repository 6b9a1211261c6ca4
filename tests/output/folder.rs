//! Tests that jabuka overwrites and removes only files that it wrote, and follows no symbolic link in an output folder.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;

use jabuka::output::Manifest;

use crate::support::{compile, contents, jabuka, scene, stderr};

/// Compiles into a folder, and asserts that this is refused with exit code 1 and a message with these words.
fn refused(folder: &Path, words: &str) {
    let output = jabuka().arg("compile").arg(scene("damped_spring")).arg("-o").arg(folder).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains(words), "{}", stderr(&output));
}

#[test]
fn a_folder_of_somebody_elses_is_refused_and_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("frame_0000.pov"), "years of work").unwrap();
    refused(folder.path(), "is not empty, and jabuka did not make it");
    // A manifest that jabuka did not write does not make the folder an output folder of jabuka.
    for manifest in ["{}", "[]", "not json", "{\"generator\": \"another program\", \"state\": \"complete\"}"]
    {
        fs::write(folder.path().join("manifest.json"), manifest).unwrap();
        refused(folder.path(), "is not empty, and jabuka did not make it");
    }
    assert_eq!(fs::read_to_string(folder.path().join("frame_0000.pov")).unwrap(), "years of work");
    assert_eq!(contents(folder.path()).len(), 2);
}

#[test]
fn a_file_where_a_folder_should_be_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "mine").unwrap();
    refused(&file, "is not a folder");
    refused(&file.join("below"), "file");
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
}

#[test]
fn a_manifest_that_names_files_elsewhere_removes_none() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("a/b");
    let outside = folder.path().join("x");
    fs::write(&outside, "mine").unwrap();
    compile(&scene("damped_spring"), &out, &["--frames", "0-2"]);
    let manifest = fs::read_to_string(out.join("manifest.json")).unwrap();
    let forged = manifest.replace("frame_0001.pov", "../../x").replace("frame_0002.pov", "/etc/hostname");
    assert_ne!(manifest, forged);
    fs::write(out.join("manifest.json"), forged).unwrap();
    compile(&scene("damped_spring"), &out, &["--frames", "0", "--set", "body.ball.mass=2"]);
    assert_eq!(fs::read_to_string(&outside).unwrap(), "mine");
    assert!(Path::new("/etc/hostname").exists());
}

#[test]
fn a_manifest_with_impossible_numbers_is_none_of_ours() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    compile(&scene("projectile"), &out, &["--frames", "0-1"]);
    let manifest = fs::read_to_string(out.join("manifest.json")).unwrap();
    let rate = manifest.lines().find(|line| line.contains("\"frame_rate\"")).unwrap();
    let frames = manifest.lines().find(|line| line.contains("\"frames\"")).unwrap();
    let status = |text: &str| {
        fs::write(out.join("manifest.json"), text).unwrap();
        jabuka().arg("status").arg(&out).output().unwrap()
    };
    assert_eq!(stderr(&status(&manifest)), "");
    for (line, number) in [(frames, "18446744073709551615"), (frames, "0"), (rate, "0"), (rate, "-25.0")] {
        let (key, _) = line.split_once(':').unwrap();
        let said = stderr(&status(&manifest.replace(line, &format!("{key}: {number},"))));
        assert!(said.contains("it holds no scripts that jabuka wrote"), "{key} {number}: {said}");
    }
}

#[test]
fn links_are_replaced_or_refused_and_never_followed() {
    let folder = tempfile::tempdir().unwrap();
    let (out, outside) = (folder.path().join("out"), folder.path().join("mine"));
    fs::write(&outside, "mine").unwrap();
    compile(&scene("damped_spring"), &out, &["--frames", "0-2"]);
    let plain = contents(&out);

    for name in ["frame_0001.pov", "animation.ini", ".jabuka-frame_0002.pov.tmp"] {
        let _ = fs::remove_file(out.join(name));
        symlink(&outside, out.join(name)).unwrap();
    }
    compile(&scene("damped_spring"), &out, &["--frames", "0-2"]);
    assert!(plain == contents(&out), "the links are replaced by files");

    // With these two links, jabuka would take the folder for its own, or would open a file elsewhere for writing.
    for name in ["manifest.json", ".jabuka-lock"] {
        let original = fs::read(out.join(name)).unwrap();
        fs::rename(out.join(name), folder.path().join("moved")).unwrap();
        symlink(folder.path().join("moved"), out.join(name)).unwrap();
        let words = if name == "manifest.json" { "jabuka did not make it" } else { "is a link" };
        refused(&out, words);
        fs::remove_file(out.join(name)).unwrap();
        fs::write(out.join(name), original).unwrap();
    }
    assert_eq!(fs::read_to_string(&outside).unwrap(), "mine");
}

#[test]
fn a_scene_that_is_wrong_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let bad = folder.path().join("bad.toml");
    fs::write(&bad, "[body.ball]\n").unwrap();
    let output = jabuka().current_dir(folder.path()).arg("compile").arg(&bad).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_run_that_diverges_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let wild = folder.path().join("wild.toml");
    // With angular frequency ω and step dt, ω dt = 100. Each step of the explicit Euler method multiplies the amplitude by about 100.
    let text = "
        [simulation]
        duration = 100
        step = 1
        integrator = 'explicit-euler'
        frame_rate = 1
        [body.ball]
        shape.sphere.radius = 1
        location = [1, 0, 0]
        [force.spring]
        spring.between = ['ball', [0, 0, 0]]
        spring.stiffness = 1e10
        spring.rest_length = 0
    ";
    fs::write(&wild, text).unwrap();
    let output = jabuka().current_dir(folder.path()).arg("compile").arg(&wild).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("error[diverged]: the run diverged"), "{}", stderr(&output));
    assert!(stderr(&output).contains("`ball`"), "{}", stderr(&output));
    assert!(!folder.path().join("out").exists());
}

/// Forces that are numbers, but drive a body beyond all bounds in the first steps. The error names the line of the force.
#[test]
fn a_force_beyond_all_bounds_is_an_error_at_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("huge.toml");
    for (line, force) in [
        (4, "[force.huge.formula]\nforce = ['1e300', 0, 0]"),
        (4, "[force.huge.formula]\nforce = [0, '-1e308*cos(t)', 0]"),
        (4, "[force.huge.constant]\ntorque = [0, 0, 1e100]"),
        (4, "[force.huge.spring]\nbetween = ['ball', [0, 0, 0]]\nstiffness = 1e100\nrest_length = 0"),
    ] {
        fs::write(&path, format!("[body.ball]\nshape.sphere.radius = 0.2\nlocation = [1, 0, 0]\n{force}\n"))
            .unwrap();
        let output = jabuka().current_dir(folder.path()).args(["compile", "huge.toml"]).output().unwrap();
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.starts_with("error[diverged]: the run diverged: "), "{said}");
        assert!(
            said.contains(&format!("huge.toml:{line}:8\n")) && said.contains("`huge` acts on `ball`"),
            "{said}"
        );
        assert_eq!(said.matches("error").count(), 1, "{said}");
        assert!(!folder.path().join("out").exists(), "{force}");
    }
}

/// A scene with a ball between two closing walls. The walls start 0.5 m from the ball and jam it at 0.5 s.
const JAMMED: &str = "
    [simulation]
    duration = 1
    frame_rate = 10
    integrator = 'velocity-verlet'
    contacts = 'event-driven'
    [body.ball]
    shape.sphere.radius = 0.5
    location = [0, 2, 0]
    restitution = 1
    [body.left]
    shape.box.size = [1, 3, 3]
    motion.formula.location = ['-1.5 + t', 2, 0]
    [body.right]
    shape.box.size = [1, 3, 3]
    motion.formula.location = ['1.5 - t', 2, 0]
";

#[test]
fn a_run_that_jams_keeps_the_frames_before() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("press.toml");
    fs::write(&scene, JAMMED).unwrap();
    let compile = |arguments: &[&str]| {
        let mut command = jabuka();
        command.current_dir(folder.path()).arg("compile").arg(&scene).args(arguments).output().unwrap()
    };
    let names = |folder: &Path| -> Vec<String> {
        let files =
            fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = files.filter(|name| name.starts_with("frame_")).collect();
        names.sort();
        names
    };
    let output = compile(&[]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1));
    assert!(said.contains("error[jammed]: ") && said.contains("; 5 frames before are kept"), "{said}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("5 of 11 frames"), "{output:?}");
    let out = folder.path().join("out/press");
    assert_eq!(names(&out).len(), 5);
    assert!(Manifest::read(&out).unwrap().is_complete());

    // The kept frames can be compared with `--check`, and a table has a row for each of them.
    let check = compile(&["--check"]);
    assert_eq!(check.status.code(), Some(1));
    assert!(
        String::from_utf8_lossy(&check.stdout).contains("5 scripts are as the scene gives them"),
        "{check:?}"
    );
    let table = folder.path().join("press.csv");
    let export = jabuka().arg("export").arg(&scene).arg("-o").arg(&table).output().unwrap();
    assert_eq!(export.status.code(), Some(1));
    assert!(stderr(&export).contains("; 5 frames before are kept"), "{export:?}");
    assert_eq!(fs::read_to_string(&table).unwrap().lines().count(), 1 + 5 * 3);

    // A page would show the beginning of the run as if it were all of it.
    let page = folder.path().join("press.html");
    let export = jabuka().arg("export").arg(&scene).arg("-o").arg(&page).output().unwrap();
    assert_eq!(export.status.code(), Some(1));
    let said = stderr(&export);
    assert!(said.contains("error[jammed]: ") && said.contains("; nothing is written"), "{said}");
    assert!(!page.exists());

    // If no selected frame comes before the failure, nothing is written.
    let none = compile(&["--frames", "7-9", "-o", "none"]);
    assert_eq!(none.status.code(), Some(1));
    assert!(stderr(&none).contains("; no frame before that was asked for"), "{none:?}");
    assert!(!folder.path().join("none").exists());

    // A frame is kept only if its whole exposure was simulated. The shutter of frame 4 closes at 0.49 s, before the failure; that of frame
    // 5 closes after it.
    fs::write(&scene, format!("{JAMMED}[camera]\nshutter = 0.09\nsamples = 4\n")).unwrap();
    let blurred = compile(&["-o", "blurred"]);
    assert!(stderr(&blurred).contains("; 5 frames before are kept"), "{blurred:?}");
}
