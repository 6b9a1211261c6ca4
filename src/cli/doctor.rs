//! The command `jabuka doctor`: says what is there, and how to get what is not.

use crate::doctor::Checkup;

use super::{Failure, terminal};

/// Say what jabuka finds on this machine, and the command that gets what is missing
///
/// The exit code is 1 if something is missing.
#[derive(clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run() -> Result<(), Failure> {
    let checkup = Checkup::of_this_machine();
    let found: String = checkup.findings.iter().map(ToString::to_string).collect();
    terminal::result(&found);
    if checkup.is_well() {
        terminal::result("all is there\n");
        return Ok(());
    }
    let remedies: String = checkup.remedies().iter().map(|remedy| format!("missing  {remedy}\n")).collect();
    terminal::result(&remedies);
    Err(Failure::Errors)
}
