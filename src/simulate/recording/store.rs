//! Storage for the pages of a recording.

use std::io;
use std::sync::{Arc, Mutex, PoisonError};

/// Stores the pages of a recording, for one writer and any number of readers.
pub trait Store: Send + Sync {
    /// Appends a page. Pages are numbered from 0.
    ///
    /// # Errors
    /// If there is no room for the page.
    fn put(&self, page: &[u8]) -> io::Result<()>;

    /// Returns the page with this number.
    ///
    /// # Errors
    /// If the page cannot be read, or differs from the stored page.
    fn page(&self, number: usize) -> io::Result<Arc<[u8]>>;
}

/// Keeps all pages in memory.
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
