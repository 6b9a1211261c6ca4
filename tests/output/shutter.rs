//! Tests of motion blur: each frame gets a second script beside the sharp one.

use std::fs;
use std::path::{Path, PathBuf};

use jabuka::output::Manifest;

use crate::support::{compile, contents, jabuka, stdout};

/// Writes a scene of six frames. Returns its path.
fn scene(folder: &Path) -> PathBuf {
    let path = folder.join("scene.toml");
    let text = "
simulation.duration = 0.2
[body.ball]
shape.sphere.radius = 1
velocity = [3, 0, 0]
[camera]
shutter = 0.02
samples = 4
[view.sharp]
shutter = 0
[view.fine]
samples = 8
";
    fs::write(&path, text).unwrap();
    path
}

/// Returns the names and bytes of a folder's files whose names begin with `prefix`.
fn files(folder: &Path, prefix: &str) -> Vec<(String, Vec<u8>)> {
    contents(folder).into_iter().filter(|(name, _)| name.starts_with(prefix)).collect()
}

#[test]
fn sharp_scripts_are_the_same_bytes_with_blur_and_without() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path());
    let (blurred, sharp) = (folder.path().join("blurred"), folder.path().join("sharp"));
    let said = stdout(&compile(&path, &blurred, &[]));
    assert!(said.contains(": 6 of 6 frames\n"), "{said}");
    assert!(said.contains("\nshutter   open for 0.02 s, 4 moments a frame\n"), "{said}");
    let said = stdout(&compile(&path, &sharp, &["--set", "camera.shutter=0", "--set", "camera.samples=4"]));
    assert!(!said.contains("shutter"), "{said}");
    assert_eq!((files(&blurred, "shutter_").len(), files(&sharp, "shutter_").len()), (6, 0));
    assert!(files(&blurred, "frame_") == files(&sharp, "frame_"));
    assert!(files(&blurred, "animation") == files(&sharp, "animation"));
}

#[test]
fn the_script_holds_all_moments_in_their_order() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    compile(&scene(folder.path()), &out, &["--set", "output.layout=shared"]);
    let script = fs::read_to_string(out.join("shutter_0005.pov")).unwrap();
    insta::assert_snapshot!(script);
}

#[test]
fn views_inherit_the_shutter_and_can_close_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path());
    let out = folder.path().join("out");
    compile(&path, &out, &["--view", "all"]);
    let manifest = |name: &str| Manifest::read(&folder.path().join(name)).unwrap().head;
    let [main, sharp, fine] = ["out", "out-sharp", "out-fine"].map(manifest);
    assert_eq!((main.shutter, main.samples), (Some(0.02), Some(4)));
    assert_eq!((sharp.shutter, sharp.samples), (None, None));
    assert_eq!((fine.shutter, fine.samples), (Some(0.02), Some(8)));
    assert!(files(&folder.path().join("out-sharp"), "shutter_").is_empty());
}

#[test]
fn they_are_listed_and_kept_and_go_when_the_shutter_is_closed() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path());
    let out = folder.path().join("out");
    compile(&path, &out, &[]);
    let full = contents(&out);
    let manifest = Manifest::read(&out).unwrap();
    assert!(manifest.is_complete());
    let names: Vec<_> = manifest.files.iter().map(|file| (file.frame, file.name.as_str())).collect();
    let expected = [
        (None, "animation.ini"),
        (None, "animation.pov"),
        (Some(0), "frame_0000.pov"),
        (Some(0), "shutter_0000.pov"),
        (Some(1), "frame_0001.pov"),
    ];
    assert_eq!(names[..5], expected);
    for file in &manifest.files {
        assert_eq!(fs::metadata(out.join(&file.name)).unwrap().len(), file.bytes, "{}", file.name);
    }

    let said = stdout(&compile(&path, &out, &["--frames", "3"]));
    assert!(said.contains("1 of 6 frames, 5 others kept"), "{said}");
    assert!(full == contents(&out));

    let said = stdout(&compile(&path, &out, &["--frames", "3", "--set", "camera.shutter=0"]));
    assert!(said.contains("1 of 6 frames, 5 others of another scene removed"), "{said}");
    assert!(files(&out, "shutter_").is_empty());
}

#[test]
fn any_number_of_threads_writes_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path());
    let [one, eight] = ["1", "8"].map(|threads| {
        let out = folder.path().join(threads);
        let mut command = jabuka();
        command.env("RAYON_NUM_THREADS", threads).arg("compile").arg(&path).arg("-o").arg(&out);
        assert!(command.output().unwrap().status.success());
        contents(&out)
    });
    assert!(one == eight);
}

#[test]
fn check_compares_both_scripts_of_a_frame() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path());
    let out = folder.path().join("out");
    compile(&path, &out, &[]);
    let check = |arguments: &[&str]| {
        let mut command = jabuka();
        command.arg("compile").arg(&path).arg("--check").arg("-o").arg(&out).args(arguments);
        let output = command.output().unwrap();
        (output.status.code(), stdout(&output))
    };
    let (code, said) = check(&[]);
    assert!(code == Some(0) && said.ends_with(": 12 scripts are as the scene gives them\n"), "{said}");

    let (code, said) = check(&["--frames", "2", "--set", "camera.shutter=0.03"]);
    assert!(code == Some(1) && said.contains("frame 2: shutter_0002.pov differs\n"), "{said}");
    assert!(said.ends_with(": 1 of 2 scripts differ\n"), "{said}");

    let (code, said) = check(&["--set", "camera.shutter=0"]);
    assert!(code == Some(1) && said.contains("shutter_0000.pov is not a script of this scene\n"), "{said}");

    fs::remove_file(out.join("shutter_0004.pov")).unwrap();
    let (code, said) = check(&[]);
    assert!(code == Some(1) && said.starts_with("frame 4: shutter_0004.pov is missing\n"), "{said}");
}
