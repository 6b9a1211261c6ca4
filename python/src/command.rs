//! The command line in this process.

use std::ffi::OsString;
use std::path::PathBuf;

use jabuka::sandbox::Launcher;
use pyo3::prelude::*;

/// Runs the command line of jabuka. The first argument is the name of the program. Returns the exit code.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| jabuka::cli::run(arguments))
}

/// Sets the program that starts POV-Ray and ffmpeg in the sandbox, with its first arguments.
#[pyfunction]
pub(crate) fn set_launcher(program: PathBuf, arguments: Vec<OsString>) {
    Launcher::new(program).with_arguments(arguments).use_in_this_process();
}
