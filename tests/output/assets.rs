//! Tests of `povray.assets`, the files that scripts read and that are copied to the output folder.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;

use jabuka::output::Manifest;

use crate::support::{compile, contents, jabuka, stderr};

/// Writes a scene with these assets, and two image files beside it, into a folder. Returns the scene's path.
fn scene(folder: &Path, assets: &str) -> std::path::PathBuf {
    let scenes = folder.join("scenes");
    fs::create_dir_all(scenes.join("maps")).unwrap();
    fs::write(scenes.join("wood.png"), "wood").unwrap();
    fs::write(scenes.join("maps/earth.png"), "earth").unwrap();
    let path = scenes.join("scene.toml");
    let text = format!(
        "simulation.duration = 0.1\npovray.assets = {assets}\n[body.ball]\nshape.sphere.radius = 1\n"
    );
    fs::write(&path, text).unwrap();
    path
}

#[test]
fn assets_are_copied_and_listed_and_found() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let path = scene(folder.path(), "['wood.png', './maps/earth.png', 'wood.png']");
    compile(&path, &out, &[]);
    assert_eq!(fs::read_to_string(out.join("assets/wood.png")).unwrap(), "wood");
    assert_eq!(fs::read_to_string(out.join("assets/maps/earth.png")).unwrap(), "earth");
    assert!(fs::read_to_string(out.join("animation.ini")).unwrap().contains("\nLibrary_Path=\"assets\"\n"));
    let manifest = Manifest::read(&out).unwrap();
    let listed: Vec<_> = manifest.files.iter().map(|file| (file.name.as_str(), file.bytes)).collect();
    assert_eq!(listed[2..4], [("assets/maps/earth.png", 5), ("assets/wood.png", 4)], "{listed:?}");
    // The digest that `printf wood | sha256sum` prints.
    let digest = "99f7855eb789dfecf9ea66df3221a743f4ab8be59ae6b9c503499c1940a90fd5";
    assert_eq!(manifest.files[3].hex(), digest);

    // A changed file is copied again, and no temporary file remains.
    fs::write(path.with_file_name("wood.png"), "other wood").unwrap();
    compile(&path, &out, &["--frames", "0"]);
    assert_eq!(fs::read_to_string(out.join("assets/wood.png")).unwrap(), "other wood");
    let names = || fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name());
    assert!(names().all(|name| !name.to_str().unwrap().ends_with(".tmp")));

    scene(folder.path(), "[]");
    compile(&path, &out, &[]);
    assert!(!fs::read_to_string(out.join("animation.ini")).unwrap().contains("Library_Path"));
    assert!(Manifest::read(&out).unwrap().files.iter().all(|file| !file.name.starts_with("assets")));
}

#[test]
fn a_file_from_elsewhere_needs_trust_and_is_copied_under_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    fs::write(folder.path().join("metal.png"), "metal").unwrap();
    let path = scene(folder.path(), "['../metal.png']");
    let refused = |path: &Path| {
        let output = jabuka().arg("check").arg(path).output().unwrap();
        assert!(stderr(&output).contains("error[untrusted-path]"), "{}", stderr(&output));
    };
    refused(&path);
    compile(&path, &out, &["--trust"]);
    assert_eq!(contents(&out.join("assets")), [("metal.png".to_owned(), b"metal".to_vec())]);

    // A symbolic link that points out of the scene's folder needs trust, too.
    symlink(folder.path().join("metal.png"), path.with_file_name("link.png")).unwrap();
    refused(&scene(folder.path(), "['link.png']"));

    // Two paths to one file are the same asset.
    let path = scene(folder.path(), "['wood.png', '../scenes/maps/../wood.png']");
    compile(&path, &out, &["--trust"]);
}

#[test]
fn no_link_is_followed_where_assets_are_copied_to() {
    let folder = tempfile::tempdir().unwrap();
    let (out, elsewhere) = (folder.path().join("out"), folder.path().join("elsewhere"));
    let path = scene(folder.path(), "['wood.png', 'maps/earth.png']");
    compile(&path, &out, &[]);
    fs::create_dir(&elsewhere).unwrap();
    fs::write(elsewhere.join("mine"), "mine").unwrap();

    fs::remove_file(out.join("assets/wood.png")).unwrap();
    symlink(elsewhere.join("mine"), out.join("assets/wood.png")).unwrap();
    compile(&path, &out, &[]);
    assert_eq!(fs::read_to_string(out.join("assets/wood.png")).unwrap(), "wood");

    fs::remove_dir_all(out.join("assets")).unwrap();
    symlink(&elsewhere, out.join("assets")).unwrap();
    let output = jabuka().arg("compile").arg(&path).arg("-o").arg(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("error[link]"), "{}", stderr(&output));
    assert_eq!(contents(&elsewhere), [("mine".to_owned(), b"mine".to_vec())]);
}
