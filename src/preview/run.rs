//! A run of a scene in the background, which is watched while it goes on.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;

use super::panicked::caught;
use super::swarms;
use crate::cache::{Cache, Spill};
use crate::diagnostic::{Code, Diagnostic, Report};
use crate::dynamics::Effort;
use crate::picture::Plan;
use crate::simulate::{
    Bounds, Counts, Frame, Frames, Ghost, Lagging, Moments, Recorded, Recorder, Recording, Survey,
};
use crate::{Run, Scene};

/// The number of a run, unique within a server, so that data of one run never pass for another's.
pub(super) type RunId = u64;

/// A run, from the moment on in which it is begun.
pub(super) struct Simulation {
    pub(super) id: RunId,
    pub(super) scene: Arc<Scene>,
    /// The part that has been simulated so far.
    recording: Mutex<Arc<Recording>>,
    cache: Cache,
    moments: Moments,
    cancelled: AtomicBool,
    past: Mutex<PastOfRun>,
    pub(super) swarms: swarms::Kept,
    outcome: OnceLock<Result<Outcome, Report>>,
}

/// The past of the frames of a run, for trails.
#[derive(Default)]
struct PastOfRun {
    ghosts: Vec<Arc<Ghost>>,
    /// The lagging cameras of each frame, if there are any.
    lagging: Vec<Vec<Lagging>>,
    bounds: Option<Bounds>,
}

/// The results that are known after the last frame.
pub(super) struct Outcome {
    pub(super) survey: Survey,
    /// How the main camera sees the run, and then each view.
    pub(super) plans: Vec<Plan>,
    /// The warnings of the run.
    pub(super) warnings: Report,
}

/// How far a run is, as the page is told.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Progress {
    /// The number of the run.
    id: String,
    /// How many frames there will be.
    frames: usize,
    /// How many there are.
    recorded: usize,
    /// Whether all is known of it.
    settled: bool,
    /// Why it ended early.
    pub(super) problem: Option<String>,
    warnings: Option<String>,
}

/// The interval between notices that there are more frames.
const PULSE: Duration = Duration::from_millis(40);

impl Simulation {
    /// Begins a run; `pulse` is called whenever there is something new of it, from another thread.
    pub(super) fn begin(
        id: RunId,
        scene: Arc<Scene>,
        cache: Cache,
        pulse: impl Fn() + Send + 'static,
    ) -> io::Result<Arc<Simulation>> {
        let moments = Moments::of(&scene);
        let empty = Recording::new(Counts::of(&scene), Box::new(Spill::unnamed()));
        let run = Arc::new(Simulation {
            id,
            recording: Mutex::new(Arc::new(empty)),
            cache,
            moments,
            scene,
            cancelled: AtomicBool::new(false),
            past: Mutex::default(),
            swarms: swarms::Kept::default(),
            outcome: OnceLock::new(),
        });
        let own = Arc::clone(&run);
        thread::Builder::new().name("run".to_owned()).spawn(move || {
            let outcome = caught("simulating", || own.simulate(&pulse));
            // Nobody else sets it.
            let _ = own.outcome.set(outcome);
            pulse();
        })?;
        Ok(run)
    }

    /// The part that has been simulated so far.
    pub(super) fn recording(&self) -> Arc<Recording> {
        Arc::clone(&self.recording.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// How many frames there are.
    pub(super) fn recorded(&self) -> usize {
        self.recording().frames()
    }

    /// Ends it early: nobody looks at it any more.
    pub(super) fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// The results after the last frame, if the run reached it; or the reason why it did not.
    pub(super) fn outcome(&self) -> Option<Result<&Outcome, &Report>> {
        self.outcome.get().map(Result::as_ref)
    }

    /// How far it is.
    pub(super) fn progress(&self) -> Progress {
        let outcome = self.outcome();
        let warnings = outcome.and_then(Result::ok).map(|outcome| outcome.warnings.to_text(false));
        Progress {
            id: self.id.to_string(),
            frames: self.scene.simulation.frames(),
            recorded: self.recorded(),
            settled: outcome.is_some(),
            problem: outcome.and_then(Result::err).map(|report| report.to_text(false)),
            warnings: warnings.filter(|text| !text.is_empty()),
        }
    }

    /// A frame that has been recorded, with as much of its past as pictures of the preview show.
    pub(super) fn frame(&self, index: usize) -> io::Result<Frame> {
        let mut frame = self.recording().read().seen(index)?;
        let past = self.past.lock().unwrap_or_else(PoisonError::into_inner);
        let slack = 1e-6 / self.scene.simulation.frame_rate;
        let is_past = |ghost: &&Arc<Ghost>| ghost.time < frame.time - slack;
        frame.past.ghosts = past.ghosts.iter().filter(is_past).cloned().collect();
        frame.past.lagging = past.lagging.get(index).cloned().unwrap_or_default();
        Ok(frame)
    }

    /// The ghosts so far.
    pub(super) fn ghosts(&self) -> Vec<Arc<Ghost>> {
        self.past.lock().unwrap_or_else(PoisonError::into_inner).ghosts.clone()
    }

    /// The box in which everything has taken place so far.
    pub(super) fn bounds(&self) -> Option<Bounds> {
        self.past.lock().unwrap_or_else(PoisonError::into_inner).bounds
    }

    fn simulate(&self, pulse: &dyn Fn()) -> Result<Outcome, Report> {
        let scene: &Scene = &self.scene;
        let recorded = match self.kept() {
            Some(recorded) => recorded,
            None => self.record(pulse)?,
        };
        self.remember(&recorded)?;
        let survey = recorded.survey().clone();
        let plan = |camera| Plan::new(scene, camera, &survey);
        let views = scene.views.iter().map(|view| plan(&view.camera));
        let plans = std::iter::once(plan(&scene.camera)).chain(views).collect();
        let run = Run::of(recorded).map_err(|error| error.report())?;
        let mut diagnostics = run.warnings();
        for (name, stride) in swarms::thinned(self) {
            let message = format!("this page shows 1 of {stride} particles of `{name}`");
            let help = "a rendered frame shows all: press `Render this`, or use `jabuka still`";
            diagnostics.push(Diagnostic::warning(Code::NotDrawn, message).help(help));
        }
        let warnings = Report { diagnostics, ..Report::default() };
        Ok(Outcome { survey, plans, warnings })
    }

    /// The run that an earlier command has kept.
    fn kept(&self) -> Option<Recorded<'_>> {
        let recording = Arc::new(self.cache.find(&self.scene, &self.moments)?);
        match Recorded::read(&self.scene, Arc::clone(&recording), |_| {}) {
            Ok(recorded) => {
                self.show(recording);
                Some(recorded)
            }
            Err(_) => {
                self.cache.forget(&self.scene, &self.moments);
                None
            }
        }
    }

    fn show(&self, recording: Arc<Recording>) {
        *self.recording.lock().unwrap_or_else(PoisonError::into_inner) = recording;
    }

    fn record(&self, pulse: &dyn Fn()) -> Result<Recorded<'_>, Report> {
        let scene: &Scene = &self.scene;
        let (begun, mut told) = (Instant::now(), Instant::now());
        let spill = self.cache.spill(scene, &self.moments);
        let mut recorder =
            Recorder::new(scene, self.moments.clone(), &Effort::default(), Box::new(spill.clone()));
        self.show(Arc::clone(recorder.recording()));
        while recorder.advance().map_err(|error| error.report())?.is_some() {
            if self.cancelled.load(Ordering::Relaxed) {
                return Err(Report::default());
            }
            self.past.lock().unwrap_or_else(PoisonError::into_inner).bounds = recorder.bounds();
            if told.elapsed() > PULSE {
                pulse();
                told = Instant::now();
            }
        }
        let recorded = recorder.finish().map_err(|error| error.report())?;
        self.cache.keep(&spill, recorded.recording(), begun.elapsed());
        Ok(recorded)
    }

    /// Collects what trails behind the frames, if anything does.
    fn remember(&self, recorded: &Recorded<'_>) -> Result<(), Report> {
        let mut collected = PastOfRun { bounds: recorded.survey().bounds(), ..PastOfRun::default() };
        if Frames::recorded(&self.scene, recorded.recording()).remember_anything() {
            for frame in recorded.frames() {
                let frame = frame.map_err(|error| error.report())?;
                collected.ghosts = frame.past.ghosts;
                if !frame.past.lagging.is_empty() {
                    collected.lagging.push(frame.past.lagging);
                }
            }
        }
        *self.past.lock().unwrap_or_else(PoisonError::into_inner) = collected;
        Ok(())
    }
}

pub(super) fn no_room(error: &io::Error) -> Report {
    let message = format!("the frames cannot be kept: {error}");
    let help = "they go to a file below /var/tmp, or where TMPDIR says; take fewer frames, or another folder";
    Report {
        diagnostics: vec![Diagnostic::error(Code::CannotWrite, message).help(help)],
        ..Report::default()
    }
}
