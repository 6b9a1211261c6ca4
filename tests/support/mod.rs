//! Helpers for the tests of the `jabuka` command.
#![allow(dead_code, reason = "each test program uses some of it")]

pub(crate) mod commands;
pub(crate) mod place;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use jabuka::diagnostic::Code;

/// Returns a command that runs `jabuka` as built for the tests. It keeps no runs in the cache, and notes which folders it made in a folder of
/// the tests.
pub(crate) fn jabuka() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_jabuka"));
    command.current_dir(root()).env("JABUKA_CACHE_SIZE", "0");
    command.env("XDG_STATE_HOME", env!("CARGO_TARGET_TMPDIR"));
    command
}

/// Returns the root folder of the project.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the path of a scene of the gallery, by the scene's name.
pub(crate) fn scene(name: &str) -> PathBuf {
    root().join("scenes").join(name).with_extension("toml")
}

/// Returns arguments that shorten the long scenes of the gallery, so that tests are fast. Their snapshots are of the whole scenes.
pub(crate) fn shorter(scene: &Path) -> &'static [&'static str] {
    match scene.file_stem().and_then(std::ffi::OsStr::to_str) {
        Some("coins") => &["--set", "simulation.duration=1.2"],
        Some("hourglass") => &["--set", "simulation.duration=2"],
        Some("domino_spiral") => &["--set", "simulation.duration=2"],
        Some("galton") => &["--set", "simulation.duration=2", "--set", "variables.balls=15"],
        Some("two_galaxies") => &["--set", "simulation.duration=2", "--set", "variables.stars=40"],
        _ => &[],
    }
}

/// Returns the standard output of a command.
pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// Returns the standard error of a command.
pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Compiles a scene into a folder, and asserts success.
pub(crate) fn compile(scene: &Path, folder: &Path, arguments: &[&str]) -> Output {
    let output = jabuka().arg("compile").arg(scene).arg("-o").arg(folder).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    output
}

/// Sends a signal to a process. It uses the `kill` of the shell, as some machines have no program of this name.
pub(crate) fn signal(name: &str, process: u32) {
    let kill = format!("kill -s {name} {process}");
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
}

/// Returns the names and bytes of all files in a folder and its subfolders, sorted by name.
pub(crate) fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    fn add(folder: &Path, before: &str, files: &mut Vec<(String, Vec<u8>)>) {
        for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let name = format!("{before}{}", entry.file_name().into_string().unwrap());
            match entry.file_type().unwrap().is_dir() {
                true => add(&entry.path(), &format!("{name}/"), files),
                false => files.push((name, std::fs::read(entry.path()).unwrap())),
            }
        }
    }
    let mut files = Vec::new();
    add(folder, "", &mut files);
    files.sort();
    files
}

/// Returns every error code that the sources below a folder use, apart from the list of all codes.
pub(crate) fn codes(folder: &Path) -> BTreeSet<Code> {
    let mut codes = BTreeSet::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            codes.extend(self::codes(&path));
        } else if !path.ends_with("diagnostic/code.rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            let text = text.split("#[cfg(test)]").next().unwrap();
            let words = text.split("Code::").skip(1);
            let variants: Vec<_> =
                words.map(|word| word.split(|c: char| !c.is_alphanumeric()).next().unwrap()).collect();
            codes.extend(Code::ALL.iter().filter(|code| variants.contains(&format!("{code:?}").as_str())));
        }
    }
    codes
}
