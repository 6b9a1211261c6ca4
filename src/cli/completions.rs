//! `jabuka completions`: completion scripts for shells.

use clap::CommandFactory;
use clap_complete::Shell;

use super::{Failure, say};

/// Print what a shell needs to complete commands of jabuka
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The shell
    shell: Shell,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut super::Arguments::command(), "jabuka", &mut script);
    say::result(&String::from_utf8_lossy(&script));
    Ok(())
}
