//! The further columns of trajectory files, such as `epot`, which formulas of measures can name.

use std::sync::Arc;

/// A column of a trajectory file, for one body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileColumn {
    /// The times of the rows, s, in ascending order.
    pub times: Arc<[f64]>,
    /// The values in these rows, in the unit of the column. NaN where the file has no number.
    pub values: Arc<[f64]>,
}

/// The further columns of the trajectory files of a scene that formulas can name.
#[derive(Clone, Debug, Default)]
pub struct FileColumns {
    /// The name of each column, and its unit. Columns of one name in files with other units are different columns.
    names: Vec<(String, ColumnUnit)>,
    /// The columns of bodies, each with the index of its body in the scene and that of its name, in ascending order.
    columns: Vec<([usize; 2], FileColumn)>,
}

/// The unit of a further column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnUnit {
    /// The symbol of the SI unit that the values are converted to. Empty for a pure number and for an unknown unit.
    pub si: &'static str,
    /// The symbol of an unknown unit, whose values are not converted.
    pub unknown: Option<String>,
}

impl FileColumns {
    /// Adds a column of a body, given by its index in the scene.
    pub(super) fn add(&mut self, body: usize, name: &str, unit: &ColumnUnit, column: FileColumn) {
        let known = self.names.iter().position(|(known, its)| known == name && its == unit);
        let number = known.unwrap_or_else(|| {
            self.names.push((name.to_owned(), unit.clone()));
            self.names.len() - 1
        });
        let place = self.columns.partition_point(|(key, _)| *key < [body, number]);
        self.columns.insert(place, ([body, number], column));
    }

    /// Returns the names of the columns of a body, or of all bodies.
    pub(super) fn names(&self, body: Option<usize>) -> impl Iterator<Item = (usize, &str)> {
        let names = self.names.iter().enumerate().map(|(number, (name, _))| (number, name.as_str()));
        names.filter(move |(number, _)| body.is_none_or(|body| self.of(body, *number).is_some()))
    }

    /// Returns the symbol of the unit of a column. It is empty for a pure number and for an unknown unit.
    pub(super) fn unit(&self, number: usize) -> &'static str {
        self.names[number].1.si
    }

    fn of(&self, body: usize, number: usize) -> Option<&FileColumn> {
        let place = self.columns.binary_search_by_key(&[body, number], |(key, _)| *key).ok()?;
        Some(&self.columns[place].1)
    }

    /// Returns the value in a column of a body at a time (s): between two rows on the straight line, before the first and after the last row
    /// that of this row. NaN if the body has no such column.
    pub(crate) fn value(&self, body: usize, number: usize, time: f64) -> f64 {
        let Some(FileColumn { times, values }) = self.of(body, number) else { return f64::NAN };
        let after = times.partition_point(|known| *known < time);
        let before = after.saturating_sub(1);
        let (Some(first), Some(&last)) = (values.get(before), values.last()) else { return f64::NAN };
        let Some(second) = values.get(after) else { return last };
        let span = times[after] - times[before];
        let part = if span > 0.0 { (time - times[before]) / span } else { 0.0 };
        // At a row, a neighbor without a number does not count.
        if part <= 0.0 {
            *first
        } else if part >= 1.0 {
            *second
        } else {
            first + part * (second - first)
        }
    }
}
