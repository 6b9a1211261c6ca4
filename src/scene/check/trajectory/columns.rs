//! Finds the columns of a trajectory file by the names and units in its header.

use csv::StringRecord;

use super::super::view::View;
use super::rows::Reader;
use crate::diagnostic::{Code, nearest};
use crate::scene::grammar::motion::columns;
use crate::scene::grammar::{Any, Key, quoted};
use crate::scene::units;

/// The names of the columns in a trajectory file.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(in super::super) struct Columns {
    pub(super) time: String,
    pub(super) body: String,
    pub(super) location: Vec<String>,
    pub(super) orientation: Vec<String>,
    pub(super) velocity: Vec<String>,
    pub(super) angular_velocity: Vec<String>,
    /// Whether the scene gives names for the columns `body`, `orientation`, `velocity` and `angular_velocity`, in this order. The file
    /// must have the columns that the scene names.
    pub(super) given: [bool; 4],
}

impl Columns {
    pub(in super::super) fn read(view: &View<'_>) -> Columns {
        let many = |key: &Key<Any>, usual: &[&str]| {
            let given =
                view.list(key).map(|items| items.iter().filter_map(|item| item.as_str()).collect::<Vec<_>>());
            given.unwrap_or_else(|| usual.to_vec()).into_iter().map(str::to_owned).collect()
        };
        let found = [
            &columns::BODY.spec,
            &columns::ORIENTATION.spec,
            &columns::VELOCITY.spec,
            &columns::ANGULAR_VELOCITY.spec,
        ];
        Columns {
            time: view.get(&columns::TIME).unwrap_or("t").to_owned(),
            body: view.get(&columns::BODY).unwrap_or("body").to_owned(),
            location: many(&columns::LOCATION, &["x", "y", "z"]),
            orientation: many(&columns::ORIENTATION, &["qx", "qy", "qz", "qw"]),
            velocity: many(&columns::VELOCITY, &["vx", "vy", "vz"]),
            angular_velocity: many(&columns::ANGULAR_VELOCITY, &["wx", "wy", "wz"]),
            given: found.map(|key| view.has(key)),
        }
    }
}

/// A column of numbers: its index, and the factor that converts its unit to SI units.
pub(super) type Column = (usize, f64);

/// The SI unit of a time.
pub(super) const TIME_UNIT: &str = "s";
/// The SI unit of a length.
pub(super) const LENGTH_UNIT: &str = "m";
/// The SI unit of a velocity.
pub(super) const VELOCITY_UNIT: &str = "m/s";
/// The SI unit of an angular velocity.
pub(super) const ANGULAR_VELOCITY_UNIT: &str = "rad/s";
/// The empty unit of a quantity without a unit.
pub(super) const NO_UNIT: &str = "";

impl Reader<'_> {
    /// Returns the index and the unit of the column `name` in the file's header. The unit is empty if the header gives none.
    pub(super) fn find(&self, header: &StringRecord, name: &str) -> Option<(usize, String)> {
        let called = |name: &str| {
            header.iter().enumerate().find_map(|(i, field)| {
                let (stem, unit) = unit_of(field);
                let is_it = field.eq_ignore_ascii_case(name) || stem.eq_ignore_ascii_case(name);
                is_it.then(|| (i, unit.to_owned()))
            })
        };
        // The column for the time may be called `t` or `time`.
        called(name).or_else(|| if name == "t" { called("time") } else { None })
    }

    pub(super) fn column(
        &mut self,
        header: &StringRecord,
        start: usize,
        name: &str,
        of: &str,
    ) -> Option<Column> {
        let Some((i, unit)) = self.find(header, name) else {
            self.missing(header, start, name);
            return None;
        };
        let factor = if unit.is_empty() || of == NO_UNIT && unit == "1" {
            Some(1.0)
        } else {
            units::factor(&unit, of)
        };
        if factor.is_none() {
            let at = self.fields.field(start, i);
            self.error(Code::CsvUnit, format!("the unit `{unit}` is not known here"), at);
            let known = units::usual(of);
            if let Some(wrong) = self.wrong.last_mut() {
                wrong.help = Some(match known.as_slice() {
                    [] => "this column has no unit".to_owned(),
                    known => format!("there are {}", quoted(known)),
                });
            }
        }
        Some((i, factor?))
    }

    /// Finds a group of columns, such as the coordinates of a vector. Returns `None` without an error if the file has none of them and
    /// `needed` is false.
    pub(super) fn columns(
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

    pub(super) fn missing(&mut self, header: &StringRecord, start: usize, name: &str) {
        let line = self.fields.line(start);
        if let Some((message, help)) = without_names(header) {
            // Report this error only once, because it concerns all columns.
            if self.wrong.is_empty() {
                self.error(Code::CsvColumn, message.to_owned(), line);
                self.wrong.iter_mut().for_each(|wrong| wrong.help = Some(help.to_owned()));
            }
            return;
        }
        let names: Vec<&str> = header.iter().map(|field| unit_of(field).0).collect();
        self.error(Code::CsvColumn, format!("there is no column `{name}`"), line);
        // Do not suggest a similar name for a single letter, which is similar to every other letter.
        let near = nearest(name, names.iter().copied()).filter(|_| name.len() > 1);
        if let Some(wrong) = self.wrong.last_mut() {
            wrong.label = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None => "these are the columns".to_owned(),
            };
            wrong.help = Some("`columns` gives the names of the columns in the file".to_owned());
        }
    }
}

/// Returns the error message and the help for a file whose first line does not name columns. `None` if the line names columns.
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

/// Splits a header field such as `x [m]` or `x (m)` into the name and the unit. The unit is empty if the field has none.
pub(super) fn unit_of(field: &str) -> (&str, &str) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((stem, unit)) = field.strip_suffix(close).and_then(|field| field.rsplit_once(open)) {
            return (stem.trim(), unit.trim());
        }
    }
    (field, "")
}
