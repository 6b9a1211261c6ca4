//! The digest and the length of a file, computed while it is written.

use std::fs::File;
use std::io;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::Entry;

/// Counts and digests the pieces of a file.
#[derive(Default)]
pub(super) struct Tally {
    hash: Sha256,
    bytes: u64,
}

impl Tally {
    /// Counts a piece.
    pub(super) fn add(&mut self, piece: &[u8]) {
        self.hash.update(piece);
        self.bytes += piece.len() as u64;
    }

    /// The file at a path.
    pub(super) fn of_file(path: &Path) -> io::Result<Tally> {
        let mut tally = Tally::default();
        io::copy(&mut File::open(path)?, &mut tally)?;
        Ok(tally)
    }

    /// The entry of the file that consists of the pieces.
    pub(super) fn entry(self, frame: Option<usize>, name: String) -> Entry {
        Entry { frame, name, bytes: self.bytes, sha256: self.hash.finalize().into() }
    }
}

impl io::Write for Tally {
    fn write(&mut self, piece: &[u8]) -> io::Result<usize> {
        self.add(piece);
        Ok(piece.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_entry_of_the_pieces_is_that_of_the_whole() {
        let mut tally = Tally::default();
        tally.add(b"sphere { 0, ");
        tally.add(b"1 }");
        let entry = tally.entry(Some(3), "frame_0003.pov".to_owned());
        assert_eq!(entry, Entry::of(Some(3), "frame_0003.pov".to_owned(), b"sphere { 0, 1 }"));
    }
}
