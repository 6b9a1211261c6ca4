//! Reads trajectories from CSV files: one row for each time and body.

mod columns;
mod fields;
mod rows;

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub(super) use columns::Columns;

use self::rows::{Reader, Wrong};
use super::Context;
use crate::diagnostic::{Code, Diagnostic, Span, nearest};
use crate::dynamics::Key;
use crate::scene::grammar::quoted;
use crate::scene::source::file;

/// The maximum size of a file, bytes: some millions of rows.
const MOST_BYTES: u64 = 256 << 20;

/// The rows of a file, by the name of the body. The name is `None` if the file has no column of bodies.
#[derive(Default)]
pub(super) struct Recording {
    pub(super) rows: HashMap<Option<String>, Vec<Key>>,
    /// The times of all rows, in rising order, s.
    pub(super) times: Vec<f64>,
    /// Whether the file gives orientations.
    pub(super) is_turned: bool,
}

/// The files read so far. `None` for a file whose errors have been reported.
pub(super) type Recordings = HashMap<(PathBuf, Columns), Option<Arc<Recording>>>;

/// Reads a file, once for all bodies that move by it.
pub(super) fn read(
    path: &Path,
    name: &str,
    columns: &Columns,
    at: Span,
    context: &mut Context<'_>,
) -> Option<Arc<Recording>> {
    let key = (path.to_owned(), columns.clone());
    if let Some(known) = context.recordings.get(&key) {
        return known.clone();
    }
    let recording = match file::read_text(path, MOST_BYTES) {
        Ok(text) => {
            context.add_file(text.as_bytes());
            let mut reader = Reader::new(&text);
            let recording = reader.read(columns);
            let wrong = reader.wrong;
            if wrong.is_empty() {
                recording.map(Arc::new)
            } else {
                let id = context.sources.add(name, text.as_str());
                let place = |wrong: Wrong| {
                    let error =
                        Diagnostic::error(wrong.code, wrong.message).at(Span::new(id, wrong.at), wrong.label);
                    match wrong.help {
                        Some(help) => error.help(help),
                        None => error,
                    }
                };
                context.diagnostics.extend(wrong.into_iter().map(place));
                None
            }
        }
        Err(error) => {
            let message = format!("cannot read `{name}`: {error}");
            context.diagnostics.push(Diagnostic::error(Code::CsvSyntax, message).at(at, ""));
            None
        }
    };
    context.recordings.insert(key, recording.clone());
    recording
}

/// The error for a recording without rows of the body.
pub(super) fn no_rows(recording: &Recording, body: &str, at: Span) -> Diagnostic {
    let mut names: Vec<&str> = recording.rows.keys().flatten().map(String::as_str).collect();
    names.sort_unstable();
    let message = format!("the file has no rows of the body `{body}`");
    let label = match nearest(body, names.iter().copied()) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("it has {}", quoted(&names[..names.len().min(10)])),
    };
    Diagnostic::error(Code::CsvBody, message)
        .at(at, label)
        .help("`body` says what the body is called in the file")
}
