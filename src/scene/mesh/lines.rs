//! Reads a text file line by line, counts the lines, and rewrites each line for a parser.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};

/// The maximum length of a line, in bytes. Even a face with hundreds of vertices needs far less.
const MAX_LINE_BYTES: u64 = 1 << 24;

/// The mark that some editors write at the beginning of a text in UTF-8.
pub(super) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Passes the lines of a mesh file, one at a time, to the parser of an external crate (for OBJ or STL). If the parser fails, `number` is
/// the number of the faulty line.
pub(super) struct Lines<'a> {
    file: BufReader<File>,
    /// The number of the current line, or of its first line if it is continued.
    pub(super) number: usize,
    line: Vec<u8>,
    /// The number of bytes of the current line that the parser has consumed.
    used: usize,
    rewrite: Box<Rewrite<'a>>,
    ended: bool,
    /// True if a backslash at the end of a line joins the next line to it.
    is_continued: bool,
    /// The number of line breaks read so far.
    read: usize,
}

/// A function that changes a line before the parser reads it.
type Rewrite<'a> = dyn FnMut(&mut Vec<u8>, LinePosition) + 'a;

/// The position of a line in the file, for the function that rewrites lines.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum LinePosition {
    /// The number of a line in the file, counted from 1.
    Line(usize),
    /// The position after the last line, where a line can be added.
    End,
}

impl<'a> Lines<'a> {
    /// Makes a reader of the lines of a file. `rewrite` receives each line without its line break and may change it. It is called once
    /// more after the last line, to add a line.
    pub(super) fn new(file: File, rewrite: impl FnMut(&mut Vec<u8>, LinePosition) + 'a) -> Lines<'a> {
        let file = BufReader::new(file);
        let rewrite = Box::new(rewrite);
        let line = Vec::new();
        Lines { file, number: 0, line, used: 0, rewrite, ended: false, is_continued: false, read: 0 }
    }

    /// Joins a line that ends with a backslash with the next one, as in OBJ files. A comment ends with its line.
    pub(super) fn with_continuations(self) -> Lines<'a> {
        Lines { is_continued: true, ..self }
    }

    fn advance(&mut self) -> io::Result<()> {
        self.line.clear();
        self.used = 0;
        if self.ended {
            return Ok(());
        }
        self.number = self.read + 1;
        loop {
            let start = self.line.len();
            let most = MAX_LINE_BYTES - start as u64;
            let length = (&mut self.file).take(most).read_until(b'\n', &mut self.line)?;
            if length as u64 == most {
                return Err(io::Error::new(io::ErrorKind::InvalidData, "a line of more than 16 MiB"));
            }
            self.ended = length == 0 && start == 0;
            self.read += usize::from(length > 0);
            if start == 0 && self.read == 1 && self.line.starts_with(BYTE_ORDER_MARK) {
                self.line.drain(..BYTE_ORDER_MARK.len());
            }
            self.line.truncate(start + self.line[start..].trim_ascii_end().len());
            let is_whole = length == 0 || !self.is_continued || !self.line[start..].ends_with(b"\\");
            if is_whole || self.line.contains(&b'#') {
                break;
            }
            self.line.pop();
            self.line.push(b' ');
        }
        self.number = self.number.min(self.read);
        (self.rewrite)(
            &mut self.line,
            if self.ended { LinePosition::End } else { LinePosition::Line(self.number) },
        );
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
    /// Seeks to the beginning of the file, whatever the argument. The parsers seek only to the beginning, after they have detected the
    /// format.
    fn seek(&mut self, _: SeekFrom) -> io::Result<u64> {
        self.file.seek(SeekFrom::Start(0))?;
        (self.number, self.read, self.used, self.ended) = (0, 0, 0, false);
        self.line.clear();
        Ok(0)
    }
}
