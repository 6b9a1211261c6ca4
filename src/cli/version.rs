//! The output of `jabuka --version --verbose`: the versions of the programs used for rendering.

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::render::{Build, PovRay};
use crate::sandbox;

/// Returns true if the command line contains `--verbose` or `-v`. clap stops parsing at `--version`, so the arguments are searched here. The
/// first argument is the name of the program.
pub(super) fn is_verbose(arguments: &[OsString]) -> bool {
    arguments.iter().skip(1).any(|argument| {
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
        povray(),
        ffmpeg(),
        sandbox::enforced()
    )
}

/// Describes the installed POV-Ray: its version, its path, and its build.
fn povray() -> String {
    let Ok(path) = PovRay::locate(None) else { return "not found: no `povray` on the PATH".to_owned() };
    match (PovRay::version_of(&path), Build::of(&path)) {
        (Some(version), Build::Console) => format!("{version} ({})", path.display()),
        (Some(version), build) => format!("{version} ({}, {})", path.display(), build.name()),
        (None, _) => format!("unknown: `{} --version` does not tell its version", path.display()),
    }
}

/// Describes the installed ffmpeg: its version and its path.
fn ffmpeg() -> String {
    let Ok(path) = which::which("ffmpeg") else { return "not found: no `ffmpeg` on the PATH".to_owned() };
    match ffmpeg_version(&path) {
        Some(version) => format!("{version} ({})", path.display()),
        None => format!("unknown: `{} -version` does not tell its version", path.display()),
    }
}

fn ffmpeg_version(path: &Path) -> Option<String> {
    let output = Command::new(path).arg("-version").stdin(Stdio::null()).output().ok()?;
    let said = String::from_utf8_lossy(&output.stdout);
    let version =
        said.lines().find_map(|line| line.strip_prefix("ffmpeg version ")?.split_whitespace().next())?;
    Some(version.to_owned())
}
