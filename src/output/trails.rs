//! Writes the include files that hold parts of trails. Several scripts share each of these files.

use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};

use super::manifest::Entry;
use super::{Folder, OutputError};
use crate::Run;
use crate::simulate::Frame;

/// Writes each include file with a part of a trail only once, although several threads may need it.
#[derive(Default)]
pub(super) struct TrailFiles {
    begun: Mutex<HashSet<String>>,
    entries: Mutex<Vec<Entry>>,
}

impl TrailFiles {
    /// Writes the trail files that the script of a frame includes, except those that were written before.
    pub(super) fn put(&self, run: &Run<'_>, folder: &Folder, frame: &Frame) -> Result<(), OutputError> {
        let is_begun =
            |name: &str| !self.begun.lock().unwrap_or_else(PoisonError::into_inner).insert(name.to_owned());
        for file in run.emitter().trail_files(frame, &is_begun) {
            folder.write(&file.name, file.text.as_bytes())?;
            let entry = Entry::of(None, file.name, file.text.as_bytes());
            self.entries.lock().unwrap_or_else(PoisonError::into_inner).push(entry);
        }
        Ok(())
    }

    /// Returns the manifest entries of all written trail files.
    pub(super) fn into_entries(self) -> Vec<Entry> {
        self.entries.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}
