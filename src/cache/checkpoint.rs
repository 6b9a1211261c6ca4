//! The checkpoint of a run that is being simulated, in a file beside that of its pages.
//!
//! A killed run leaves both, and the next process that needs the run goes on from there. New pages are only added after those
//! of the checkpoint, and a checkpoint appears whole or not at all.
//!
//! | what | bytes |
//! | --- | --- |
//! | the name of the format, and the key of the run | 8 + 32 |
//! | the number of pages, the size of the description | 8 + 8 |
//! | of each page: its offset, its size, its digest | 8 + 8 + 32 |
//! | the description of the recording | |
//! | the state of the run | |
//! | the digest of all before | 32 |

use std::fs::{self, File, OpenOptions};
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::digest::Key;
use super::file::{At, ENTRY, damaged};
use super::{PART, SAVING, STOPPED, files};
use crate::simulate::Checkpoint;

const FORMAT: &[u8; 8] = b"jabuka c";
/// The bytes before the table of pages.
const HEAD: usize = 56;

/// The path of the checkpoint for a run whose pages are in a file.
pub(super) fn beside(part: &Path) -> PathBuf {
    part.with_extension(STOPPED)
}

/// Replaces the previous checkpoint.
pub(super) fn write(part: &Path, key: Key, pages: &[At], checkpoint: &Checkpoint) -> io::Result<()> {
    let Checkpoint { index, simulation } = checkpoint;
    let mut bytes = [&FORMAT[..], &key].concat();
    bytes.extend((pages.len() as u64).to_le_bytes());
    bytes.extend((index.len() as u64).to_le_bytes());
    bytes.extend(pages.iter().flat_map(|at| at.to_bytes()));
    bytes.extend_from_slice(index);
    bytes.extend_from_slice(simulation);
    let digest: [u8; 32] = Sha256::digest(&bytes).into();
    bytes.extend(digest);
    let temporary = part.with_extension(SAVING);
    fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, beside(part))).inspect_err(|_| {
        // The next run removes a file that stays.
        let _: io::Result<()> = fs::remove_file(&temporary);
    })
}

/// The pages of a run up to its checkpoint, and the checkpoint.
fn read(part: &Path, key: Key) -> io::Result<(Vec<At>, Checkpoint)> {
    let bytes = fs::read(beside(part))?;
    let (covered, digest) = bytes.split_last_chunk::<32>().ok_or_else(damaged)?;
    let found: [u8; 32] = Sha256::digest(covered).into();
    let (head, rest) = covered.split_first_chunk::<HEAD>().ok_or_else(damaged)?;
    if found != *digest || head[..8] != FORMAT[..] || head[8..40] != key {
        return Err(damaged());
    }
    let number = |at: usize| usize::try_from(u64::from_le_bytes(std::array::from_fn(|i| head[at + i])));
    let (Ok(pages), Ok(size)) = (number(40), number(48)) else { return Err(damaged()) };
    let (table, rest) = rest.split_at_checked(pages.saturating_mul(ENTRY)).ok_or_else(damaged)?;
    let (index, simulation) = rest.split_at_checked(size).ok_or_else(damaged)?;
    let pages = table.as_chunks::<ENTRY>().0.iter().map(At::from_bytes).collect();
    Ok((pages, Checkpoint { index: index.to_owned(), simulation: simulation.to_owned() }))
}

/// A stopped run: its file of pages, which this process has locked, and its checkpoint.
pub(super) struct Stopped {
    pub(super) part: PathBuf,
    pub(super) file: File,
    pub(super) pages: Vec<At>,
    pub(super) checkpoint: Checkpoint,
}

/// Finds, among the stopped runs of a key, the one that got farthest. Runs that another process continues do not count. Damaged
/// ones are removed.
pub(super) fn find(folder: &Path, key: Key) -> Option<Stopped> {
    let name = super::file::name(key);
    let stem = Path::new(&name).file_stem()?.to_str()?;
    let mut farthest: Option<Stopped> = None;
    for found in files(folder, STOPPED).ok()? {
        let of_key =
            found.path.file_name().and_then(|name| name.to_str()?.strip_prefix(stem)?.strip_prefix('.'));
        if of_key.is_none() {
            continue;
        }
        let part = found.path.with_extension(PART);
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

/// Opens the pages of a stopped run; none if another process has them, or they are gone.
pub(super) fn lock(part: &Path) -> Option<File> {
    let file = OpenOptions::new().read(true).write(true).open(part).ok()?;
    file.try_lock().ok()?;
    // The previous owner of the lock may have removed or renamed the file since it was opened.
    let is_same = fs::metadata(part).ok()?.ino() == file.metadata().ok()?.ino();
    is_same.then_some(file)
}

/// Removes the pages of a run and its checkpoint. The next run removes leftovers.
pub(super) fn remove(part: &Path) {
    let _: io::Result<()> = fs::remove_file(beside(part));
    let _: io::Result<()> = fs::remove_file(part);
}
