//! What the tests of the `jabuka` command share.
#![allow(dead_code, reason = "each test program uses some of it")]

pub(crate) mod commands;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The `jabuka` command, as built for the tests.
pub(crate) fn jabuka() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_jabuka"));
    command.current_dir(root());
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

/// Every code in the sources below a folder, of whatever is made there: the word in quotes after what makes it.
pub(crate) fn codes(folder: &Path) -> BTreeSet<String> {
    let mut codes = BTreeSet::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            codes.extend(self::codes(&path));
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let text = text.split("#[cfg(test)]").next().unwrap();
        for maker in
            ["Diagnostic::error(", "Diagnostic::warning(", "of_error(", " error(", "(error(", ".error("]
        {
            for (at, _) in text.match_indices(maker) {
                let after = text[at + maker.len()..].trim_start();
                codes.extend(
                    after.strip_prefix('"').and_then(|code| code.split('"').next()).map(str::to_owned),
                );
            }
        }
        // Where the code is one of several, all words of a code's form are codes.
        for (choice, end) in [("let code =", ";"), ("fn code(", "\n    }\n")] {
            for (at, _) in text.match_indices(choice) {
                let words = text[at..].split(end).next().unwrap().split('"').skip(1).step_by(2);
                let of_form = |c: char| c.is_ascii_lowercase() || c == '-';
                codes.extend(words.filter(|word| word.chars().all(of_form)).map(str::to_owned));
            }
        }
    }
    codes
}
