//! Tests of the files with parts of trails, which several scripts share.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{compile, contents, jabuka, stdout};

/// Writes a scene with this number of frames, in which a ball with a trail moves on a helix. Returns its path.
fn scene(folder: &Path, frames: u32, layout: &str) -> PathBuf {
    let path = folder.join("scene.toml");
    let duration = f64::from(frames - 1) / 25.0;
    let text = format!(
        "simulation.duration = {duration}\noutput.layout = '{layout}'\n[body.ball]\nshape.sphere.radius = 0.1\n\
         motion.formula.location = ['cos(t)', 'sin(t)', 't/9']\ntrail = true\n"
    );
    fs::write(&path, text).unwrap();
    path
}

/// Returns the names of a folder's files with parts of trails.
fn trails(folder: &Path) -> BTreeSet<String> {
    let names = contents(folder).into_iter().map(|(name, _)| name);
    names.filter(|name| name.starts_with("trail_")).collect()
}

/// Returns the total size of all scripts and trail files of a scene with this number of frames, bytes.
fn bytes(frames: u32, layout: &str) -> usize {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    compile(&scene(folder.path(), frames, layout), &out, &[]);
    let of_scripts = |name: &str| name.starts_with("frame_") || name.starts_with("trail_");
    contents(&out).iter().filter(|(name, _)| of_scripts(name)).map(|(_, bytes)| bytes.len()).sum()
}

/// Checks that sharing trails keeps the scripts small. Up to 512 points, scripts that repeat the whole trail grow quadratically: four
/// times the frames take 16 times the bytes. A script in the shared layout has one line for each part of the trail.
#[test]
fn a_script_does_not_repeat_what_others_have_of_a_trail() {
    let (few, many) = (bytes(96, "shared"), bytes(384, "shared"));
    assert!(many < 6 * few, "{few} bytes, then {many}");
    let whole = bytes(384, "self-contained");
    assert!(whole > 5 * many, "{many} bytes, or {whole} in scripts of their own");
}

#[test]
fn a_part_of_a_trail_is_written_once_and_listed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    compile(&scene(folder.path(), 101, "shared"), &out, &[]);
    let names = trails(&out);
    assert_eq!(names.len(), 3, "at frames 32, 64 and 96 one more is finished");
    let manifest = fs::read_to_string(out.join("manifest.json")).unwrap();
    let last = fs::read_to_string(out.join("frame_0100.pov")).unwrap();
    for name in &names {
        assert!(
            manifest.contains(name.as_str()) && last.contains(&format!("#include \"{name}\"\n")),
            "{name}"
        );
    }
    assert!(!fs::read_to_string(out.join("frame_0031.pov")).unwrap().contains("#include \"trail_"));
    // Compiling other frames of the same scene removes no trail file, and the last frame alone needs the same files as all frames.
    compile(&scene(folder.path(), 101, "shared"), &out, &["--frames", "0-40"]);
    assert_eq!(trails(&out), names);
    let alone = folder.path().join("alone");
    compile(&scene(folder.path(), 101, "shared"), &alone, &["--frames", "100"]);
    assert_eq!(trails(&alone), names);
    // Compiling another scene removes the trail files.
    compile(&scene(folder.path(), 20, "shared"), &out, &[]);
    assert_eq!(trails(&out).len(), 0);
}

#[test]
fn a_part_of_a_trail_that_is_changed_or_gone_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (scene(folder.path(), 50, "shared"), folder.path().join("out"));
    compile(&scene, &out, &[]);
    let check = || jabuka().args(["compile", "--check", "-o"]).arg(&out).arg(&scene).output().unwrap();
    assert!(check().status.success());
    let name = trails(&out).pop_first().unwrap();
    fs::write(out.join(&name), "#declare X = 1;\n").unwrap();
    let changed = check();
    assert!(!changed.status.success() && stdout(&changed).contains(&format!("{name} differs")));
    fs::remove_file(out.join(&name)).unwrap();
    assert!(stdout(&check()).contains(&format!("{name} is missing")));
    compile(&scene, &out, &[]);
    assert!(check().status.success());
}
