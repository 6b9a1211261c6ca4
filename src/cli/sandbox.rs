//! `jabuka sandbox`: starts a program with access to the named files only.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

use jabuka::sandbox::{self, Launch};

use super::say;

/// Start a program that may read and write only what is named, as far as the system enforces it
///
/// jabuka and the scripts of cluster jobs start POV-Ray and ffmpeg by it. Every program may also read the folders of the
/// system. It ends when the process that started it ends. Without a program, it says what the system enforces.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A path that the program may read and run: a file, or a folder with its contents; may be repeated
    #[arg(long, value_name = "PATH")]
    read: Vec<PathBuf>,
    /// A path that the program may read and write; temporary files go to the first folder; may be repeated
    #[arg(long, value_name = "PATH")]
    write: Vec<PathBuf>,
    /// The process that must be its parent
    #[arg(long, value_name = "PID")]
    parent: Option<i32>,
    /// How far it lets other processes go first
    #[arg(long, value_name = "N")]
    nice: Option<i32>,
    /// The program and its arguments
    #[arg(last = true, value_name = "PROGRAM")]
    program: Vec<OsString>,
}

/// Returns only if no program replaced this process.
pub(super) fn run(arguments: Arguments) -> ExitCode {
    let mut words = arguments.program.into_iter();
    let Some(program) = words.next() else {
        say::result(&format!("{}\n", sandbox::enforced()));
        return ExitCode::SUCCESS;
    };
    let launch = Launch {
        program: program.into(),
        arguments: words.collect(),
        read: arguments.read,
        write: arguments.write,
        parent: arguments.parent,
        nice: arguments.nice,
    };
    let error = launch.run();
    say::error(&format!("jabuka sandbox: {error}\n"));
    ExitCode::from(error.code())
}
