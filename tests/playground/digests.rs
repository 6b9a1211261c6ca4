//! The module for browsers makes the same bytes as the program.

use std::collections::BTreeMap;
use std::process::Command;

use crate::site::module;
use crate::support::{jabuka, root, scene, stderr, stdout};

/// Scenes of all kinds that take a few seconds together: free bodies, joints, impacts, piles, gravitation, fields, particles, meshes, several
/// views, motion blur.
const SCENES: &[&str] = &[
    "parabola",
    "hammer",
    "newtons_cradle",
    "fountain",
    "figure_eight",
    "magnetic_bottle",
    "house_of_cards",
];

/// The digests of what jabuka makes of each scene of the gallery: see `tests/scenes/digests.rs`.
const GALLERY_DIGESTS: &str = include_str!("../scenes/snapshots/scenes__digests__gallery.snap");

#[test]
fn files_have_the_bytes_of_the_program() {
    let output = Command::new("node")
        .arg(root().join("playground/digests.mjs"))
        .arg(module())
        .args(SCENES.iter().map(|name| scene(name)))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let of = |name: &&str| {
        let start = format!("{name} ");
        GALLERY_DIGESTS.lines().filter(move |line| line.starts_with(&start))
    };
    let expected: Vec<&str> = SCENES.iter().flat_map(of).collect();
    assert_eq!(stdout(&output).lines().collect::<Vec<_>>(), expected);
    assert_eq!(expected.len(), 3 * SCENES.len());
}

/// Reads all scenes with mistakes in one module. It must survive each of them, and say the errors of the program at their places.
#[test]
fn mistakes_are_told_as_by_the_program() {
    let folder = root().join("tests/bad");
    let mut scenes: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    // Scenes that name other files need the whole folder.
    scenes.retain(|path| {
        let is_scene = path.extension().is_some_and(|end| end == "toml");
        is_scene
            && !std::fs::read_to_string(path).is_ok_and(|text| {
                ["include", "file", "table", ".inc", "font"].iter().any(|word| text.contains(word))
            })
    });
    scenes.sort();
    let output = Command::new("node")
        .arg(root().join("tests/playground/bad.mjs"))
        .arg(module())
        .args(&scenes)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let said: BTreeMap<String, serde_json::Value> = serde_json::from_slice(&output.stdout).unwrap();
    let mut compared = 0;
    for scene in &scenes {
        let name = scene.file_name().unwrap().to_str().unwrap();
        let checked =
            jabuka().current_dir(&folder).args(["check", "--format", "json", name]).output().unwrap();
        let expected: serde_json::Value = serde_json::from_slice(&checked.stdout).unwrap_or_default();
        let (Some(expected), Some(found)) = (expected.as_array(), said[name]["diagnostics"].as_array())
        else {
            continue;
        };
        // Warnings about runs come only from simulated scenes, and errors of simulations are the run's.
        for diagnostic in expected.iter().filter(|diagnostic| diagnostic["severity"] == "error") {
            let mut diagnostic = diagnostic.clone();
            diagnostic.as_object_mut().unwrap().remove("scene");
            if !found.is_empty() {
                assert!(found.contains(&diagnostic), "{name}: {diagnostic:#}\n{found:#?}");
                compared += 1;
            }
        }
    }
    assert!(scenes.len() > 100 && compared > 300, "{} scenes, {compared} errors", scenes.len());
}
