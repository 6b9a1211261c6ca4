//! Finds the `jabuka` commands in texts for users, checks that they are valid, and runs them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::{Command, Output};

use super::{jabuka, root, stderr, stdout};

/// Returns true if all lines are commands, each after `$ `.
pub(crate) fn are(lines: &str) -> bool {
    lines.lines().all(|line| line.starts_with("$ "))
}

/// Returns the commands `jabuka …` in a line of shell input, without the text after `&&`, `;`, `|` or `#`.
pub(crate) fn of_line(line: &str) -> Vec<String> {
    let line = line.split(" #").next().unwrap_or_default();
    let pieces = line.split(['&', ';', '|', '>', '<']).map(str::trim);
    pieces.filter_map(|piece| piece.find("jabuka ").map(|at| piece[at..].to_owned())).collect()
}

/// Checks that a command with its arguments is valid. `--help` is appended, so the command itself does not run.
///
/// # Errors
///
/// If the command is not valid: the message that it printed.
pub(crate) fn parses(command: &str) -> Result<(), String> {
    let arguments = command.split(" -- ").next().unwrap();
    let output = run(&format!("{arguments} --help"), root());
    if output.status.success() { Ok(()) } else { Err(stderr(&output)) }
}

/// Runs the commands of several lines in a folder, which is also the home folder. Stops at the first command that fails.
pub(crate) fn run(lines: &str, folder: &Path) -> Output {
    let script: String = lines.lines().map(|line| format!("{}\n", line.trim_start_matches("$ "))).collect();
    let jabuka = Path::new(env!("CARGO_BIN_EXE_jabuka")).parent().unwrap();
    let path = format!("{}:{}", jabuka.display(), std::env::var("PATH").unwrap());
    Command::new("bash")
        .args(["-ec", &script])
        .current_dir(folder)
        .env("PATH", path)
        .env("HOME", folder)
        .env_remove("XDG_CACHE_HOME")
        .env_remove("XDG_STATE_HOME")
        .env_remove("JABUKA_CACHE_DIR")
        .output()
        .unwrap()
}

/// Returns jabuka's subcommands, each with its long options, from the output of `--help`.
pub(crate) fn tree() -> BTreeMap<String, BTreeSet<String>> {
    let help = |arguments: &[&str]| {
        let output = jabuka().args(arguments).arg("--help").output().unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
        stdout(&output)
    };
    let top = help(&[]);
    let list = top.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    // A line with a deeper indentation continues the line above.
    let lines = list.lines().filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' ')));
    let names = lines.filter_map(|line| line.split_whitespace().next());
    let options_of = |name: &str| match name {
        "help" => BTreeSet::new(),
        name => options(&help(&[name])),
    };
    // `sandbox` is hidden from the help, because only jabuka itself starts it.
    let tree = names.chain(["sandbox"]).map(|name| (name.to_owned(), options_of(name)));
    tree.chain([(String::new(), options(&top))]).collect()
}

/// Returns the long options that a text mentions, such as `--video`.
pub(crate) fn options(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for (at, _) in text.match_indices("--") {
        let before = text[..at].chars().next_back();
        let name: String =
            text[at + 2..].chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '-').collect();
        let begins = name.starts_with(|c: char| c.is_ascii_lowercase());
        if begins && before.is_none_or(|c| !c.is_ascii_alphanumeric() && c != '-') {
            found.insert(name);
        }
    }
    found
}
