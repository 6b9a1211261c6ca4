//! Commands in texts for people: whether jabuka has them, and what they do.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::{Command, Output};

use super::{jabuka, root, stderr, stdout};

/// Whether these lines are commands, each after `$ `.
pub(crate) fn are(lines: &str) -> bool {
    lines.lines().all(|line| line.starts_with("$ "))
}

/// The commands `jabuka …` in a line of a shell, without what comes after `&&`, `;`, `|` or `#`.
pub(crate) fn of_line(line: &str) -> Vec<String> {
    let line = line.split(" #").next().unwrap_or_default();
    let pieces = line.split(['&', ';', '|', '>', '<']).map(str::trim);
    pieces.filter_map(|piece| piece.find("jabuka ").map(|at| piece[at..].to_owned())).collect()
}

/// Whether jabuka has such a command with such arguments: with `--help` behind them, it only says what it makes of them.
pub(crate) fn parses(command: &str) -> Result<(), String> {
    let arguments = command.split(" -- ").next().unwrap();
    let output = run(&format!("{arguments} --help"), root());
    if output.status.success() { Ok(()) } else { Err(stderr(&output)) }
}

/// Runs lines of commands in a folder that is also the user's home. The first that fails ends them.
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
        .env_remove("JABUKA_CACHE_DIR")
        .output()
        .unwrap()
}

/// The subcommands of jabuka, each with its long options, as its help lists them.
pub(crate) fn tree() -> BTreeMap<String, BTreeSet<String>> {
    let help = |arguments: &[&str]| {
        let output = jabuka().args(arguments).arg("--help").output().unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
        stdout(&output)
    };
    let top = help(&[]);
    let list = top.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    // A line that is indented further goes on with the one above.
    let lines = list.lines().filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' ')));
    let names = lines.filter_map(|line| line.split_whitespace().next());
    let options_of = |name: &str| match name {
        "help" => BTreeSet::new(),
        name => options(&help(&[name])),
    };
    // `sandbox` is hidden: only jabuka itself starts it.
    let tree = names.chain(["sandbox"]).map(|name| (name.to_owned(), options_of(name)));
    tree.chain([(String::new(), options(&top))]).collect()
}

/// The long options that a text names: `--video`.
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
