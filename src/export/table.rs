//! Writes a CSV table (comma-separated values) row by row.

use std::io::{self, Write};

use csv::{Writer, WriterBuilder};

use super::ExportError;

/// A CSV table that is being written. Every number is the shortest text that reads back as the same bits.
pub(super) struct Table<W: Write> {
    csv: Writer<W>,
    rows: usize,
}

impl<W: Write> Table<W> {
    /// Begins a table with a row of column names.
    pub(super) fn new(out: W, header: &[&str]) -> Result<Table<W>, ExportError> {
        let mut csv = WriterBuilder::new().from_writer(out);
        csv.write_record(header).map_err(io::Error::from)?;
        Ok(Table { csv, rows: 0 })
    }

    /// Appends a text to the current row.
    pub(super) fn text(&mut self, text: &str) -> Result<(), ExportError> {
        Ok(self.csv.write_field(text).map_err(io::Error::from)?)
    }

    /// Appends numbers to the current row.
    pub(super) fn numbers(&mut self, numbers: &[f64]) -> Result<(), ExportError> {
        numbers.iter().try_for_each(|number| self.text(&number.to_string()))
    }

    /// Ends the current row. A row with too few or too many fields is an error.
    pub(super) fn end_row(&mut self) -> Result<(), ExportError> {
        self.csv.write_record(None::<&[u8]>).map_err(io::Error::from)?;
        self.rows += 1;
        Ok(())
    }

    /// Writes all buffered rows. Returns the number of rows below the header.
    pub(super) fn finish(mut self) -> Result<usize, ExportError> {
        self.csv.flush()?;
        Ok(self.rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_has_as_many_fields_as_the_header() {
        let mut out = Vec::new();
        let mut table = Table::new(&mut out, &["a", "b"]).unwrap();
        table.text("x, y").unwrap();
        table.numbers(&[0.1 + 0.2]).unwrap();
        table.end_row().unwrap();
        assert_eq!(table.finish().unwrap(), 1);
        assert_eq!(String::from_utf8(out).unwrap(), "a,b\n\"x, y\",0.30000000000000004\n");

        let mut table = Table::new(Vec::new(), &["a", "b"]).unwrap();
        table.text("x").unwrap();
        assert!(table.end_row().is_err());
    }
}
