//! The command `jabuka completions`: prints a script with which a shell completes jabuka's commands and options.

use clap::CommandFactory;
use clap_complete::Shell;

use super::{Failure, terminal};

/// Print a script with which a shell completes the commands and options of jabuka
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The shell to print the script for
    shell: Shell,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut super::Arguments::command(), "jabuka", &mut script);
    terminal::result(&String::from_utf8_lossy(&script));
    Ok(())
}
