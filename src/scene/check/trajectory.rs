//! Reads the trajectories of bodies from CSV files, which have one row for each time and body.

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
use crate::dynamics::Keyframe;
use crate::scene::grammar::quoted;
use crate::scene::source::file;

/// The maximum size of a trajectory file, in bytes: enough for some millions of rows.
const MOST_BYTES: u64 = 256 << 20;

/// The rows of a trajectory file, grouped by the name of the body. The name is `None` if the file has no column for the body.
#[derive(Default)]
pub(super) struct Recording {
    pub(super) rows: HashMap<Option<String>, Vec<Keyframe>>,
    /// The distinct times of all rows, in ascending order, s.
    pub(super) times: Vec<f64>,
    /// Whether the file has columns for the orientation.
    pub(super) is_turned: bool,
}

/// The trajectory files read so far, by path and names of columns. `None` for a file with errors, which have been reported.
pub(super) type Recordings = HashMap<(PathBuf, Columns), Option<Arc<Recording>>>;

/// Returns the recording in a trajectory file. Reads each file only once. Returns `None` and reports errors if the file is wrong.
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

/// Returns the error for a recording that has no rows of the given body.
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
