//! What jabuka makes of every scene of the gallery has the same bytes on every machine.
//!
//! The snapshot is the list of the right digests. This test makes the list again on its own machine. `tests/everywhere` does the same with the
//! programs for other systems, and with the module for browsers.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use sha2::{Digest, Sha256};

use crate::support::{jabuka, root, stderr};

#[test]
fn files_of_the_gallery() {
    let entries = fs::read_dir(root().join("scenes")).unwrap().map(|entry| entry.unwrap().path());
    let mut scenes: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    scenes.sort();
    let lines: Vec<String> = scenes.par_iter().map(|scene| of_scene(scene)).collect();
    insta::assert_snapshot!("gallery", lines.concat());
}

/// Returns a line for the scripts of a scene, one for its table, and one for its model.
fn of_scene(scene: &Path) -> String {
    let folder = tempfile::tempdir().unwrap();
    let name = scene.file_stem().unwrap().to_string_lossy();
    let run = |command: &str, out: &str| {
        // The run is simulated once, for all three.
        let cache = [("DIR", folder.path().join("cache")), ("SIZE", "2000".into()), ("ALL", "1".into())];
        let out = folder.path().join(out);
        let output = jabuka()
            .envs(cache.map(|(key, value)| (format!("JABUKA_CACHE_{key}"), value)))
            .arg(command)
            .arg(scene)
            .args([Path::new("-o"), &out])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
        out
    };
    let mut lines = format!("{name} scripts {}\n", of_files(&run("compile", "scripts")));
    for (kind, file) in [("table", "table.csv"), ("model", "model.glb")] {
        writeln!(lines, "{name} {kind} {}", hex(&fs::read(run("export", file)).unwrap())).unwrap();
    }
    lines
}

/// Returns the digest of the names and the digests of all files of which the manifest of a folder tells, as `sha256sum` prints them.
fn of_files(folder: &Path) -> String {
    let manifest: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.join("manifest.json")).unwrap()).unwrap();
    let mut names: Vec<&str> =
        manifest["files"].as_array().unwrap().iter().map(|file| file["name"].as_str().unwrap()).collect();
    names.sort_unstable();
    let list = names.iter().fold(String::new(), |list, name| {
        format!("{list}{}  {name}\n", hex(&fs::read(folder.join(name)).unwrap()))
    });
    hex(list.as_bytes())
}

fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |hex, byte| format!("{hex}{byte:02x}"))
}
