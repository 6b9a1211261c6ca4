//! Computes the digest and the length of a file while it is written or read.

use std::io::{self, Read};

use sha2::{Digest, Sha256};

use super::Entry;

/// Computes the SHA-256 and the length of a file from its pieces.
#[derive(Default)]
pub(super) struct DigestWriter {
    hash: Sha256,
    bytes: u64,
}

impl DigestWriter {
    /// Adds the next piece of the file.
    pub(super) fn add(&mut self, piece: &[u8]) {
        self.hash.update(piece);
        self.bytes += piece.len() as u64;
    }

    /// Reads contents to their end.
    pub(super) fn of(mut contents: impl Read) -> io::Result<DigestWriter> {
        let mut writer = DigestWriter::default();
        io::copy(&mut contents, &mut writer)?;
        Ok(writer)
    }

    /// Makes the manifest entry of the file that consists of all added pieces.
    pub(super) fn entry(self, frame: Option<usize>, name: String) -> Entry {
        Entry { frame, name, bytes: self.bytes, sha256: self.hash.finalize().into() }
    }
}

impl io::Write for DigestWriter {
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
        let mut writer = DigestWriter::default();
        writer.add(b"sphere { 0, ");
        writer.add(b"1 }");
        let entry = writer.entry(Some(3), "frame_0003.pov".to_owned());
        assert_eq!(entry, Entry::of(Some(3), "frame_0003.pov".to_owned(), b"sphere { 0, 1 }"));
    }
}
