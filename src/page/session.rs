//! A session: the last run of the scene without errors, the current errors of the scene, and runs with other integration methods.

use std::collections::{BTreeMap, VecDeque};
use std::io;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::Serialize;
use sha2::{Digest as _, Sha256};

use super::Host;
use super::panicked::caught;
use super::run::{PageRun, Progress, RunId, no_room};
use crate::Scene;
use crate::diagnostic::{Code, Report};
use crate::scene::{Options, Override};

/// The data of a page. All pages that show the same scene share a session.
pub struct Session {
    options: Options,
    host: Arc<dyn Host>,
    inner: Mutex<Inner>,
    next: AtomicU64,
    /// The values that sliders have given to variables. It is locked while the scene is read, so that no older version replaces a newer one.
    set: Mutex<BTreeMap<String, f64>>,
}

#[derive(Default)]
struct Inner {
    /// The number of versions of the scene so far. Each change of the scene increases it.
    generation: u64,
    current: Option<Arc<PageRun>>,
    /// The runs of the same scene with other methods, each with its method and timestep, oldest first.
    variants: VecDeque<(Variant, Arc<PageRun>)>,
    problem: Option<String>,
    warnings: Option<String>,
    text: Option<String>,
    diagnostics: serde_json::Value,
}

/// An integration method and a timestep that replace those of the scene.
#[derive(Clone, Debug, PartialEq, serde::Deserialize)]
pub struct Variant {
    /// The name of the method.
    integrator: String,
    /// The largest timestep, s, as the user typed it.
    step: String,
}

/// The state that the page receives after each change.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct State {
    /// The id of the scene's last run without errors.
    pub current: Option<String>,
    /// The integration method that the scene sets.
    pub integrator: Option<&'static str>,
    /// The current errors of the scene, as the terminal shows them.
    pub problem: Option<String>,
    /// The warnings of the scene.
    pub warnings: Option<String>,
    /// The version of the scene's text that was read last ([`text_version`]). `None` if it could not be read.
    pub text: Option<String>,
    /// The errors and warnings of this text with their places, as `jabuka check --format json` prints them.
    pub diagnostics: serde_json::Value,
    /// The progress of all runs that the page can request, by id.
    pub runs: BTreeMap<String, Progress>,
}

/// Returns the version of a text, which differs from that of any other text.
pub fn text_version(text: &str) -> String {
    Sha256::digest(text).iter().take(16).map(|byte| format!("{byte:02x}")).collect()
}

/// The largest number of runs with other methods.
const MAX_VARIANTS: usize = 8;

impl Inner {
    fn variant(&self, variant: &Variant) -> Option<Arc<PageRun>> {
        let found = self.variants.iter().find(|(other, _)| other == variant);
        found.map(|(_, run)| Arc::clone(run))
    }
}

impl Session {
    /// Makes a session, without reading the scene yet.
    pub fn new(options: Options, host: Arc<dyn Host>) -> Session {
        Session { options, host, inner: Mutex::default(), next: AtomicU64::new(1), set: Mutex::default() }
    }

    /// Returns the current state, for the page.
    pub fn state(&self) -> State {
        let inner = self.lock();
        let runs = inner.current.iter().chain(inner.variants.iter().map(|(_, run)| run));
        State {
            current: inner.current.as_ref().map(|run| run.id.to_string()),
            integrator: inner.current.as_ref().map(|run| run.scene.simulation.method.name),
            problem: inner.problem.clone(),
            warnings: inner.warnings.clone(),
            text: inner.text.clone(),
            diagnostics: inner.diagnostics.clone(),
            runs: runs.map(|run| (run.id.to_string(), run.progress())).collect(),
        }
    }

    /// Returns the run with this id. `None` if the run has been removed.
    pub fn run(&self, id: RunId) -> Option<Arc<PageRun>> {
        let inner = self.lock();
        let mut runs = inner.current.iter().chain(inner.variants.iter().map(|(_, run)| run));
        runs.find(|run| run.id == id).cloned()
    }

    /// Starts a run of the scene with another method. Equal requests share one run.
    ///
    /// # Errors
    /// If the scene, the method or the timestep is invalid.
    pub fn variant(&self, variant: Variant) -> Result<Arc<PageRun>, Report> {
        loop {
            let begun_with = {
                let inner = self.lock();
                if let Some(run) = inner.variant(&variant) {
                    return Ok(run);
                }
                inner.generation
            };
            let set = self.set.lock().unwrap_or_else(PoisonError::into_inner).clone();
            let scene = self.scene(&self.options_of(&variant, &set))?;
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
            self.host.changed();
            return Ok(run);
        }
    }

    /// Returns the options for reading the scene with another method and the values of sliders. An empty method or timestep keeps that of the
    /// scene.
    fn options_of(&self, variant: &Variant, set: &BTreeMap<String, f64>) -> Options {
        let mut options = self.options.clone();
        let values =
            set.iter().map(|(name, value)| Override::new(format!("variables.{name}.value={value:?}")));
        options.overrides.extend(values);
        for (key, value) in [("integrator", &variant.integrator), ("step", &variant.step)] {
            if !value.trim().is_empty() {
                options.overrides.push(Override::new(format!("simulation.{key}={value}")));
            }
        }
        options
    }

    /// Reads the current files of the scene. A panic becomes an error report.
    fn scene(&self, options: &Options) -> Result<Scene, Report> {
        caught("reading the scene", || self.host.read(options))
    }

    /// Reads a new version of the scene's files, and starts its run if the scene is valid and has changed. All variables have the values of
    /// the files. Returns the files of the scene, including those that do not exist.
    pub fn read(&self) -> Vec<PathBuf> {
        let mut set = self.set.lock().unwrap_or_else(PoisonError::into_inner);
        set.clear();
        self.read_with(&set)
    }

    /// Gives a variable that has a slider another value, until the files change, and starts the run.
    ///
    /// # Errors
    /// If the scene has no such slider, or the value is not within its range.
    pub fn set_variable(&self, name: &str, value: f64) -> Result<(), Report> {
        let mut set = self.set.lock().unwrap_or_else(PoisonError::into_inner);
        let current = self.lock().current.clone();
        let sliders = current.iter().flat_map(|run| &run.scene.variable_sliders);
        let slider = sliders.into_iter().find(|slider| slider.variable == name);
        if !slider.is_some_and(|slider| (slider.range[0]..=slider.range[1]).contains(&value)) {
            let message = format!("there is no slider of `{name}` that reaches {value}");
            return Err(Report::of_error(Code::OutOfRange, message));
        }
        set.insert(name.to_owned(), value);
        self.read_with(&set);
        Ok(())
    }

    fn read_with(&self, set: &BTreeMap<String, f64>) -> Vec<PathBuf> {
        let own = Variant { integrator: String::new(), step: String::new() };
        let read = self.scene(&self.options_of(&own, set));
        let report = read.as_ref().map_or_else(|report| report, |scene| &scene.warnings);
        let files = report.sources.files().to_vec();
        let text = report.sources.of_scene().map(|source| text_version(&source.text));
        let diagnostics = serde_json::to_value(report.to_json()).unwrap_or_default();
        {
            let mut inner = self.lock();
            (inner.text, inner.diagnostics) = (text, diagnostics);
        }
        match read {
            Ok(scene) => self.replace(scene),
            Err(report) => self.complain(&report),
        }
        self.host.changed();
        files
    }

    /// Starts the run of a changed scene. If the scene has not changed, only removes the error message.
    fn replace(&self, scene: Scene) {
        let is_same = |run: &Arc<PageRun>| run.scene.digest == scene.digest;
        if self.lock().current.as_ref().is_some_and(is_same) {
            self.lock().problem = None;
            return;
        }
        self.host.report(&scene.warnings);
        let warnings = Some(scene.warnings.to_text(false)).filter(|text| !text.is_empty());
        let run = match self.begin(scene) {
            Ok(run) => run,
            Err(error) => return self.complain(&no_room(&error)),
        };
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
            self.host.report(report);
        }
    }

    /// Shows an error of jabuka itself on the page. What failed may have been the terminal, so the terminal comes last.
    pub fn fail(&self, report: &Report) {
        self.lock().problem = Some(report.to_text(false));
        self.host.changed();
        // If the terminal fails again, the page has the error.
        let _ = caught("printing the report", || {
            self.host.report(report);
            Ok(())
        });
    }

    fn begin(&self, scene: Scene) -> io::Result<Arc<PageRun>> {
        let id = self.next.fetch_add(1, Ordering::Relaxed);
        let before = self.lock().current.clone();
        let run = PageRun::new(id, Arc::new(scene), Arc::clone(&self.host), before.as_deref());
        self.host.start(Arc::clone(&run))?;
        Ok(run)
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
