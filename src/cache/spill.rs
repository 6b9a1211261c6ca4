//! Stores the recorded pages of a run while it is simulated: a few in memory, and more in a file.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use sha2::{Digest, Sha256};

use super::checkpoint::{self, Stopped};
use super::digest::CacheKey;
use super::file::{self, At};
use super::{PARTIAL_RUN_EXTENSION, SAVING_EXTENSION};
use crate::simulate::{Checkpoint, Store};
use crate::system;

/// The size up to which the recorded pages of a run stay in memory, bytes.
const IN_MEMORY: usize = 1 << 20;
/// The disk space that is left free for other programs, bytes. A disk with less free space counts as full.
const MIN_FREE_DISK_BYTES: u64 = 32 << 20;

/// Stores the recorded pages of one run. All clones share the same pages.
#[derive(Clone)]
pub struct Spill(Arc<Shared>);

struct Shared {
    /// The cache folder and the key of a run that may be kept in the cache. `None` for a run that is never kept.
    to_keep: Option<(PathBuf, CacheKey)>,
    inner: Mutex<Inner>,
}

#[derive(Default)]
struct Inner {
    pages: Vec<Page>,
    in_memory: usize,
    /// The files that pages are written to. New pages go to the last file. If its disk is full, another file follows.
    files: Vec<PageFile>,
}

enum Page {
    InMemory(Arc<[u8]>),
    /// The page is in a file: the index of the file, and the position of the page.
    InFile(usize, At),
}

/// A file that the recorded pages of a run are written to.
struct PageFile {
    file: File,
    /// The path of the file. `None` for a nameless temporary file.
    path: Option<PathBuf>,
    end: u64,
}

impl Spill {
    /// Makes a store whose pages go to a nameless file. The file disappears with the process, however the process ends.
    #[must_use]
    pub fn unnamed() -> Spill {
        Spill(Arc::new(Shared { to_keep: None, inner: Mutex::default() }))
    }

    pub(super) fn to_keep(folder: PathBuf, key: CacheKey) -> Spill {
        Spill(Arc::new(Shared { to_keep: Some((folder, key)), inner: Mutex::default() }))
    }

    /// Opens the pages of an interrupted run, with the checkpoint to continue from. `None` if there is no interrupted run.
    pub(super) fn resume(folder: PathBuf, key: CacheKey) -> Option<(Spill, Checkpoint)> {
        let Stopped { part: path, file, pages, checkpoint } = checkpoint::find(&folder, key)?;
        let end = pages.iter().map(|at| at.offset + at.bytes).max().unwrap_or(0);
        let part = PageFile { file, path: Some(path), end: end.max(file::begin(key).len() as u64) };
        let pages = pages.into_iter().map(|at| Page::InFile(0, at)).collect();
        let inner = Mutex::new(Inner { pages, in_memory: 0, files: vec![part] });
        Some((Spill(Arc::new(Shared { to_keep: Some((folder, key)), inner })), checkpoint))
    }

    /// Returns true if the run may be kept in the cache, so that checkpoints can be saved.
    pub(super) fn has_name(&self) -> bool {
        self.0.to_keep.is_some()
    }

    /// Saves a checkpoint of the run. Returns false if the run is never kept, or not all of its pages are in a file of the cache folder.
    pub(super) fn save(&self, checkpoint: &Checkpoint) -> io::Result<bool> {
        let Some((folder, key)) = &self.0.to_keep else { return Ok(false) };
        let inner = &mut *self.inner();
        let Some((path, pages)) = inner.settle(folder, *key)? else { return Ok(false) };
        inner.files[0].has_room(checkpoint.index.len() + checkpoint.simulation.len())?;
        checkpoint::write(&path, *key, &pages, checkpoint)?;
        Ok(true)
    }

    /// Turns the pages into a file of a cached run, with their index. Returns false if the run is never kept, or not all of its pages are
    /// in a file of the cache folder.
    pub(super) fn keep(&self, index: &[u8]) -> io::Result<bool> {
        let Some((folder, key)) = &self.0.to_keep else { return Ok(false) };
        let inner = &mut *self.inner();
        let Some((path, pages)) = inner.settle(folder, *key)? else { return Ok(false) };
        let part = &mut inner.files[0];
        let end = file::end(&pages, index, part.end);
        system::write_all_at(&part.file, &end, part.end)?;
        // An interrupted process may have written pages after its checkpoint. The file is longer then, and is cut off here.
        part.file.set_len(part.end + end.len() as u64)?;
        fs::rename(&path, folder.join(file::name(*key)))?;
        part.path = None;
        // On Windows, a lock keeps other processes from reading.
        let _: io::Result<()> = part.file.unlock();
        // If the checkpoint cannot be removed, the next process removes it.
        let _: io::Result<()> = fs::remove_file(checkpoint::beside(&path));
        Ok(true)
    }

    fn inner(&self) -> MutexGuard<'_, Inner> {
        self.0.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Opens the next file to write to: a file in the cache folder first, and then a nameless one. `files` is the number of files so far.
    /// `None` if no other file would help.
    fn open_next(&self, files: usize) -> Option<io::Result<PageFile>> {
        match (&self.0.to_keep, files) {
            (Some((folder, key)), 0) => Some(PageFile::named(folder, *key).or_else(|_| PageFile::unnamed())),
            (None, 0) | (Some(_), 1) => Some(PageFile::unnamed()),
            _ => None,
        }
    }
}

impl Inner {
    /// Moves all recorded pages into the file in the cache folder. Returns the path of the file and the positions of the pages. `None` if
    /// there is no such file, or the pages are in several files.
    fn settle(&mut self, folder: &Path, key: CacheKey) -> io::Result<Option<(PathBuf, Vec<At>)>> {
        if self.files.is_empty() {
            self.files.push(PageFile::named(folder, key)?);
        }
        let [part] = &mut self.files[..] else { return Ok(None) };
        let Some(path) = part.path.clone() else { return Ok(None) };
        let mut places = Vec::with_capacity(self.pages.len());
        for page in &mut self.pages {
            let at = match page {
                Page::InFile(_, at) => *at,
                Page::InMemory(bytes) => part.append(bytes)?,
            };
            *page = Page::InFile(0, at);
            places.push(at);
        }
        Ok(Some((path, places)))
    }
}

impl Store for Spill {
    fn put(&self, page: &[u8]) -> io::Result<()> {
        let inner = &mut *self.inner();
        if inner.files.is_empty() && inner.in_memory + page.len() <= IN_MEMORY {
            inner.in_memory += page.len();
            inner.pages.push(Page::InMemory(page.into()));
            return Ok(());
        }
        loop {
            let number = inner.files.len();
            let written = inner.files.last_mut().map(|part| part.append(page));
            match written {
                Some(Ok(at)) => {
                    inner.pages.push(Page::InFile(number - 1, at));
                    return Ok(());
                }
                failed => match self.open_next(number) {
                    Some(part) => inner.files.push(part?),
                    None => return Err(failed.and_then(Result::err).unwrap_or_else(full)),
                },
            }
        }
    }

    fn page(&self, number: usize) -> io::Result<Arc<[u8]>> {
        let inner = self.inner();
        match inner.pages.get(number).ok_or_else(file::damaged)? {
            Page::InMemory(bytes) => Ok(Arc::clone(bytes)),
            Page::InFile(part, at) => at.read(&inner.files[*part].file),
        }
    }
}

impl PageFile {
    /// Creates a file in the cache folder. The file is locked as long as it is open.
    fn named(folder: &Path, key: CacheKey) -> io::Result<PageFile> {
        static NUMBER: AtomicU64 = AtomicU64::new(0);
        fs::create_dir_all(folder)?;
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let path = folder
            .join(file::name(key))
            .with_extension(format!("{}-{number}.{PARTIAL_RUN_EXTENSION}", std::process::id()));
        let file = system::open_to_write(&path, true)?;
        file.try_lock().map_err(io::Error::from)?;
        // A killed process may have left a checkpoint, which does not belong to this new run.
        let _: io::Result<()> = fs::remove_file(checkpoint::beside(&path));
        file.set_len(0)?;
        let begin = file::begin(key);
        system::write_all_at(&file, &begin, 0)?;
        Ok(PageFile { file, path: Some(path), end: begin.len() as u64 })
    }

    /// Creates a nameless temporary file.
    fn unnamed() -> io::Result<PageFile> {
        Ok(PageFile { file: tempfile::tempfile_in(system::large_temporary_folder())?, path: None, end: 0 })
    }

    fn has_room(&self, bytes: usize) -> io::Result<()> {
        let folder = self
            .path
            .as_deref()
            .and_then(Path::parent)
            .map_or_else(system::large_temporary_folder, Path::to_owned);
        let free = system::free_bytes(&self.file, &folder)?;
        if free < MIN_FREE_DISK_BYTES + bytes as u64 { Err(full()) } else { Ok(()) }
    }

    fn append(&mut self, page: &[u8]) -> io::Result<At> {
        self.has_room(page.len())?;
        system::write_all_at(&self.file, page, self.end)?;
        let at = At { offset: self.end, bytes: page.len() as u64, digest: Sha256::digest(page).into() };
        self.end += at.bytes;
        Ok(at)
    }
}

impl Drop for PageFile {
    fn drop(&mut self) {
        if let Some(path) = &self.path {
            // The pages were not kept, so their file and the checkpoint are removed.
            let _: io::Result<()> = fs::remove_file(path.with_extension(SAVING_EXTENSION));
            checkpoint::remove(path);
        }
    }
}

fn full() -> io::Error {
    io::Error::new(
        io::ErrorKind::StorageFull,
        format!("`{}` has no room for it", system::large_temporary_folder().display()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_are_read_as_they_were_put_in_memory_and_in_a_file() {
        let spill = Spill::unnamed();
        let pages: Vec<Vec<u8>> = (0..5u8).map(|i| vec![i; 400_000]).collect();
        pages.iter().for_each(|page| spill.put(page).unwrap());
        assert!(matches!(spill.inner().pages[0], Page::InMemory(_)));
        assert!(matches!(spill.inner().pages[4], Page::InFile(0, _)));
        for (number, page) in pages.iter().enumerate().rev() {
            assert_eq!(spill.page(number).unwrap()[..], page[..]);
        }
        assert!(spill.page(5).is_err());
    }
}
