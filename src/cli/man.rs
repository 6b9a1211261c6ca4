//! The command `jabuka man`: prints a manual page.

use crate::diagnostic::nearest;
use clap::CommandFactory;

use super::{Failure, terminal};

/// Print the manual page of jabuka or of one of its commands, in the format of `man`
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The command whose page to print, such as `render`; without it, the page of jabuka is printed
    command: Option<String>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut whole = super::Arguments::command();
    whole.build();
    let command = match &arguments.command {
        None => whole
            .after_help("`jabuka man COMMAND` prints the page of a command: `jabuka man render | man -l -`."),
        Some(name) => {
            let shown = || whole.get_subcommands().filter(|command| !command.is_hide_set());
            let found = shown().find(|command| command.get_name() == name);
            let near = || nearest(name, shown().map(clap::Command::get_name));
            found.ok_or_else(|| terminal::unknown("command", name, near()))?.clone()
        }
    };
    let title = command.get_display_name().unwrap_or("jabuka").to_owned();
    let mut page = Vec::new();
    let written = clap_mangen::Man::new(command)
        .title(title)
        .source(concat!("jabuka ", env!("CARGO_PKG_VERSION")))
        .render(&mut page);
    written.map_err(|error| {
        terminal::error(&format!("error: {error}\n"));
        Failure::Errors
    })?;
    terminal::result(&String::from_utf8_lossy(&page));
    Ok(())
}
