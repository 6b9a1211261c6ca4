//! The digest and the length of what is written, without holding it.

use std::io::{self, Write};

use sha2::{Digest, Sha256};

use super::Entry;

/// A writer that counts and digests what goes through it.
pub(super) struct Tallied<W> {
    inner: W,
    hash: Sha256,
    bytes: u64,
}

impl<W: Write> Tallied<W> {
    pub(super) fn new(inner: W) -> Tallied<W> {
        Tallied { inner, hash: Sha256::new(), bytes: 0 }
    }

    /// The entry of the file that has been written.
    pub(super) fn entry(self, frame: Option<usize>, name: String) -> Entry {
        Entry { frame, name, bytes: self.bytes, sha256: self.hash.finalize().into() }
    }
}

impl<W: Write> Write for Tallied<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.hash.update(&bytes[..written]);
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_through_piece_by_piece_has_the_entry_of_the_whole() {
        let mut written = Vec::new();
        let mut tally = Tallied::new(&mut written);
        tally.write_all(b"sphere { 0, ").unwrap();
        tally.write_all(b"1 }").unwrap();
        let entry = tally.entry(Some(3), "frame_0003.pov".to_owned());
        assert_eq!(entry, Entry::of(Some(3), "frame_0003.pov".to_owned(), b"sphere { 0, 1 }"));
        assert_eq!(written, b"sphere { 0, 1 }");
    }
}
