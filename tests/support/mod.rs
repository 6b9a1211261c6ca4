//! What the tests of the `jabuka` command share.
#![allow(dead_code, reason = "each test program uses some of it")]

pub(crate) mod commands;
pub(crate) mod place;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use jabuka::diagnostic::Code;

/// The `jabuka` command, as built for the tests. It keeps no runs.
pub(crate) fn jabuka() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_jabuka"));
    command.current_dir(root()).env("JABUKA_CACHE_SIZE", "0");
    command
}

/// The project's folder.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A scene of the gallery, by its name.
pub(crate) fn scene(name: &str) -> PathBuf {
    root().join("scenes").join(name).with_extension("toml")
}

/// What makes a scene of the gallery short whose whole run takes long: its beginning shows the same.
pub(crate) fn shorter(scene: &Path) -> &'static [&'static str] {
    match scene.file_stem().and_then(std::ffi::OsStr::to_str) {
        Some("domino_spiral") => &["--set", "simulation.duration=2"],
        Some("galton") => &["--set", "simulation.duration=2", "--set", "variables.balls=15"],
        Some("two_galaxies") => &["--set", "simulation.duration=2", "--set", "variables.stars=40"],
        _ => &[],
    }
}

/// What a command said to standard output.
pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// What a command said to standard error.
pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Compiles a scene into a folder, which must succeed.
pub(crate) fn compile(scene: &Path, folder: &Path, arguments: &[&str]) -> Output {
    let output = jabuka().arg("compile").arg(scene).arg("-o").arg(folder).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    output
}

/// Sends a signal to a process. Shells have `kill`; not every machine has a program of that name.
pub(crate) fn signal(name: &str, process: u32) {
    let kill = format!("kill -s {name} {process}");
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
}

/// All files of a folder: names and bytes, in the order of the names.
pub(crate) fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<(String, Vec<u8>)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| {
            let entry = entry.unwrap();
            (entry.file_name().into_string().unwrap(), std::fs::read(entry.path()).unwrap())
        })
        .collect();
    files.sort();
    files
}

/// Every code that is named in the sources below a folder, but for the list of all.
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
