//! Finds the byte ranges of lines and fields in the text of a CSV file, for error messages.

use std::ops::Range;

use csv::{ReaderBuilder, StringRecord, Trim};

use super::columns::{Columns, unit_of};

/// The text of a CSV file, in which byte ranges of fields can be found.
pub(super) struct Fields<'a> {
    pub(super) text: &'a str,
    /// The separator between two fields: a comma, a semicolon or a tab.
    pub(super) delimiter: u8,
}

impl<'a> Fields<'a> {
    pub(super) fn new(text: &'a str) -> Fields<'a> {
        Fields { text, delimiter: delimiter(text) }
    }

    /// Returns a reader of the rows.
    pub(super) fn reader(&self) -> csv::Reader<&'a [u8]> {
        ReaderBuilder::new()
            .delimiter(self.delimiter)
            .comment(Some(b'#'))
            .trim(Trim::All)
            .flexible(true)
            .from_reader(self.text.as_bytes())
    }

    /// Returns the byte range of the field in the column called `name`, in the row with this index among the rows of a body. `None` if the
    /// text has no such field.
    pub(super) fn find(
        &self,
        columns: &Columns,
        body: Option<&str>,
        row: usize,
        name: &str,
    ) -> Option<Range<usize>> {
        let mut csv = self.reader();
        let header = csv.headers().ok()?.clone();
        let called = |name: &str| {
            let is_it =
                |field: &str| field.eq_ignore_ascii_case(name) || unit_of(field).0.eq_ignore_ascii_case(name);
            header.iter().position(is_it)
        };
        let (column, of_body) = (called(name)?, called(&columns.body));
        let is_own = |record: &StringRecord| of_body.and_then(|of_body| record.get(of_body)) == body;
        let record = csv.into_records().filter_map(Result::ok).filter(is_own).nth(row)?;
        let start = usize::try_from(record.position()?.byte()).ok()?;
        Some(self.field(start, column))
    }

    /// Returns the byte range of the first line at or after the byte `start` that is neither empty nor a comment.
    pub(super) fn line(&self, start: usize) -> Range<usize> {
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

    /// Returns the byte range of a field in the record that begins at the byte `start`.
    pub(super) fn field(&self, start: usize, column: usize) -> Range<usize> {
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

/// Guesses the separator between the fields of a CSV file from its first line.
fn delimiter(text: &str) -> u8 {
    let header =
        text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
    let count = |delimiter: char| header.matches(delimiter).count();
    let (best, _) = [(b',', count(',')), (b';', count(';')), (b'\t', count('\t'))]
        .into_iter()
        .fold((b',', 0), |best, next| if next.1 > best.1 { next } else { best });
    best
}
