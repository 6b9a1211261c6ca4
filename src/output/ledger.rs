//! Stores the sizes and digests of written scripts until the manifest lists them.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The largest number of scripts whose records are kept in memory. For more scripts, all records go to an unnamed file, so that memory
/// does not grow with the number of frames.
const IN_MEMORY: usize = 16_384;

/// A script's length in bytes (8 bytes, little-endian) and its SHA-256 (32 bytes).
type Record = [u8; 40];

/// The sizes and digests of scripts by number. Any thread can record them in any order.
pub(super) struct Ledger(Mutex<Records>);

enum Records {
    Memory(Vec<Record>),
    File(File),
}

impl Ledger {
    /// Makes an empty ledger for this many scripts.
    pub(super) fn new(scripts: usize) -> io::Result<Ledger> {
        let is_small = scripts <= IN_MEMORY;
        let records = if is_small {
            Records::Memory(vec![[0; 40]; scripts])
        } else {
            Records::File(tempfile::tempfile()?)
        };
        Ok(Ledger(Mutex::new(records)))
    }

    /// Records the length and the SHA-256 of the script with this number.
    pub(super) fn put(&self, number: usize, bytes: u64, sha256: [u8; 32]) -> io::Result<()> {
        let mut record = [0; 40];
        record[..8].copy_from_slice(&bytes.to_le_bytes());
        record[8..].copy_from_slice(&sha256);
        match &mut *self.lock() {
            Records::Memory(records) => records[number] = record,
            Records::File(file) => {
                file.seek(place(number))?;
                file.write_all(&record)?;
            }
        }
        Ok(())
    }

    /// Returns the length in bytes and the SHA-256 of the script with this number.
    pub(super) fn get(&self, number: usize) -> io::Result<(u64, [u8; 32])> {
        let mut record = [0; 40];
        match &mut *self.lock() {
            Records::Memory(records) => record = records[number],
            Records::File(file) => {
                file.seek(place(number))?;
                file.read_exact(&mut record)?;
            }
        }
        let (mut bytes, mut sha256) = ([0; 8], [0; 32]);
        bytes.copy_from_slice(&record[..8]);
        sha256.copy_from_slice(&record[8..]);
        Ok((u64::from_le_bytes(bytes), sha256))
    }

    fn lock(&self) -> MutexGuard<'_, Records> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn place(number: usize) -> SeekFrom {
    SeekFrom::Start(40 * number as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_noted_in_any_order_is_read() {
        for scripts in [10, IN_MEMORY + 10] {
            let ledger = Ledger::new(scripts).unwrap();
            let of = |number: usize| (number as u64 * 7, [number as u8; 32]);
            for number in (0..10).rev() {
                ledger.put(number, of(number).0, of(number).1).unwrap();
            }
            assert!((0..10).all(|number| ledger.get(number).unwrap() == of(number)), "{scripts}");
        }
    }
}
