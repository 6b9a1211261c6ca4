//! The module for browsers makes the same bytes as the program.

use std::collections::BTreeMap;
use std::process::Command;

use crate::site::module;
use crate::support::{compile, root, scene, stderr};

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

/// The digests of all files that `jabuka compile` writes for a scene, except the manifests.
fn of_the_program(name: &str) -> BTreeMap<String, String> {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join(name);
    compile(&scene(name), &out, &[]);
    let mut digests = BTreeMap::new();
    let manifest = std::fs::read_to_string(out.join("manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    for file in manifest["files"].as_array().unwrap() {
        let text = |key: &str| file[key].as_str().unwrap().to_owned();
        digests.insert(format!("{name}/{}", text("name")), text("sha256"));
    }
    digests
}

#[test]
fn scripts_have_the_bytes_of_the_program() {
    let output = Command::new("node")
        .arg(root().join("playground/digests.mjs"))
        .arg(module())
        .args(SCENES.iter().map(|name| scene(name)))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let made: BTreeMap<String, String> = serde_json::from_slice(&output.stdout).unwrap();
    let expected: BTreeMap<String, String> = SCENES.iter().flat_map(|name| of_the_program(name)).collect();
    let differing = expected.iter().filter(|(file, digest)| made.get(*file) != Some(digest));
    assert_eq!(differing.collect::<Vec<_>>(), []);
    assert_eq!(made.len(), expected.len());
    assert!(made.len() > 1000, "{}", made.len());
}
