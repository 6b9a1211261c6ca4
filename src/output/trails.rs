//! The files with parts of trails, which scripts share.

use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};

use super::manifest::Entry;
use super::{Folder, OutputError};
use crate::Run;
use crate::simulate::Frame;

/// Writes the files with parts of trails into a folder, each once, whichever thread comes first.
#[derive(Default)]
pub(super) struct TrailFiles {
    begun: Mutex<HashSet<String>>,
    entries: Mutex<Vec<Entry>>,
}

impl TrailFiles {
    /// Writes the files that the script of a frame includes and that do not exist yet.
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

    /// The entries for them in the manifest.
    pub(super) fn into_entries(self) -> Vec<Entry> {
        self.entries.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}
