//! A session: the last run of the scene without errors, the current errors of the scene, and runs with other integration methods.

use std::collections::{BTreeMap, VecDeque};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;
use tokio::sync::watch;

use super::panicked::caught;
use super::run::{PreviewRun, Progress, RunId, no_room};
use super::watch::{POLL_INTERVAL, Watched};
use crate::Scene;
use crate::cache::Cache;
use crate::diagnostic::Report;
use crate::scene::{Options, Override};

/// A function that reads a scene from its file.
type Reader = dyn Fn(&Path, &Options) -> Result<Scene, Report> + Send + Sync;

/// The data of a preview. All open pages show the same data.
pub(super) struct Session {
    path: PathBuf,
    pub(super) options: Options,
    cache: Cache,
    reader: Box<Reader>,
    inner: Mutex<Inner>,
    next: AtomicU64,
    /// A counter that increases with each change of the session. Its receivers are notified of each change.
    pulse: watch::Sender<u64>,
    said: Box<dyn Fn(&Report) + Send + Sync>,
}

#[derive(Default)]
struct Inner {
    /// The number of versions of the scene so far. Each change of the scene increases it.
    generation: u64,
    current: Option<Arc<PreviewRun>>,
    /// The runs of the same scene with other methods, each with its method and timestep, oldest first.
    variants: VecDeque<(Variant, Arc<PreviewRun>)>,
    problem: Option<String>,
    warnings: Option<String>,
}

/// An integration method and a timestep that replace those of the scene.
#[derive(Clone, Debug, PartialEq, serde::Deserialize)]
pub(super) struct Variant {
    /// The name of the method.
    integrator: String,
    /// The largest timestep, s, as the user typed it.
    step: String,
}

/// The state that the page receives after each change.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct State {
    /// The id of the scene's last run without errors.
    current: Option<String>,
    /// The integration method that the scene sets.
    integrator: Option<&'static str>,
    /// The current errors of the scene, as the terminal shows them.
    problem: Option<String>,
    /// The warnings of the scene.
    warnings: Option<String>,
    /// The progress of all runs that the page can request, by id.
    runs: BTreeMap<String, Progress>,
}

/// The largest number of runs with other methods.
const MAX_VARIANTS: usize = 8;

/// The time that a new run has to finish before the page shows it unfinished.
const MAX_WAIT_FOR_RUN: Duration = Duration::from_millis(150);

impl Inner {
    fn variant(&self, variant: &Variant) -> Option<Arc<PreviewRun>> {
        let found = self.variants.iter().find(|(other, _)| other == variant);
        found.map(|(_, run)| Arc::clone(run))
    }
}

impl Session {
    /// Makes a session, without reading the scene yet. `said` receives the reports for the terminal.
    pub(super) fn new(
        path: PathBuf,
        options: Options,
        cache: Cache,
        said: impl Fn(&Report) + Send + Sync + 'static,
    ) -> Arc<Session> {
        Session::with_reader(path, options, cache, said, |path, options| Scene::from_path_with(path, options))
    }

    /// Makes a session that reads its scene with the given function.
    fn with_reader(
        path: PathBuf,
        options: Options,
        cache: Cache,
        said: impl Fn(&Report) + Send + Sync + 'static,
        reader: impl Fn(&Path, &Options) -> Result<Scene, Report> + Send + Sync + 'static,
    ) -> Arc<Session> {
        let (inner, next) = (Mutex::default(), AtomicU64::new(1));
        let (reader, pulse, said) = (Box::new(reader), watch::Sender::new(0), Box::new(said));
        Arc::new(Session { path, options, cache, reader, inner, next, pulse, said })
    }

    /// Reads the scene, and reads it again whenever one of its files changes, until `stop` is set. A panic becomes an error on the page, and the
    /// next version is read all the same.
    pub(super) fn follow(self: &Arc<Session>, stop: &AtomicBool) {
        let mut watched = Watched::new(std::slice::from_ref(&self.path));
        loop {
            let mut again = false;
            let read = caught("reading the scene", || {
                again = self.read(&mut watched);
                Ok(())
            });
            if let Err(report) = read {
                self.fail(&report);
            }
            let read = Instant::now();
            loop {
                if stop.load(Ordering::Relaxed) {
                    return;
                }
                thread::sleep(POLL_INTERVAL);
                if watched.have_changed() {
                    watched.settle();
                    break;
                }
                if again && read.elapsed() > 2 * POLL_INTERVAL {
                    break;
                }
            }
        }
    }

    /// Returns a receiver of the counter, which is notified of each change.
    pub(super) fn pulse(&self) -> watch::Receiver<u64> {
        self.pulse.subscribe()
    }

    /// Returns the current state, for the page.
    pub(super) fn state(&self) -> State {
        let inner = self.lock();
        let runs = inner.current.iter().chain(inner.variants.iter().map(|(_, run)| run));
        State {
            current: inner.current.as_ref().map(|run| run.id.to_string()),
            integrator: inner.current.as_ref().map(|run| run.scene.simulation.method.name),
            problem: inner.problem.clone(),
            warnings: inner.warnings.clone(),
            runs: runs.map(|run| (run.id.to_string(), run.progress())).collect(),
        }
    }

    /// Returns the run with this id. `None` if the run has been removed.
    pub(super) fn run(&self, id: RunId) -> Option<Arc<PreviewRun>> {
        let inner = self.lock();
        let mut runs = inner.current.iter().chain(inner.variants.iter().map(|(_, run)| run));
        runs.find(|run| run.id == id).cloned()
    }

    /// Starts a run of the scene with another method. Equal requests share one run.
    ///
    /// # Errors
    /// If the scene, the method or the timestep is invalid.
    pub(super) fn variant(self: &Arc<Session>, variant: Variant) -> Result<Arc<PreviewRun>, Report> {
        loop {
            let begun_with = {
                let inner = self.lock();
                if let Some(run) = inner.variant(&variant) {
                    return Ok(run);
                }
                inner.generation
            };
            let scene = self.scene(&self.options_of(&variant))?;
            let run = self.begin(scene).map_err(|error| no_room(&error))?;
            let mut inner = self.lock();
            let other = inner.variant(&variant);
            // Meanwhile, the scene may have changed, or another page may have made the same request.
            if inner.generation != begun_with || other.is_some() {
                run.cancel();
                continue;
            }
            inner.variants.push_back((variant, Arc::clone(&run)));
            if inner.variants.len() > MAX_VARIANTS {
                inner.variants.pop_front().iter().for_each(|(_, run)| run.cancel());
            }
            drop(inner);
            self.beat();
            return Ok(run);
        }
    }

    /// Returns the options for reading the scene with another method. An empty method or timestep keeps that of the scene.
    fn options_of(&self, variant: &Variant) -> Options {
        let mut options = self.options.clone();
        for (key, value) in [("integrator", &variant.integrator), ("step", &variant.step)] {
            if !value.trim().is_empty() {
                options.overrides.push(Override::new(format!("simulation.{key}={value}")));
            }
        }
        options
    }

    /// Reads the current files of the scene. A panic becomes an error report.
    fn scene(&self, options: &Options) -> Result<Scene, Report> {
        caught("reading the scene", || (self.reader)(&self.path, options))
    }

    /// Reads the scene, and updates the session. Returns true if the scene should be read once more, since a file may have changed during
    /// the reading.
    fn read(self: &Arc<Session>, watched: &mut Watched) -> bool {
        *watched = Watched::new(&watched.files());
        let read = self.scene(&self.options);
        let report = read.as_ref().map_or_else(|report| report, |scene| &scene.warnings);
        watched.add(report.sources.files());
        match read {
            Ok(scene) => self.replace(scene),
            Err(report) => self.complain(&report),
        }
        self.beat();
        watched.are_young()
    }

    /// Starts the run of a changed scene. If the scene has not changed, only removes the error message.
    fn replace(self: &Arc<Session>, scene: Scene) {
        let is_same = |run: &Arc<PreviewRun>| run.scene.digest == scene.digest;
        if self.lock().current.as_ref().is_some_and(is_same) {
            self.lock().problem = None;
            return;
        }
        (self.said)(&scene.warnings);
        let warnings = Some(scene.warnings.to_text(false)).filter(|text| !text.is_empty());
        let run = match self.begin(scene) {
            Ok(run) => run,
            Err(error) => return self.complain(&no_room(&error)),
        };
        // A run that finishes almost at once is not shown unfinished.
        let begun = Instant::now();
        while run.outcome().is_none() && begun.elapsed() < MAX_WAIT_FOR_RUN {
            thread::sleep(Duration::from_millis(2));
        }
        let mut inner = self.lock();
        inner.generation += 1;
        let old = inner.current.replace(run);
        let variants = std::mem::take(&mut inner.variants);
        inner.problem = None;
        inner.warnings = warnings;
        drop(inner);
        old.iter().chain(variants.iter().map(|(_, run)| run)).for_each(|run| run.cancel());
    }

    /// Reports the errors of the scene. The last run without errors stays.
    fn complain(&self, report: &Report) {
        let text = report.to_text(false);
        let is_new = self.lock().problem.replace(text.clone()).is_none_or(|before| before != text);
        if is_new {
            (self.said)(report);
        }
    }

    /// Shows an error of jabuka itself on the page. What failed may have been the terminal, so the terminal comes last.
    fn fail(&self, report: &Report) {
        self.lock().problem = Some(report.to_text(false));
        self.beat();
        // If the terminal fails again, the page has the error.
        let _ = caught("printing the report", || {
            (self.said)(report);
            Ok(())
        });
    }

    fn begin(self: &Arc<Session>, scene: Scene) -> io::Result<Arc<PreviewRun>> {
        let id = self.next.fetch_add(1, Ordering::Relaxed);
        let session = Arc::downgrade(self);
        PreviewRun::begin(id, Arc::new(scene), self.cache.clone(), move || {
            session.upgrade().iter().for_each(|session| session.beat());
        })
    }

    fn beat(&self) {
        self.pulse.send_modify(|count| *count += 1);
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Follow;

    /// Makes a session for tests. Reading a scene with the title `panic` panics, and running a scene with the title `lost` panics. So does
    /// reporting an error about a mass.
    fn fragile(path: PathBuf) -> Arc<Session> {
        let read = |path: &Path, options: &Options| {
            let mut scene = Scene::from_path_with(path, options)?;
            match scene.title.as_deref() {
                Some("panic") => panic!("cannot read π"),
                Some("lost") => {
                    scene.camera.motion.follow = Some(Follow { body: 7, distance: None, lag: None });
                }
                _ => {}
            }
            Ok(scene)
        };
        let said = |report: &Report| assert!(!report.to_text(false).contains("mass"), "cannot report it");
        Session::with_reader(path, Options::default(), Cache::none(), said, read)
    }

    #[test]
    fn after_a_panic_the_next_save_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        let save = |title: &str| {
            let text = format!("title = '{title}'\n[body.ball]\nshape.sphere.radius = 1\n");
            std::fs::write(&path, text).unwrap();
        };
        let (session, stop) = (fragile(path.clone()), AtomicBool::new(false));
        let wait = |is_so: &dyn Fn(&State) -> bool| {
            let begun = Instant::now();
            while !is_so(&session.state()) {
                assert!(begun.elapsed() < Duration::from_secs(120), "the session does not reach the state");
                thread::sleep(Duration::from_millis(1));
            }
        };
        let of_run = |state: &State| state.runs.values().find_map(|run| run.problem.clone());
        save("panic");
        let problems = thread::scope(|scope| {
            scope.spawn(|| session.follow(&stop));
            wait(&|state| state.problem.is_some());
            let of_reading = session.state().problem;
            save("good");
            wait(&|state| state.problem.is_none() && state.current.is_some());
            save("lost");
            wait(&|state| of_run(state).is_some());
            let of_simulating = of_run(&session.state());
            save("good again");
            wait(&|state| of_run(state).is_none());
            save("heavy'\nbody.ball.mass = -1 #");
            wait(&|state| state.problem.as_ref().is_some_and(|problem| problem.contains("jabuka failed")));
            let of_reporting = session.state().problem;
            save("good at last");
            wait(&|state| state.problem.is_none());
            stop.store(true, Ordering::Relaxed);
            [of_reading, of_simulating, of_reporting].map(Option::unwrap_or_default)
        });
        let expected = [
            "reading the scene: cannot read π",
            "simulating: index out of bounds",
            "reading the scene: cannot report it",
        ];
        for (problem, expected) in problems.iter().zip(expected) {
            assert!(problem.contains(&format!("jabuka failed while {expected}")), "{problem}");
        }
    }
}
