//! The command `jabuka man`: prints the manual page.

use clap::CommandFactory;

use super::{Failure, terminal};

/// Print the manual page, in the format of `man`
#[derive(clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_: &Arguments) -> Result<(), Failure> {
    let mut page = Vec::new();
    let written = clap_mangen::Man::new(super::Arguments::command()).render(&mut page);
    written.map_err(|error| {
        terminal::error(&format!("error: {error}\n"));
        Failure::Errors
    })?;
    terminal::result(&String::from_utf8_lossy(&page));
    Ok(())
}
