//! The output of `jabuka --version --verbose`: the versions of the programs used for rendering.

use std::ffi::OsString;

use crate::doctor;

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
        "jabuka   {}\n{}{}{}",
        env!("CARGO_PKG_VERSION"),
        doctor::povray(),
        doctor::ffmpeg(),
        doctor::sandbox()
    )
}
