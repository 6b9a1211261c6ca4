//! Storage for the pages of a recording.

use std::io;
use std::sync::{Arc, Mutex, PoisonError};

/// Stores the pages of a recording: one writer, any number of readers.
pub trait Store: Send + Sync {
    /// Adds a page; pages are numbered from 0.
    ///
    /// # Errors
    /// If there is no room for it.
    fn put(&self, page: &[u8]) -> io::Result<()>;

    /// The page with a number.
    ///
    /// # Errors
    /// If it cannot be read, or is not what was stored.
    fn page(&self, number: usize) -> io::Result<Arc<[u8]>>;
}

/// Any number of pages in memory.
#[derive(Default)]
pub struct MemoryStore(Mutex<Vec<Arc<[u8]>>>);

impl Store for MemoryStore {
    fn put(&self, page: &[u8]) -> io::Result<()> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(page.into());
        Ok(())
    }

    fn page(&self, number: usize) -> io::Result<Arc<[u8]>> {
        let pages = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        pages.get(number).cloned().ok_or_else(super::codec::damaged)
    }
}
