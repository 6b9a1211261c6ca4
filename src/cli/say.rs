//! What is said to people: results to standard output, the rest to standard error.
//!
//! A reader that has gone away (`jabuka … | head`) is no error of ours, so failures to write are of no account.

use std::io::{IsTerminal, Write};
use std::process::ExitCode;

use clap::error::ContextKind;
use jabuka::diagnostic::Report;

use super::Failure;

/// Says a result.
pub(super) fn result(text: &str) {
    let _ = std::io::stdout().lock().write_all(text.as_bytes());
}

/// Says what is no result.
pub(super) fn error(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

/// Says errors and warnings, with colors where they can be seen.
pub(super) fn report(report: &Report) {
    let color = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty());
    error(&report.to_text(color));
}

/// Says a list of things, each with what there is to know about it, in two columns.
pub(super) fn rows(rows: &[(&str, &str)]) {
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let text: String = rows.iter().map(|(name, what)| format!("{name:width$}  {what}\n")).collect();
    result(&text);
}

/// Says that there is nothing of this name, and what may have been meant.
pub(super) fn unknown(noun: &str, name: &str, near: Option<&str>) -> Failure {
    let meant = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    error(&format!("error: there is no {noun} `{name}`{meant}\n"));
    Failure::Errors
}

/// Says what is wrong with the arguments, or the help that they ask for.
pub(super) fn misused(error: &clap::Error) -> ExitCode {
    let word = error.get(ContextKind::InvalidSubcommand).map(ToString::to_string);
    if let Some(scene) = word.filter(|word| word.ends_with(".toml")) {
        self::error(&format!("error: `{scene}` is not a command; did you mean `jabuka compile {scene}`?\n"));
        return ExitCode::from(2);
    }
    let _ = error.print();
    ExitCode::from(if error.use_stderr() { 2 } else { 0 })
}
