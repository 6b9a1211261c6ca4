//! The command `jabuka sandbox`: starts a program that may access only the named files.

use std::ffi::OsString;
use std::path::PathBuf;

use crate::sandbox::{self, Launch};

use super::terminal;

/// Start a program that may read and write only the named files and folders, as far as the system can enforce it
///
/// jabuka and the scripts of cluster jobs use this command to start POV-Ray and ffmpeg. The program may also read the folders of the
/// system. It ends when the process that started it ends. If no program is given, the command prints what the system can enforce.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A path that the program may read and execute: a file, or a folder with its contents; may be repeated
    #[arg(long, value_name = "PATH")]
    read: Vec<PathBuf>,
    /// A path that the program may read and write; the first folder also receives temporary files; may be repeated
    #[arg(long, value_name = "PATH")]
    write: Vec<PathBuf>,
    /// The process that must be the parent of this one
    #[arg(long, value_name = "PID")]
    parent: Option<i32>,
    /// The increase of the program's nice value, which lowers its priority
    #[arg(long, value_name = "N")]
    nice: Option<i32>,
    /// The program to start, with its arguments
    #[arg(last = true, value_name = "PROGRAM")]
    program: Vec<OsString>,
}

/// Replaces this process by the confined program. Returns only if no program is given or it cannot be started.
pub(super) fn run(arguments: Arguments) -> u8 {
    let mut words = arguments.program.into_iter();
    let Some(program) = words.next() else {
        terminal::result(&format!("{}\n", sandbox::enforced()));
        return 0;
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
    terminal::error(&format!("jabuka sandbox: {error}\n"));
    error.code()
}
