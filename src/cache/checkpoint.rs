//! Saves checkpoints of a run that is being simulated, in a file beside the file of the run's recorded pages.
//!
//! A killed process leaves both files, and the next process that needs the run continues from the checkpoint. New pages are only added
//! after those of the checkpoint. A checkpoint is written under a temporary name and renamed when it is complete.
//!
//! | contents | bytes |
//! | --- | --- |
//! | the name of the format, and the key of the run | 8 + 32 |
//! | the number of pages, the size of the recording's index | 8 + 8 |
//! | for each page: its offset, its size, its digest | 8 + 8 + 32 |
//! | the index of the recording | |
//! | the state of the simulation | |
//! | the digest of all bytes before | 32 |

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::digest::CacheKey;
use super::file::{At, PAGE_ENTRY_BYTES, damaged};
use super::{CHECKPOINT_EXTENSION, PARTIAL_RUN_EXTENSION, SAVING_EXTENSION, files};
use crate::simulate::Checkpoint;
use crate::system::{self, FileId};

/// The first bytes of every checkpoint.
const FILE_SIGNATURE: &[u8; 8] = b"jabuka c";
/// The size of the header before the table of pages, bytes: signature, key, number of pages, and size of the index.
const HEADER_BYTES: usize = 56;

/// Returns the path of the checkpoint that belongs to a file of pages.
pub(super) fn beside(part: &Path) -> PathBuf {
    part.with_extension(CHECKPOINT_EXTENSION)
}

/// Writes a checkpoint, which replaces the previous one of the same run.
pub(super) fn write(part: &Path, key: CacheKey, pages: &[At], checkpoint: &Checkpoint) -> io::Result<()> {
    let Checkpoint { index, simulation } = checkpoint;
    let mut bytes = [&FILE_SIGNATURE[..], &key].concat();
    bytes.extend((pages.len() as u64).to_le_bytes());
    bytes.extend((index.len() as u64).to_le_bytes());
    bytes.extend(pages.iter().flat_map(|at| at.to_bytes()));
    bytes.extend_from_slice(index);
    bytes.extend_from_slice(simulation);
    let digest: [u8; 32] = Sha256::digest(&bytes).into();
    bytes.extend(digest);
    let temporary = part.with_extension(SAVING_EXTENSION);
    let written = system::create(&temporary).and_then(|mut file| file.write_all(&bytes));
    written.and_then(|()| fs::rename(&temporary, beside(part))).inspect_err(|_| {
        // If the file cannot be removed, the next process removes it.
        let _: io::Result<()> = fs::remove_file(&temporary);
    })
}

/// Reads a checkpoint. Returns the positions of the pages up to the checkpoint, and the state of the simulation.
fn read(part: &Path, key: CacheKey) -> io::Result<(Vec<At>, Checkpoint)> {
    let bytes = system::read(&beside(part))?;
    let (covered, digest) = bytes.split_last_chunk::<32>().ok_or_else(damaged)?;
    let found: [u8; 32] = Sha256::digest(covered).into();
    let (head, rest) = covered.split_first_chunk::<HEADER_BYTES>().ok_or_else(damaged)?;
    if found != *digest || head[..8] != FILE_SIGNATURE[..] || head[8..40] != key {
        return Err(damaged());
    }
    let number = |at: usize| usize::try_from(u64::from_le_bytes(std::array::from_fn(|i| head[at + i])));
    let (Ok(pages), Ok(size)) = (number(40), number(48)) else { return Err(damaged()) };
    let (table, rest) = rest.split_at_checked(pages.saturating_mul(PAGE_ENTRY_BYTES)).ok_or_else(damaged)?;
    let (index, simulation) = rest.split_at_checked(size).ok_or_else(damaged)?;
    let pages = table.as_chunks::<PAGE_ENTRY_BYTES>().0.iter().map(At::from_bytes).collect();
    Ok((pages, Checkpoint { index: index.to_owned(), simulation: simulation.to_owned() }))
}

/// An interrupted run: the path of its file of pages, the open file (locked by this process), the positions of the pages, and the
/// checkpoint.
pub(super) struct Stopped {
    pub(super) part: PathBuf,
    pub(super) file: File,
    pub(super) pages: Vec<At>,
    pub(super) checkpoint: Checkpoint,
}

/// Finds the interrupted run with this key that has progressed farthest. Runs that another process continues are skipped. Damaged runs are
/// removed.
pub(super) fn find(folder: &Path, key: CacheKey) -> Option<Stopped> {
    let name = super::file::name(key);
    let stem = Path::new(&name).file_stem()?.to_str()?;
    let mut farthest: Option<Stopped> = None;
    for found in files(folder, CHECKPOINT_EXTENSION).ok()? {
        let of_key =
            found.path.file_name().and_then(|name| name.to_str()?.strip_prefix(stem)?.strip_prefix('.'));
        if of_key.is_none() {
            continue;
        }
        let part = found.path.with_extension(PARTIAL_RUN_EXTENSION);
        let Some(file) = lock(&part) else { continue };
        match read(&part, key) {
            Ok((pages, checkpoint)) => {
                let is_farther = |other: &Stopped| checkpoint.index.len() > other.checkpoint.index.len();
                if farthest.as_ref().is_none_or(is_farther) {
                    farthest = Some(Stopped { part, file, pages, checkpoint });
                }
            }
            Err(_) => remove(&part),
        }
    }
    farthest
}

/// Opens and locks the file of pages of an interrupted run. `None` if another process has locked the file, or if it has disappeared.
pub(super) fn lock(part: &Path) -> Option<File> {
    let file = system::open_to_write(part, false).ok()?;
    file.try_lock().ok()?;
    // The previous owner of the lock may have removed or renamed the file after it was opened.
    let is_same = FileId::of_name(part).ok()? == FileId::of(&file).ok()?;
    is_same.then_some(file)
}

/// Removes the pages of a run and its checkpoint. If this fails, the next process removes them.
pub(super) fn remove(part: &Path) {
    let _: io::Result<()> = fs::remove_file(beside(part));
    let _: io::Result<()> = fs::remove_file(part);
}
