//! The command line: parses the arguments, calls the library, and returns the exit code.
//!
//! Only `terminal.rs` writes to standard output: a failed write makes the command fail at its end, except that a closed pipe is no error.
//! `shell.rs` quotes the paths in suggested commands.
//!
//! The crate `ctrlc` handles Ctrl-C and other signals that end a program. `system` makes a file that exceeds `ulimit -f` an error,
//! instead of a signal that kills jabuka.

mod average;
mod batch;
mod cache;
mod check;
mod compile;
mod completions;
mod doctor;
mod explain;
mod export;
mod interrupt;
#[cfg(feature = "language-server")]
mod language_server;
mod list;
mod man;
mod new;
mod picture_arguments;
mod povray_arguments;
#[cfg(feature = "preview")]
mod preview;
mod products;
mod progress;
mod render;
mod report;
mod run_arguments;
mod sandbox;
mod scene_arguments;
mod schema;
mod shell;
mod status;
mod still;
mod summary;
mod templates;
mod terminal;
mod version;
mod video_arguments;

use std::borrow::Cow;
use std::ffi::OsString;
use std::process::ExitCode;

use crate::diagnostic::visible;
use clap::error::ErrorKind;
use clap::{Parser, Subcommand};

/// Compiles a physics scene written in TOML into POV-Ray scripts, one per frame.
#[derive(Parser)]
#[command(version, about, max_term_width = 100)]
struct Arguments {
    /// With --version: also print the versions of POV-Ray and ffmpeg, and what the sandbox enforces
    #[arg(short, long)]
    verbose: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    New(new::Arguments),
    Compile(compile::Arguments),
    #[cfg(feature = "preview")]
    Preview(preview::Arguments),
    Render(render::Arguments),
    Still(still::Arguments),
    Batch(batch::Arguments),
    Average(average::Arguments),
    Export(export::Arguments),
    Status(status::Arguments),
    Doctor(doctor::Arguments),
    Check(check::Arguments),
    Report(report::Arguments),
    Cache(cache::Arguments),
    Templates(templates::Arguments),
    Explain(explain::Arguments),
    List(list::Arguments),
    Schema(schema::Arguments),
    #[cfg(feature = "language-server")]
    #[command(name = "lsp")]
    LanguageServer(language_server::Arguments),
    Completions(completions::Arguments),
    Man(man::Arguments),
    #[command(hide = true)]
    Sandbox(sandbox::Arguments),
}

/// The reason why a command did not succeed.
enum Failure {
    /// The scene or its run has errors. They have been printed.
    Errors,
    /// The user has stopped the command by Ctrl-C. A message has been printed.
    Interrupted,
    /// The scene lacks what the arguments ask for. The text describes what is missing and has not been printed yet.
    Scene(Cow<'static, str>),
    /// The arguments of the command are wrong. The text describes the mistake and has not been printed yet.
    Usage(String),
}

/// Runs the command that the arguments of this process name, and returns the exit code.
pub fn main() -> ExitCode {
    ExitCode::from(run(std::env::args_os()))
}

/// Runs the command that these arguments name, and returns the exit code. The first argument is the name of the program. A process runs one
/// command: the handlers of signals stay, and so does the error of a lost standard output.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    crate::system::prepare_process();
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    terminal::ended(parse_and_run(&arguments))
}

/// Parses the arguments, and runs the command.
fn parse_and_run(arguments: &[OsString]) -> u8 {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) if error.kind() == ErrorKind::DisplayVersion && version::is_verbose(arguments) => {
            terminal::result(&version::report());
            return 0;
        }
        Err(error) => return terminal::misused(&error),
    };
    if arguments.verbose {
        terminal::error("error: `--verbose` goes with `--version`\n");
        return 2;
    }
    let result = match arguments.command {
        Command::Compile(arguments) => compile::run(&arguments),
        #[cfg(feature = "preview")]
        Command::Preview(arguments) => preview::run(&arguments),
        Command::Render(arguments) => render::run(&arguments),
        Command::Still(arguments) => still::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Average(arguments) => average::run(&arguments),
        Command::Batch(arguments) => batch::run(&arguments),
        Command::Status(arguments) => status::run(&arguments),
        Command::Doctor(doctor::Arguments {}) => doctor::run(),
        Command::Check(arguments) => check::run(&arguments),
        Command::Report(arguments) => report::run(&arguments),
        Command::Cache(arguments) => cache::run(&arguments),
        Command::Templates(arguments) => templates::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::List(arguments) => list::run(&arguments),
        Command::New(arguments) => new::run(&arguments),
        Command::Schema(arguments) => schema::run(&arguments),
        #[cfg(feature = "language-server")]
        Command::LanguageServer(language_server::Arguments {}) => language_server::run(),
        Command::Completions(arguments) => completions::run(&arguments),
        Command::Man(arguments) => man::run(&arguments),
        Command::Sandbox(arguments) => return sandbox::run(arguments),
    };
    match result {
        Ok(()) => 0,
        Err(Failure::Errors) => 1,
        // 130 is the exit code by which shells report that Ctrl-C has ended a command.
        Err(Failure::Interrupted) => 130,
        Err(Failure::Scene(message)) => {
            terminal::error(&format!("error: {}\n", visible(&message)));
            1
        }
        Err(Failure::Usage(message)) => {
            terminal::error(&format!(
                "error: {}\n\nFor more information, try '--help'.\n",
                visible(&message)
            ));
            2
        }
    }
}
