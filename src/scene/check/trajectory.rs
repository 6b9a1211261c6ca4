//! Reads the trajectories of bodies from CSV files, which have one row for each time and body.

mod columns;
mod fields;
mod rows;
mod velocities;

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub(super) use columns::Columns;

use self::fields::Fields;
use self::rows::{Reader, Wrong};
use self::velocities::Contradiction;
use super::Context;
use super::read::figure;
use crate::diagnostic::{Code, Diagnostic, Span, nearest};
use crate::physics::Keyframe;
use crate::scene::ColumnUnit;
use crate::scene::grammar::quoted;
use crate::scene::source::file;
use crate::scene::units;

/// The maximum size of a trajectory file, in bytes: enough for some millions of rows.
const MOST_BYTES: u64 = 256 << 20;

/// The rows of a trajectory file, grouped by the name of the body. The name is `None` if the file has no column for the body.
#[derive(Default)]
pub(super) struct Recording {
    pub(super) rows: HashMap<Option<String>, Vec<Keyframe>>,
    /// The distinct times of all rows, in ascending order, s.
    pub(super) times: Vec<f64>,
    /// The further columns that the scene may name, each with its name and its unit.
    pub(super) further: Vec<(String, ColumnUnit)>,
    /// The values in these columns in each row, grouped by the name of the body as the rows are. NaN where the file has no number.
    pub(super) values: HashMap<Option<String>, Vec<Vec<f64>>>,
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
            let recording = reader.read(columns, &|name| context.sources.mentions(name));
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

/// The file of a motion, for errors: its path, its name in the scene, the names of its columns, and the body's name in it.
pub(super) struct Origin<'a> {
    pub(super) path: &'a Path,
    pub(super) name: &'a str,
    pub(super) columns: &'a Columns,
    pub(super) body: Option<&'a str>,
    /// The place in the scene that names the file.
    pub(super) at: Span,
}

/// Returns an error if the velocity columns of a body contradict its places or its orientations. `gaps` holds the index of the row after
/// each gap, and `is_turned` tells whether the file has orientations.
pub(super) fn contradiction(
    keys: &[Keyframe],
    gaps: &[usize],
    is_turned: bool,
    origin: &Origin<'_>,
    context: &mut Context<'_>,
) -> Option<Diagnostic> {
    let columns = origin.columns;
    let of_orientations = || is_turned.then(|| velocities::of_orientations(keys, gaps)).flatten();
    let (found, names, key, of, what) = match velocities::of_places(keys, gaps) {
        Some(found) => (found, &columns.velocity, "velocity", columns::VELOCITY_UNIT, "the places change"),
        None => {
            let what = "the orientations change";
            (
                of_orientations()?,
                &columns.angular_velocity,
                "angular_velocity",
                columns::ANGULAR_VELOCITY_UNIT,
                what,
            )
        }
    };
    let Contradiction { row, axis, column, rows, factor } = found;
    let (column, rows) = (figure(rounded(column)), figure(rounded(rows)));
    let name = names.get(axis)?;
    let time = figure(rounded(keys.get(row)?.time));
    let message = format!("the velocities contradict the rows: `{name}` is {column} {of} at t = {time} s");
    let label = format!("{what} by {rows} {of} here");
    // The unit that would explain the difference.
    let is_it = |unit: &&str| {
        units::factor(unit, of).is_some_and(|known| factor > 0.0 && (0.8..1.25).contains(&(factor * known)))
    };
    let unit = units::usual(of).into_iter().find(is_it);
    let unit = unit.map_or_else(
        || "its unit in the header".to_owned(),
        |unit| format!("`{name} [{unit}]` in the header"),
    );
    let help = format!(
        "if the column has another unit, write {unit}; or leave it out: `motion.trajectory.columns.{key} = []`"
    );
    let text = file::read_text(origin.path, MOST_BYTES).unwrap_or_default();
    let field = Fields::new(&text).find(columns, origin.body, row, name);
    let place = match field {
        Some(field) => Span::new(context.sources.add(origin.name, text.as_str()), field),
        None => origin.at,
    };
    Some(Diagnostic::error(Code::CsvVelocity, message).at(place, label).help(help))
}

/// Rounds a number to four digits.
fn rounded(number: f64) -> f64 {
    format!("{number:.3e}").parse().unwrap_or(number)
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
