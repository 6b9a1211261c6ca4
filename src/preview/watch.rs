//! Detects changes in the files of a scene.
//!
//! The files are checked at regular intervals, without notifications from the system. So changes are also found in files on a network, in
//! files that an editor replaces, and in files that do not exist yet.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use crate::system::FileId;

/// The interval between two checks of the files.
pub(super) const POLL_INTERVAL: Duration = Duration::from_millis(60);

/// The size, identity and modification time of a file, which show whether it has changed. `None` if the file does not exist.
type Mark = Option<(u64, FileId, SystemTime)>;

/// The files of a scene, each with its size, identity and modification time when it was last read.
pub(super) struct Watched(Vec<(PathBuf, Mark)>);

impl Watched {
    /// Records the current sizes, identities and times of the files. It must be called before the files are read, so that no change is missed.
    pub(super) fn new(files: &[PathBuf]) -> Watched {
        Watched(files.iter().map(|file| (file.clone(), mark(file))).collect())
    }

    /// Adds files that are not watched yet, with their current sizes, identities and times.
    pub(super) fn add(&mut self, files: &[PathBuf]) {
        let new = files.iter().filter(|file| !self.0.iter().any(|(known, _)| known == *file));
        let new: Vec<_> = new.map(|file| (file.clone(), mark(file))).collect();
        self.0.extend(new);
    }

    /// Returns the paths of the watched files.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        self.0.iter().map(|(file, _)| file.clone()).collect()
    }

    /// Returns true if a file has changed since it was recorded.
    pub(super) fn have_changed(&self) -> bool {
        self.0.iter().any(|(file, before)| mark(file) != *before)
    }

    /// Waits until the files stop changing and none is empty, for at most 0.3 s. An editor may empty a file before it writes the new text.
    pub(super) fn settle(&self) {
        /// The time in which the files must not change.
        const SETTLE_INTERVAL: Duration = Duration::from_millis(20);
        /// The largest number of checks. Together with the interval, it gives the limit of 0.3 s.
        const MAX_SETTLE_CHECKS: u32 = 15;
        let marks = || self.0.iter().map(|(file, _)| mark(file)).collect::<Vec<Mark>>();
        let mut before = marks();
        for _ in 0..MAX_SETTLE_CHECKS {
            std::thread::sleep(SETTLE_INTERVAL);
            let now = marks();
            let is_empty = now.iter().flatten().any(|(bytes, ..)| *bytes == 0);
            if now == before && !is_empty {
                return;
            }
            before = now;
        }
    }

    /// Returns true if a file was changed so recently that a further change might leave the same size and time.
    pub(super) fn are_young(&self) -> bool {
        /// The age from which on the size and the time of a file show every further change.
        const MIN_RELIABLE_AGE: Duration = Duration::from_millis(50);
        let is_young = |mark: &Mark| {
            mark.and_then(|(.., changed)| changed.elapsed().ok()).is_some_and(|age| age < MIN_RELIABLE_AGE)
        };
        self.0.iter().any(|(_, mark)| is_young(mark))
    }
}

fn mark(file: &Path) -> Mark {
    let metadata = fs::metadata(file).ok()?;
    Some((metadata.len(), FileId::of_path(file).ok()?, metadata.modified().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_come_go_grow_and_are_replaced_have_changed() {
        let folder = tempfile::tempdir().unwrap();
        let (file, other) = (folder.path().join("a.toml"), folder.path().join("b.toml"));
        let watched = |change: &dyn Fn()| {
            let watched = Watched::new(&[file.clone(), other.clone()]);
            assert!(!watched.have_changed());
            change();
            watched.have_changed()
        };
        assert!(watched(&|| fs::write(&file, "1").unwrap()));
        assert!(watched(&|| fs::write(&file, "12").unwrap()));
        assert!(watched(&|| fs::copy(&file, &other).map(drop).unwrap()));
        assert!(watched(&|| fs::rename(&other, &file).unwrap()));
        assert!(watched(&|| fs::remove_file(&file).unwrap()));
        assert!(!watched(&|| {}));
    }

    #[test]
    fn a_file_that_has_just_been_emptied_is_waited_for() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.toml");
        fs::write(&file, "").unwrap();
        let watched = Watched::new(std::slice::from_ref(&file));
        let written = std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(Duration::from_millis(50));
                fs::write(&file, "title = 'whole'").unwrap();
            });
            watched.settle();
            fs::read_to_string(&file).unwrap()
        });
        assert_eq!(written, "title = 'whole'");
    }
}
