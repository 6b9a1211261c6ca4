//! The command `jabuka completions`: prints a script with which a shell completes jabuka's commands and options.

use crate::catalog::CATEGORIES;
use crate::explain::explanations;
use crate::scene::grammar::all_keys;
use crate::starter::Example;
use clap::CommandFactory;
use clap::builder::PossibleValuesParser;
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
    clap_complete::generate(arguments.shell, &mut command(), "jabuka", &mut script);
    terminal::result(&String::from_utf8_lossy(&script));
    Ok(())
}

/// Returns the command line with all values of the arguments that take one of a closed list. The command line itself accepts any value there, so
/// that a command can answer to a wrong one in its own words.
fn command() -> clap::Command {
    let whole = super::Arguments::command();
    let commands = whole.get_subcommands().filter(|command| !command.is_hide_set());
    let commands: Vec<String> = commands.map(|command| command.get_name().to_owned()).collect();
    let codes = explanations().map(|entry| entry.code.name().to_owned());
    // Longer paths would be too many.
    let keys = all_keys().into_iter().map(|key| key.path.replace("NAME.", ""));
    let keys = keys.filter(|path| path.split('.').count() <= 2);
    let lists = [
        ("list", "category", CATEGORIES.iter().map(|category| category.name.to_owned()).collect()),
        ("explain", "code", codes.chain(keys).collect()),
        (
            "new",
            "like",
            Example::starters().chain(Example::gallery()).map(|example| example.name.to_owned()).collect(),
        ),
        ("man", "command", commands),
    ];
    lists.into_iter().fold(whole, |whole, (command, argument, values): (_, _, Vec<String>)| {
        // clap keeps values of static lifetime; the program ends soon.
        let values = values.into_iter().map(|value| &*value.leak());
        whole.mut_subcommand(command, |command| {
            command.mut_arg(argument, |argument| argument.value_parser(PossibleValuesParser::new(values)))
        })
    })
}
