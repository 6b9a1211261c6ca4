//! Reads a text file line by line, counts the lines, and rewrites each line for a parser.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};

/// The maximum length of a line, bytes. A face with some hundred vertices is far shorter.
const LONGEST: u64 = 1 << 24;

/// Feeds the lines of a mesh file to the parser of an external crate (for OBJ or STL), one at a time. If the parser
/// fails, `number` is the number of the faulty line.
pub(super) struct Lines<'a> {
    file: BufReader<File>,
    /// The number of lines read so far.
    pub(super) number: usize,
    line: Vec<u8>,
    /// The number of bytes of the line that have been handed out.
    used: usize,
    rewrite: Box<Rewrite<'a>>,
    ended: bool,
}

/// A function that rewrites a line for the parser.
type Rewrite<'a> = dyn FnMut(&mut Vec<u8>, Place) + 'a;

/// A place in the file.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Place {
    /// A line of the file, counted from 1.
    Line(usize),
    /// After the last line.
    End,
}

impl<'a> Lines<'a> {
    /// Reads the lines of a file, without their line breaks. `rewrite` may change each line, and may add a line at
    /// the end.
    pub(super) fn new(file: File, rewrite: impl FnMut(&mut Vec<u8>, Place) + 'a) -> Lines<'a> {
        let file = BufReader::new(file);
        let rewrite = Box::new(rewrite);
        Lines { file, number: 0, line: Vec::new(), used: 0, rewrite, ended: false }
    }

    fn advance(&mut self) -> io::Result<()> {
        self.line.clear();
        self.used = 0;
        if self.ended {
            return Ok(());
        }
        let length = (&mut self.file).take(LONGEST).read_until(b'\n', &mut self.line)?;
        if length as u64 == LONGEST {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "a line of more than 16 MiB"));
        }
        self.ended = length == 0;
        self.number += usize::from(!self.ended);
        self.line.truncate(self.line.trim_ascii_end().len());
        (self.rewrite)(&mut self.line, if self.ended { Place::End } else { Place::Line(self.number) });
        if !self.ended || !self.line.is_empty() {
            self.line.push(b'\n');
        }
        Ok(())
    }
}

impl BufRead for Lines<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.used == self.line.len() {
            self.advance()?;
        }
        Ok(&self.line[self.used..])
    }

    fn consume(&mut self, amount: usize) {
        self.used = (self.used + amount).min(self.line.len());
    }
}

impl Read for Lines<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let line = self.fill_buf()?;
        let length = line.len().min(buffer.len());
        buffer[..length].copy_from_slice(&line[..length]);
        self.consume(length);
        Ok(length)
    }
}

impl Seek for Lines<'_> {
    /// Goes back to the beginning for any argument. Parsers seek only there, once they know the format.
    fn seek(&mut self, _: SeekFrom) -> io::Result<u64> {
        self.file.seek(SeekFrom::Start(0))?;
        (self.number, self.used, self.ended) = (0, 0, false);
        self.line.clear();
        Ok(0)
    }
}
