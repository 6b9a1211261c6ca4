//! Trajectories from CSV files: a row for each time and body.

use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use csv::{ReaderBuilder, StringRecord, Trim};
use glam::{DQuat, DVec3};

use super::Context;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span, nearest};
use crate::dynamics::Key;
use crate::scene::source::file;
use crate::scene::units;

/// What columns are called.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Columns {
    time: String,
    body: String,
    location: Vec<String>,
    orientation: Vec<String>,
    velocity: Vec<String>,
    angular_velocity: Vec<String>,
    /// Those that a scene names must be there.
    given: [bool; 4],
}

/// The rows of a file, by body; where it does not tell bodies apart, under no name.
#[derive(Default)]
pub(super) struct Recording {
    pub(super) rows: HashMap<Option<String>, Vec<Key>>,
    /// The times of all rows, in rising order, s.
    pub(super) times: Vec<f64>,
    /// Whether the file says how bodies are turned.
    pub(super) is_turned: bool,
}

/// The files that have been read, and what could not be read of others has been said.
pub(super) type Recordings = HashMap<(PathBuf, Columns), Option<Arc<Recording>>>;

impl Columns {
    pub(super) fn read(view: &View<'_>) -> Columns {
        let one = |key: &str, usual: &str| view.text(key).unwrap_or(usual).to_owned();
        let many = |key: &str, usual: &[&str]| {
            let given =
                view.list(key).map(|items| items.iter().filter_map(|item| item.as_str()).collect::<Vec<_>>());
            given.unwrap_or_else(|| usual.to_vec()).into_iter().map(str::to_owned).collect()
        };
        Columns {
            time: one("time", "t"),
            body: one("body", "body"),
            location: many("location", &["x", "y", "z"]),
            orientation: many("orientation", &["qx", "qy", "qz", "qw"]),
            velocity: many("velocity", &["vx", "vy", "vz"]),
            angular_velocity: many("angular_velocity", &["wx", "wy", "wz"]),
            given: ["body", "orientation", "velocity", "angular_velocity"].map(|key| view.has(key)),
        }
    }
}

/// Reads a file, once for all bodies that have their motion from it.
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
            let mut reader = Reader { text: &text, delimiter: delimiter(&text), wrong: Vec::new() };
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

/// That no row is of a body.
pub(super) fn no_rows(recording: &Recording, body: &str, at: Span) -> Diagnostic {
    let mut names: Vec<&str> = recording.rows.keys().flatten().map(String::as_str).collect();
    names.sort_unstable();
    let message = format!("the file has no rows of the body `{body}`");
    let label = match nearest(body, names.iter().copied()) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("it has {}", crate::scene::grammar::quoted(&names[..names.len().min(10)])),
    };
    Diagnostic::error(Code::CsvBody, message)
        .at(at, label)
        .help("`body` says what the body is called in the file")
}

/// What is wrong with a first line that names no columns, and what it should be.
fn without_names(header: &StringRecord) -> Option<(&'static str, &'static str)> {
    let words: Vec<&str> = header.iter().flat_map(str::split_whitespace).collect();
    let are_numbers = !words.is_empty() && words.iter().all(|word| word.parse::<f64>().is_ok());
    let is_one = header.len() == 1 && words.len() > 2;
    match (are_numbers, is_one) {
        (true, true) => Some((
            "the first line of the file names no columns",
            "write `t,x,y,z` above it, and commas between the numbers",
        )),
        (true, false) => Some(("the first line of the file names no columns", "write `t,x,y,z` above it")),
        (false, true) => Some((
            "the columns stand without commas between them",
            "write `t,x,y,z`, and commas in every line",
        )),
        (false, false) => None,
    }
}

/// Something wrong in the file.
struct Wrong {
    code: Code,
    message: String,
    at: Range<usize>,
    label: String,
    help: Option<String>,
}

struct Reader<'a> {
    text: &'a str,
    delimiter: u8,
    wrong: Vec<Wrong>,
}

/// A column with numbers: its place, and what its unit is worth in that of SI.
type Column = (usize, f64);

/// The largest file that is read: some millions of rows.
const MOST_BYTES: u64 = 256 << 20;

/// So many mistakes are shown of a file.
const SHOWN: usize = 20;

impl Reader<'_> {
    fn read(&mut self, columns: &Columns) -> Option<Recording> {
        let text = self.text;
        let mut csv = ReaderBuilder::new()
            .delimiter(self.delimiter)
            .comment(Some(b'#'))
            .trim(Trim::All)
            .flexible(true)
            .from_reader(text.as_bytes());
        let header = match csv.headers() {
            Ok(header) => header.clone(),
            Err(error) => {
                self.error(Code::CsvSyntax, format!("this is no CSV file: {error}"), 0..0);
                return None;
            }
        };
        let start = header.position().map_or(0, |p| usize::try_from(p.byte()).unwrap_or(0));
        let time = self.column(&header, start, &columns.time, TIME);
        let body = self.find(&header, &columns.body).map(|(i, _)| i);
        if columns.given[0] && body.is_none() {
            self.missing(&header, start, &columns.body);
        }
        let location = self.columns(&header, start, &columns.location, LENGTH, true);
        let orientation = self.columns(&header, start, &columns.orientation, RATIO, columns.given[1]);
        let velocity = self.columns(&header, start, &columns.velocity, VELOCITY, columns.given[2]);
        let turning = self.columns(&header, start, &columns.angular_velocity, TURNING, columns.given[3]);
        let (Some(time), Some(location)) = (time, location) else { return None };
        if !self.wrong.is_empty() {
            return None;
        }

        let mut recording = Recording { is_turned: orientation.is_some(), ..Recording::default() };
        let mut record = StringRecord::new();
        loop {
            match csv.read_record(&mut record) {
                Ok(true) => {}
                Ok(false) => break,
                Err(error) => {
                    let at = error.position().map_or(0, |p| usize::try_from(p.byte()).unwrap_or(0));
                    self.error(Code::CsvSyntax, format!("this is no row of a CSV file: {error}"), at..at);
                    break;
                }
            }
            let start = record.position().map_or(0, |p| usize::try_from(p.byte()).unwrap_or(0));
            let name = body.map(|body| record.get(body).unwrap_or_default().to_owned());
            let mut vector = |columns: &[Column]| -> Option<DVec3> {
                let [x, y, z] = columns else { return None };
                let numbers = [x, y, z].map(|column| self.number(&record, start, *column));
                Some(DVec3::new(numbers[0]?, numbers[1]?, numbers[2]?))
            };
            let (place, speed, spin) = (
                vector(&location),
                velocity.as_deref().map(&mut vector),
                turning.as_deref().map(&mut vector),
            );
            let time = self.number(&record, start, time);
            let turned = match orientation.as_deref() {
                Some(columns) => self.orientation(&record, start, columns),
                None => Some(DQuat::IDENTITY),
            };
            if self.wrong.len() >= SHOWN {
                break;
            }
            let (Some(time), Some(location), Some(orientation)) = (time, place, turned) else { continue };
            let keys = recording.rows.entry(name).or_default();
            if let Some(last) = keys.last().filter(|last| last.time >= time) {
                let message =
                    if last.time > time { "the time goes backwards" } else { "this time comes twice" };
                let message = format!("{message}: {time} s after {} s", last.time);
                let at = self.field(start, self.find(&header, &columns.time).map_or(0, |(i, _)| i));
                self.error(Code::CsvOrder, message, at);
                if let Some(wrong) = self.wrong.last_mut() {
                    wrong.help = Some("the rows of a body stand in the order of their times".to_owned());
                }
                continue;
            }
            keys.push(Key {
                time,
                location,
                orientation,
                velocity: speed.flatten(),
                angular_velocity: spin.flatten(),
            });
        }
        if recording.rows.is_empty() && self.wrong.is_empty() {
            let end = self.text.len();
            self.error(Code::CsvSyntax, "the file has no rows under its header".to_owned(), end..end);
        }
        recording.times = recording.rows.values().flatten().map(|key| key.time).collect();
        recording.times.sort_unstable_by(f64::total_cmp);
        recording.times.dedup();
        self.wrong.is_empty().then_some(recording)
    }

    /// The place of a column in the header, and its unit.
    fn find(&self, header: &StringRecord, name: &str) -> Option<(usize, String)> {
        let called = |name: &str| {
            header.iter().enumerate().find_map(|(i, field)| {
                let (stem, unit) = unit_of(field);
                let is_it = field.eq_ignore_ascii_case(name) || stem.eq_ignore_ascii_case(name);
                is_it.then(|| (i, unit.to_owned()))
            })
        };
        // Both words for the time are usual.
        called(name).or_else(|| if name == "t" { called("time") } else { None })
    }

    fn column(&mut self, header: &StringRecord, start: usize, name: &str, of: &str) -> Option<Column> {
        let Some((i, unit)) = self.find(header, name) else {
            self.missing(header, start, name);
            return None;
        };
        let factor =
            if unit.is_empty() || of == RATIO && unit == "1" { Some(1.0) } else { units::factor(&unit, of) };
        if factor.is_none() {
            let at = self.field(start, i);
            self.error(Code::CsvUnit, format!("the unit `{unit}` is not known here"), at);
            let known = units::usual(of);
            if let Some(wrong) = self.wrong.last_mut() {
                wrong.help = Some(match known.as_slice() {
                    [] => "this column has no unit".to_owned(),
                    known => format!("there are {}", crate::scene::grammar::quoted(known)),
                });
            }
        }
        Some((i, factor?))
    }

    /// Columns that are there together, or not at all.
    fn columns(
        &mut self,
        header: &StringRecord,
        start: usize,
        names: &[String],
        of: &str,
        needed: bool,
    ) -> Option<Vec<Column>> {
        if !needed && names.iter().all(|name| self.find(header, name).is_none()) {
            return None;
        }
        let found: Vec<_> = names.iter().map(|name| self.column(header, start, name, of)).collect();
        found.into_iter().collect()
    }

    fn missing(&mut self, header: &StringRecord, start: usize, name: &str) {
        let line = self.line(start);
        if let Some((message, help)) = without_names(header) {
            // Once for all columns.
            if self.wrong.is_empty() {
                self.error(Code::CsvColumn, message.to_owned(), line);
                self.wrong.iter_mut().for_each(|wrong| wrong.help = Some(help.to_owned()));
            }
            return;
        }
        let names: Vec<&str> = header.iter().map(|field| unit_of(field).0).collect();
        self.error(Code::CsvColumn, format!("there is no column `{name}`"), line);
        // Of one letter, any other would be near.
        let near = nearest(name, names.iter().copied()).filter(|_| name.len() > 1);
        if let Some(wrong) = self.wrong.last_mut() {
            wrong.label = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None => "these are the columns".to_owned(),
            };
            wrong.help = Some("`columns` says what columns are called in the file".to_owned());
        }
    }

    fn number(&mut self, record: &StringRecord, start: usize, (column, factor): Column) -> Option<f64> {
        let field = record.get(column);
        let number = field.and_then(|field| field.parse::<f64>().ok()).map(|number| number * factor);
        if let Some(number) = number.filter(|number| number.is_finite() && number.abs() <= 1e100) {
            return Some(number);
        }
        let found = match field {
            None => "the end of the row".to_owned(),
            Some("") => "nothing".to_owned(),
            Some(field) => format!("`{}`", field.chars().take(40).collect::<String>().escape_debug()),
        };
        let at = self.field(start, column);
        self.error(Code::CsvNumber, format!("expected a number, found {found}"), at);
        None
    }

    fn orientation(&mut self, record: &StringRecord, start: usize, columns: &[Column]) -> Option<DQuat> {
        let mut parts = [0.0; 4];
        for (part, column) in parts.iter_mut().zip(columns) {
            *part = self.number(record, start, *column)?;
        }
        let quaternion = DQuat::from_array(parts);
        if quaternion.length() > 1e-6 {
            return Some(quaternion.normalize());
        }
        let at = self.field(start, columns[0].0);
        self.error(Code::CsvNumber, "a quaternion of zeros is no orientation".to_owned(), at);
        None
    }

    fn error(&mut self, code: Code, message: String, at: Range<usize>) {
        if self.wrong.len() < SHOWN {
            self.wrong.push(Wrong { code, message, at, label: String::new(), help: None });
        }
    }

    /// The line that begins at a byte, or behind line breaks and comments there.
    fn line(&self, start: usize) -> Range<usize> {
        let rest = self.text.get(start..).unwrap_or_default();
        let skipped: usize = rest
            .split_inclusive('\n')
            .take_while(|line| line.trim().is_empty() || line.starts_with('#'))
            .map(str::len)
            .sum();
        let start = start + skipped;
        let line = self.text.get(start..).unwrap_or_default().lines().next().unwrap_or_default();
        start..start + line.trim_end().len()
    }

    /// The place of a field in the record that begins at a byte.
    fn field(&self, start: usize, column: usize) -> Range<usize> {
        let line = self.line(start);
        let (mut from, mut field, mut quoted) = (line.start, 0, false);
        for (i, byte) in self.text[line.clone()].bytes().enumerate() {
            let here = line.start + i;
            match byte {
                b'"' => quoted = !quoted,
                byte if byte == self.delimiter && !quoted => {
                    if field == column {
                        return self.trimmed(from..here);
                    }
                    (field, from) = (field + 1, here + 1);
                }
                _ => {}
            }
        }
        if field == column { self.trimmed(from..line.end) } else { line.end..line.end }
    }

    fn trimmed(&self, range: Range<usize>) -> Range<usize> {
        let text = &self.text[range.clone()];
        let start = range.start + (text.len() - text.trim_start().len());
        start..start + text.trim().len()
    }
}

/// `x [m]` or `x (m)` → the name and the unit.
fn unit_of(field: &str) -> (&str, &str) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((stem, unit)) = field.strip_suffix(close).and_then(|field| field.rsplit_once(open)) {
            return (stem.trim(), unit.trim());
        }
    }
    (field, "")
}

/// What stands between the fields of the first line.
fn delimiter(text: &str) -> u8 {
    let header =
        text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
    let count = |delimiter: char| header.matches(delimiter).count();
    let (best, _) = [(b',', count(',')), (b';', count(';')), (b'\t', count('\t'))]
        .into_iter()
        .fold((b',', 0), |best, next| if next.1 > best.1 { next } else { best });
    best
}

/// The quantities of columns: by the scene language's unit for them, empty for one without a unit.
const TIME: &str = "s";
const LENGTH: &str = "m";
const VELOCITY: &str = "m/s";
const TURNING: &str = "rad/s";
const RATIO: &str = "";
