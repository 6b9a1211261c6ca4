//! What is said to people: results to standard output, the rest to standard error.
//!
//! A reader that has gone away (`jabuka … | head`) is no error of ours, so failures to write are of no account.

use std::io::{IsTerminal, Write};

use jabuka::diagnostic::Report;

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
