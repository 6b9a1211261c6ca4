//! What a page needs from the program that it belongs to.

use std::io;
use std::sync::Arc;
use std::time::Duration;

use super::PageRun;
use crate::diagnostic::Report;
use crate::scene::{Options, Scene};
use crate::simulate::{MemoryStore, Moments, Recording, Store};

/// The program that a page belongs to: the server of `jabuka preview`, or a worker in the browser.
pub trait Host: Send + Sync {
    /// Reads the current version of the scene.
    ///
    /// # Errors
    /// If the scene is invalid, or one of its files cannot be read.
    fn read(&self, options: &Options) -> Result<Scene, Report>;

    /// Begins to advance a run, by calling [`RunWork::advance`](super::RunWork::advance) until the run has ended. A run that takes long continues after this function
    /// has returned.
    ///
    /// # Errors
    /// If the system has no room for the run.
    fn start(&self, run: Arc<PageRun>) -> io::Result<()>;

    /// Is called after each change of the session's [`State`](super::State).
    fn changed(&self);

    /// Receives the report on the scene whenever it has changed.
    fn report(&self, report: &Report);

    /// Returns the recording of a run that was simulated before. `None` if there is none.
    fn known(&self, _scene: &Scene, _moments: &Moments) -> Option<Recording> {
        None
    }

    /// Is told that the recording that [`known`](Self::known) has returned is damaged.
    fn forget(&self, _scene: &Scene, _moments: &Moments) {}

    /// Returns the storage for the recording of a new run.
    fn storage(&self, _scene: &Scene, _moments: &Moments) -> Box<dyn RunStorage> {
        Box::new(InMemory)
    }
}

/// The storage for the recording of one run.
pub trait RunStorage: Send {
    /// Returns the store for the pages of the recording.
    fn store(&self) -> Box<dyn Store>;

    /// Is called with the complete recording, and with the time that its simulation took.
    fn complete(&self, _recording: &Recording, _time: Duration) {}
}

/// A storage that keeps a recording in memory, as long as it is needed.
struct InMemory;

impl RunStorage for InMemory {
    fn store(&self) -> Box<dyn Store> {
        Box::<MemoryStore>::default()
    }
}

/// The host of a run that is already recorded, and of tests that need none.
#[cfg(any(test, feature = "render"))]
pub(super) struct NoHost;

#[cfg(any(test, feature = "render"))]
impl Host for NoHost {
    fn read(&self, _options: &Options) -> Result<Scene, Report> {
        Err(Report::default())
    }

    fn start(&self, _run: Arc<PageRun>) -> io::Result<()> {
        Ok(())
    }

    fn changed(&self) {}

    fn report(&self, _report: &Report) {}
}
