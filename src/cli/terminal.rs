//! Prints to the terminal: results to standard output, messages to standard error.
//!
//! All output passes through this module. It makes control characters visible, so that no printed text can send commands to the terminal.
//! It keeps line breaks, so a caller that prints a name must escape line breaks in the name first.
//!
//! Nothing else writes to standard output. After a failed write, nothing more is written there, and [`ended`] turns the failure into an error at
//! the end of the command. So the files that the command writes are complete, and no command can forget to check. It is no failure if the reader
//! closes the pipe early (`jabuka … | head`).

use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::OnceLock;

use crate::diagnostic::{Code, Report, is_invisible, visible, visible_lines};
use crate::output::Folder;
use crate::overwrite::CannotOverwrite;
use clap::error::ContextKind;

use super::{Failure, shell};

/// Commands, each with the words that other programs have for it.
const OTHER_WORDS: [(&str, &[&str]); 10] = [
    ("preview", &["run", "view", "show", "play", "watch", "open", "live", "simulate", "start", "serve"]),
    ("compile", &["build", "make", "write", "scripts"]),
    ("render", &["film", "video", "movie", "animate", "draw", "images"]),
    ("still", &["image", "picture", "snapshot", "screenshot", "frame", "shot"]),
    ("new", &["init", "create", "add"]),
    ("check", &["validate", "lint", "verify", "test"]),
    ("export", &["convert", "csv", "save"]),
    ("report", &["accuracy", "analyze", "energy"]),
    ("list", &["ls", "materials", "shapes", "integrators", "scenes", "examples"]),
    ("batch", &["submit", "slurm", "cluster"]),
];

/// The first error of writing to standard output.
static LOST: OnceLock<io::Error> = OnceLock::new();

/// Prints a result to standard output.
pub(super) fn result(text: &str) {
    print(&visible_lines(text));
}

/// Prints a result in JSON to standard output. Invisible characters are escaped as in JSON.
pub(super) fn json(text: &str) {
    // Invisible characters occur only in JSON strings. The serializer has already escaped those below U+0020.
    let escape = |c: char| match c {
        c if is_invisible(c) && c != '\n' => {
            c.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\u{unit:04x}")).collect()
        }
        c => c.to_string(),
    };
    print(&text.chars().map(escape).collect::<String>());
}

/// Prints a result to the terminal, and replaces the given number of lines above it.
pub(super) fn in_place_of(lines: usize, text: &str) {
    let up = if lines > 0 { format!("\x1b[{lines}A\x1b[J") } else { String::new() };
    print(&(up + &visible_lines(text)));
}

fn print(text: &str) {
    if is_lost() {
        return;
    }
    let mut stream = stdout().lock();
    keep(stream.write_all(text.as_bytes()).and_then(|()| stream.flush()));
}

#[allow(clippy::disallowed_methods, reason = "this module is the one that writes to standard output")]
fn stdout() -> io::Stdout {
    io::stdout()
}

/// Remembers the error of a failed write to standard output.
fn keep(written: io::Result<()>) {
    if let Err(error) = written {
        // Only the first error tells what went wrong.
        let _ = LOST.set(error);
    }
}

/// Returns true if nothing more can be printed to standard output, because its reader has gone or its disk is full.
pub(super) fn is_lost() -> bool {
    LOST.get().is_some()
}

/// Returns true if standard output is a terminal.
pub(super) fn is_interactive() -> bool {
    stdout().is_terminal()
}

/// Returns the exit code of a command that would end with `code`: if standard output could not be written, prints the error, and the command has
/// failed.
pub(super) fn ended(code: u8) -> u8 {
    match LOST.get() {
        Some(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            report(&Report::of_error(Code::CannotWrite, format!("cannot write to standard output: {error}")));
            code.max(1)
        }
        _ => code,
    }
}

/// Prints a message to standard error.
pub(super) fn error(text: &str) {
    complain(&visible_lines(text));
}

/// Prints a message to standard error. If this fails, there is nobody left to tell.
fn complain(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Prints errors and warnings to standard error, in colors if it is a terminal and `NO_COLOR` is not set.
pub(super) fn report(report: &Report) {
    let color = io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty());
    complain(&report.to_text(color));
}

/// If a check found a protected file, prints the error and converts it to a [`Failure`]. Passes on any other result.
pub(super) fn report_protected<T>(checked: Result<T, CannotOverwrite>) -> Result<T, Failure> {
    checked.map_err(|error| {
        report(&error.report());
        Failure::Errors
    })
}

/// Prints which files of a folder were moved aside because the user had edited them. Called even if the command failed later.
pub(super) fn edits(folder: &Folder) {
    report(&Report { diagnostics: folder.edits().into_iter().collect(), ..Report::default() });
}

/// Prints a list in two columns: names and descriptions.
pub(super) fn rows(rows: &[(&str, &str)]) {
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let text: String = rows.iter().map(|(name, what)| format!("{name:width$}  {what}\n")).collect();
    result(&text);
}

/// Prints the error for an unknown name. `near` is a similar name to suggest, if any.
pub(super) fn unknown(noun: &str, name: &str, near: Option<&str>) -> Failure {
    let meant = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    error(&format!("error: there is no {noun} `{}`{meant}\n", visible(name)));
    Failure::Errors
}

/// Prints the error in the command-line arguments, or the help that the user requested, and returns the exit code.
pub(super) fn misused(error: &clap::Error) -> u8 {
    let word = error.get(ContextKind::InvalidSubcommand).map(ToString::to_string).unwrap_or_default();
    let with_ending = if word.ends_with(".toml") { word.clone() } else { format!("{word}.toml") };
    let scene = Path::new(&with_ending);
    if with_ending == word || !word.is_empty() && scene.is_file() {
        let command = format!("jabuka compile {}", shell::path(scene));
        self::error(&format!("error: `{}` is not a command; did you mean `{command}`?\n", visible(&word)));
        return 2;
    }
    if let Some((command, _)) = OTHER_WORDS.iter().find(|(_, words)| words.contains(&&*word)) {
        self::error(&format!("error: there is no command `{word}`; did you mean `jabuka {command}`?\n"));
        return 2;
    }
    // The message of clap repeats arguments, which may contain control characters.
    let text = error.render().to_string();
    match visible_lines(&text) == text {
        true if error.use_stderr() => drop(error.print()),
        true => keep(error.print().and_then(|()| stdout().flush())),
        false => self::error(&text),
    }
    if error.use_stderr() { 2 } else { 0 }
}
