//! The server as the host of a page: it reads the scene from its file, and simulates runs in threads.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use tokio::sync::watch;

use crate::Scene;
use crate::cache::{Cache, Spill};
use crate::diagnostic::Report;
use crate::page::{Host, PageRun, RunStorage};
use crate::scene::Options;
use crate::simulate::{Moments, Recording, Store};

/// A function that reads a scene.
type Reader = dyn Fn(&Options) -> Result<Scene, Report> + Send + Sync;

/// The server of a page.
pub(super) struct ServerHost {
    reader: Box<Reader>,
    cache: Cache,
    /// A counter that increases with each change of the session. Its receivers are notified of each change.
    pulse: watch::Sender<u64>,
    said: Box<dyn Fn(&Report) + Send + Sync>,
}

/// The smallest interval between two notifications about new frames.
const MIN_NOTIFICATION_INTERVAL: Duration = Duration::from_millis(40);

/// The time that a new run has to finish before the page shows it unfinished: a run that has no look before, and one that has.
const MAX_WAIT_FOR_RUN: [Duration; 2] = [Duration::from_millis(150), Duration::from_millis(25)];

impl ServerHost {
    /// Makes a host that reads the scene from a file. `said` receives the reports for the terminal.
    pub(super) fn new(
        path: PathBuf,
        cache: Cache,
        said: impl Fn(&Report) + Send + Sync + 'static,
    ) -> Arc<ServerHost> {
        ServerHost::with_reader(cache, said, move |options| Scene::from_path_with(&path, options))
    }

    /// Makes a host that reads the scene with the given function.
    pub(super) fn with_reader(
        cache: Cache,
        said: impl Fn(&Report) + Send + Sync + 'static,
        reader: impl Fn(&Options) -> Result<Scene, Report> + Send + Sync + 'static,
    ) -> Arc<ServerHost> {
        let (reader, pulse, said) = (Box::new(reader), watch::Sender::new(0), Box::new(said));
        Arc::new(ServerHost { reader, cache, pulse, said })
    }

    /// Returns a receiver of the counter, which is notified of each change.
    pub(super) fn pulse(&self) -> watch::Receiver<u64> {
        self.pulse.subscribe()
    }
}

impl Host for ServerHost {
    fn read(&self, options: &Options) -> Result<Scene, Report> {
        (self.reader)(options)
    }

    /// Starts a thread for the run. A run that finishes almost at once is waited for, so that it is not shown unfinished.
    fn start(&self, run: Arc<PageRun>) -> io::Result<()> {
        let (pulse, its_run) = (self.pulse.clone(), Arc::clone(&run));
        thread::Builder::new().name("run".to_owned()).spawn(move || {
            let (mut work, mut told) = (its_run.work(), Instant::now());
            while work.advance() {
                if told.elapsed() > MIN_NOTIFICATION_INTERVAL {
                    pulse.send_modify(|count| *count += 1);
                    told = Instant::now();
                }
            }
            pulse.send_modify(|count| *count += 1);
        })?;
        let (begun, wait) = (Instant::now(), MAX_WAIT_FOR_RUN[usize::from(run.look().is_some())]);
        while run.outcome().is_none() && begun.elapsed() < wait {
            thread::sleep(Duration::from_millis(2));
        }
        Ok(())
    }

    fn changed(&self) {
        self.pulse.send_modify(|count| *count += 1);
    }

    fn report(&self, report: &Report) {
        (self.said)(report);
    }

    fn known(&self, scene: &Scene, moments: &Moments) -> Option<Recording> {
        self.cache.find(scene, moments)
    }

    fn forget(&self, scene: &Scene, moments: &Moments) {
        self.cache.forget(scene, moments);
    }

    fn storage(&self, scene: &Scene, moments: &Moments) -> Box<dyn RunStorage> {
        Box::new(Cached { spill: self.cache.spill(scene, moments), cache: self.cache.clone() })
    }
}

/// Keeps the recording of a run in the cache once it is complete.
struct Cached {
    spill: Spill,
    cache: Cache,
}

impl RunStorage for Cached {
    fn store(&self) -> Box<dyn Store> {
        Box::new(self.spill.clone())
    }

    fn complete(&self, recording: &Recording, time: Duration) {
        self.cache.keep(&self.spill, recording, time);
    }
}
