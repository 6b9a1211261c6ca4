//! The output of `jabuka --version --verbose`: the versions of the programs used for rendering.

use std::path::Path;
use std::process::{Command, Stdio};

use jabuka::sandbox;

/// Returns true if the command line contains `--verbose` or `-v`. clap stops parsing at `--version`, so the arguments are searched here.
pub(super) fn is_verbose() -> bool {
    std::env::args_os().skip(1).any(|argument| {
        let argument = argument.to_string_lossy();
        argument == "--verbose"
            || (argument.starts_with('-') && !argument.starts_with("--") && argument.contains('v'))
    })
}

/// Returns the versions of jabuka, POV-Ray and ffmpeg, and a description of what the sandbox enforces.
pub(super) fn report() -> String {
    format!(
        "jabuka   {}\nPOV-Ray  {}\nffmpeg   {}\nsandbox  {}\n",
        env!("CARGO_PKG_VERSION"),
        found("povray", "--version", "POV-Ray "),
        found("ffmpeg", "-version", "ffmpeg version "),
        sandbox::enforced()
    )
}

/// Returns the version and the path of a program. `option` makes the program print its version, which follows the words `before`.
fn found(name: &str, option: &str, before: &str) -> String {
    let Ok(path) = which::which(name) else { return format!("not found: no `{name}` on the PATH") };
    match ask(&path, option, before) {
        Some(version) => format!("{version} ({})", path.display()),
        None => format!("unknown: `{} {option}` does not tell its version", path.display()),
    }
}

fn ask(path: &Path, option: &str, before: &str) -> Option<String> {
    let output = Command::new(path).arg(option).stdin(Stdio::null()).output().ok()?;
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said);
    let version = said.lines().find_map(|line| line.strip_prefix(before)?.split_whitespace().next())?;
    Some(version.to_owned())
}
