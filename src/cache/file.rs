//! Reads and writes the file of a cached run.
//!
//! | contents | bytes |
//! | --- | --- |
//! | the name of the format, and the key of the run | 8 + 32 |
//! | the pages of the recording, in any order | |
//! | for each page: its offset, its size, its digest | 8 + 8 + 32 |
//! | the index of the recording | |
//! | the number of pages; the offset of the table of pages; the digest of all bytes from this table on | 8 + 8 + 32 |

use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::SystemTime;

use sha2::{Digest, Sha256};

use super::RUN_EXTENSION;
use super::digest::CacheKey;
use crate::simulate::{Counts, Recording, Store};
use crate::system;

/// The first bytes of every file with a cached run.
const FILE_SIGNATURE: &[u8; 8] = b"jabuka 1";
/// The size of a page's entry in the table of pages, bytes: its offset, its size, and its digest.
pub(super) const PAGE_ENTRY_BYTES: usize = 48;
/// The size of the data at the end of the file, bytes: the number of pages, the offset of the table of pages, and a digest.
const FOOTER_BYTES: usize = 48;
/// The largest size of a page that is read, bytes. A page holds about 1 MB, or a single moment of all bodies if that is larger.
const MAX_PAGE_BYTES: u64 = 4 << 30;

/// The position of a page in a file: offset and size in bytes, and the digest of the page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct At {
    pub(super) offset: u64,
    pub(super) bytes: u64,
    pub(super) digest: [u8; 32],
}

impl At {
    /// Reads the page. Fails if its bytes do not have the digest.
    pub(super) fn read(&self, file: &File) -> io::Result<Arc<[u8]>> {
        let size = usize::try_from(self.bytes.min(MAX_PAGE_BYTES)).map_err(|_| damaged())?;
        let mut bytes = vec![0; size];
        system::read_exact_at(file, &mut bytes, self.offset)?;
        let digest: [u8; 32] = Sha256::digest(&bytes).into();
        if digest == self.digest { Ok(bytes.into()) } else { Err(damaged()) }
    }

    pub(super) fn to_bytes(self) -> [u8; PAGE_ENTRY_BYTES] {
        let mut bytes = [0; PAGE_ENTRY_BYTES];
        bytes[..8].copy_from_slice(&self.offset.to_le_bytes());
        bytes[8..16].copy_from_slice(&self.bytes.to_le_bytes());
        bytes[16..].copy_from_slice(&self.digest);
        bytes
    }

    pub(super) fn from_bytes(bytes: &[u8; PAGE_ENTRY_BYTES]) -> At {
        let number = |at: usize| u64::from_le_bytes(std::array::from_fn(|i| bytes[at + i]));
        At { offset: number(0), bytes: number(8), digest: std::array::from_fn(|i| bytes[16 + i]) }
    }
}

/// Returns the file name of a cached run.
pub(super) fn name(key: CacheKey) -> String {
    let hex: String = key.iter().take(16).map(|byte| format!("{byte:02x}")).collect();
    format!("{hex}.{RUN_EXTENSION}")
}

/// Returns the bytes of the file before the pages.
pub(super) fn begin(key: CacheKey) -> Vec<u8> {
    [&FILE_SIGNATURE[..], &key].concat()
}

/// Returns the bytes of the file after the pages. `offset` is the end of the last page.
pub(super) fn end(pages: &[At], index: &[u8], offset: u64) -> Vec<u8> {
    let mut bytes: Vec<u8> = pages.iter().flat_map(|at| at.to_bytes()).collect();
    bytes.extend_from_slice(index);
    bytes.extend((pages.len() as u64).to_le_bytes());
    bytes.extend(offset.to_le_bytes());
    let digest: [u8; 32] = Sha256::digest(&bytes).into();
    bytes.extend(digest);
    bytes
}

/// Opens the cached run with this key, and sets the file's modification time, which counts as the time of its last use.
pub(super) fn open(path: &Path, key: CacheKey, counts: Counts) -> io::Result<Recording> {
    let file = system::open(path)?;
    let length = file.metadata()?.len();
    let mut head = [0; 40];
    system::read_exact_at(&file, &mut head, 0)?;
    if head[..8] != FILE_SIGNATURE[..] || head[8..] != key {
        return Err(damaged());
    }
    let mut tail = [0; FOOTER_BYTES];
    system::read_exact_at(&file, &mut tail, length.checked_sub(FOOTER_BYTES as u64).ok_or_else(damaged)?)?;
    let number = |at: usize| u64::from_le_bytes(std::array::from_fn(|i| tail[at + i]));
    let (pages, begin) = (number(0), number(8));
    let size = length.checked_sub(begin).filter(|size| *size >= FOOTER_BYTES as u64).ok_or_else(damaged)?;
    let mut bytes = vec![0; usize::try_from(size).map_err(|_| damaged())?];
    system::read_exact_at(&file, &mut bytes, begin)?;
    let (covered, digest) = bytes.split_at(bytes.len() - 32);
    let found: [u8; 32] = Sha256::digest(covered).into();
    if found[..] != *digest {
        return Err(damaged());
    }
    let table = usize::try_from(pages)
        .ok()
        .and_then(|pages| pages.checked_mul(PAGE_ENTRY_BYTES))
        .ok_or_else(damaged)?;
    let described = covered.get(..covered.len() - 16).ok_or_else(damaged)?;
    let (table, index) = described.split_at_checked(table).ok_or_else(damaged)?;
    let pages = table.as_chunks::<PAGE_ENTRY_BYTES>().0.iter().map(At::from_bytes).collect();
    // If the modification time cannot be set, the run seems to have been unused for longer than it really was.
    let _: io::Result<()> = file.set_modified(SystemTime::now());
    Recording::with_index(counts, index, Box::new(Kept { file, pages }))
}

/// The pages of a cached run, which are read from its file on demand.
struct Kept {
    file: File,
    pages: Vec<At>,
}

impl Store for Kept {
    fn put(&self, _: &[u8]) -> io::Result<()> {
        Err(io::Error::new(io::ErrorKind::ReadOnlyFilesystem, "a run that is kept does not grow"))
    }

    fn page(&self, number: usize) -> io::Result<Arc<[u8]>> {
        self.pages.get(number).ok_or_else(damaged)?.read(&self.file)
    }
}

pub(super) fn damaged() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "the recording of the run is damaged")
}
