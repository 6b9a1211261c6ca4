//! Reads the rows of a CSV file as the motions of bodies.

use std::ops::Range;

use csv::StringRecord;
use glam::{DQuat, DVec3};

use super::Recording;
use super::columns::{
    ANGULAR_VELOCITY_UNIT, Column, Columns, LENGTH_UNIT, NO_UNIT, TIME_UNIT, VELOCITY_UNIT, unit_of,
};
use super::fields::Fields;
use crate::diagnostic::Code;
use crate::physics::Keyframe;
use crate::scene::{ColumnUnit, units};

/// A mistake in a trajectory file, before its position is turned into a source span.
pub(super) struct Wrong {
    pub(super) code: Code,
    pub(super) message: String,
    pub(super) at: Range<usize>,
    pub(super) label: String,
    pub(super) help: Option<String>,
}

/// Reads a trajectory file and collects its errors.
pub(super) struct Reader<'a> {
    pub(super) fields: Fields<'a>,
    pub(super) wrong: Vec<Wrong>,
}

/// The maximum number of mistakes that are reported for one file.
const MAX_REPORTED_MISTAKES: usize = 20;

impl<'a> Reader<'a> {
    pub(super) fn new(text: &'a str) -> Reader<'a> {
        Reader { fields: Fields::new(text), wrong: Vec::new() }
    }

    /// Reads the rows of the file. Of columns that are not part of the motion, keeps those that `is_named` accepts. Returns `None` and collects
    /// errors if the file has mistakes.
    pub(super) fn read(&mut self, columns: &Columns, is_named: &dyn Fn(&str) -> bool) -> Option<Recording> {
        let text = self.fields.text;
        let mut csv = self.fields.reader();
        let header = match csv.headers() {
            Ok(header) => header.clone(),
            Err(error) => {
                self.error(Code::CsvSyntax, format!("this is no CSV file: {error}"), 0..0);
                return None;
            }
        };
        let start = header.position().map_or(0, |p| usize::try_from(p.byte()).unwrap_or(0));
        let time = self.column(&header, start, &columns.time, TIME_UNIT);
        let body = self.find(&header, &columns.body).map(|(i, _)| i);
        if columns.given[0] && body.is_none() {
            self.missing(&header, start, &columns.body);
        }
        let location = self.columns(&header, start, &columns.location, LENGTH_UNIT, true);
        let orientation = self.columns(&header, start, &columns.orientation, NO_UNIT, columns.given[1]);
        let velocity = self.vector(&header, start, &columns.velocity, VELOCITY_UNIT, columns.given[2]);
        let turning =
            self.vector(&header, start, &columns.angular_velocity, ANGULAR_VELOCITY_UNIT, columns.given[3]);
        let (Some(time), Some(location)) = (time, location) else { return None };
        if !self.wrong.is_empty() {
            return None;
        }

        let groups = [Some(&location), orientation.as_ref(), velocity.as_ref(), turning.as_ref()];
        let used = groups.into_iter().flatten().flatten().chain([&time]).map(|(column, _)| *column);
        let used: Vec<usize> = used.chain(body).collect();
        let further = further(&header, &used, is_named);
        let mut recording = Recording {
            is_turned: orientation.is_some(),
            further: further.iter().map(|(_, name, (unit, _))| (name.clone(), unit.clone())).collect(),
            ..Recording::default()
        };
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
            if self.wrong.len() >= MAX_REPORTED_MISTAKES {
                break;
            }
            let (Some(time), Some(location), Some(orientation)) = (time, place, turned) else { continue };
            let values = recording.values.entry(name.clone()).or_default();
            let keys = recording.rows.entry(name).or_default();
            if let Some(last) = keys.last().filter(|last| last.time >= time) {
                let message =
                    if last.time > time { "the time goes backwards" } else { "this time comes twice" };
                let message = format!("{message}: {time} s after {} s", last.time);
                let at = self.fields.field(start, self.find(&header, &columns.time).map_or(0, |(i, _)| i));
                self.error(Code::CsvOrder, message, at);
                if let Some(wrong) = self.wrong.last_mut() {
                    wrong.help = Some("the rows of a body stand in the order of their times".to_owned());
                }
                continue;
            }
            values.extend((!further.is_empty()).then(|| {
                let value = |(column, _, (_, factor)): &(usize, String, (ColumnUnit, f64))| {
                    let field = record.get(*column).and_then(|field| field.parse::<f64>().ok());
                    field.filter(|value| value.is_finite()).map_or(f64::NAN, |value| value * factor)
                };
                further.iter().map(value).collect()
            }));
            keys.push(Keyframe {
                time,
                location,
                orientation,
                velocity: speed.flatten(),
                angular_velocity: spin.flatten(),
            });
        }
        if recording.rows.is_empty() && self.wrong.is_empty() {
            let end = text.len();
            self.error(Code::CsvSyntax, "the file has no rows under its header".to_owned(), end..end);
        }
        recording.times = recording.rows.values().flatten().map(|key| key.time).collect();
        recording.times.sort_unstable_by(f64::total_cmp);
        recording.times.dedup();
        self.wrong.is_empty().then_some(recording)
    }

    /// Finds the columns of a vector that a file may lack. Without names, it is left out.
    fn vector(
        &mut self,
        header: &StringRecord,
        start: usize,
        names: &[String],
        of: &str,
        needed: bool,
    ) -> Option<Vec<Column>> {
        if names.is_empty() { None } else { self.columns(header, start, names, of, needed) }
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
        let at = self.fields.field(start, column);
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
        let at = self.fields.field(start, columns[0].0);
        self.error(Code::CsvNumber, "a quaternion of zeros is no orientation".to_owned(), at);
        None
    }

    pub(super) fn error(&mut self, code: Code, message: String, at: Range<usize>) {
        if self.wrong.len() < MAX_REPORTED_MISTAKES {
            self.wrong.push(Wrong { code, message, at, label: String::new(), help: None });
        }
    }
}

/// Returns the columns of a header that are not used, and whose names `is_named` accepts: the index of each, its name, and its unit with the
/// factor that converts to SI.
fn further(
    header: &StringRecord,
    used: &[usize],
    is_named: &dyn Fn(&str) -> bool,
) -> Vec<(usize, String, (ColumnUnit, f64))> {
    let others = header.iter().enumerate().filter(|(column, _)| !used.contains(column));
    let named = others.filter_map(|(column, field)| {
        let (name, unit) = unit_of(field);
        let is_name = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        let converted = || match units::si(unit) {
            Some((si, factor)) => (ColumnUnit { si, unknown: None }, factor),
            None => {
                let unknown = Some(unit.to_owned()).filter(|unit| !unit.is_empty());
                (ColumnUnit { si: "", unknown }, 1.0)
            }
        };
        (is_name && is_named(name)).then(|| (column, name.to_owned(), converted()))
    });
    named.collect()
}
