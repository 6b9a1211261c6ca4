//! Simulates a run of a scene in small pieces, while the page already shows it.

use std::collections::BTreeMap;
use std::io;
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::task::{Context, Poll, Waker};
use std::time::Instant;

use serde::Serialize;

#[cfg(any(test, feature = "render"))]
use super::host::NoHost;
use super::panicked::caught;
use super::{Failed, Host, provisional, swarms};
use crate::diagnostic::{Code, Diagnostic, Report};
use crate::physics::PairCounter;
use crate::picture::Plan;
use crate::simulate::{
    Bounds, Counts, Frame, Frames, Ghost, Lagging, MemoryStore, Moments, Recorded, Recorder, Recording,
    Sector, Survey,
};
use crate::{Run, Scene};

/// The id of a run, unique within a session, so that the page never mixes data of two runs.
pub type RunId = u64;

/// A run that is being simulated or has been simulated.
pub struct PageRun {
    /// The id of the run.
    pub id: RunId,
    /// The scene of the run.
    pub scene: Arc<Scene>,
    /// The frames that have been simulated so far.
    recording: Mutex<Arc<Recording>>,
    host: Arc<dyn Host>,
    moments: Moments,
    cancelled: AtomicBool,
    past: Mutex<PastOfRun>,
    pub(super) swarms: swarms::KeptSwarms,
    outcome: OnceLock<Result<Outcome, Report>>,
    /// How the run looks until its outcome is known: as the run before it. `None` if that was another scene.
    provisional: Option<Outcome>,
}

/// The earlier states of a run that later frames show: ghosts, swept areas, and the positions of lagging cameras. It also holds the box around the
/// motion.
#[derive(Default)]
struct PastOfRun {
    ghosts: Vec<Arc<Ghost>>,
    /// The positions of the lagging cameras in each frame. Empty if no camera lags behind its body.
    lagging: Vec<Vec<Lagging>>,
    /// The complete sectors of each swept area.
    areas: Vec<Vec<Arc<Sector>>>,
    trail_values: TrailValues,
    bounds: Option<Bounds>,
}

/// The values that the colors of trails follow.
#[derive(Clone, Default)]
pub(super) struct TrailValues {
    /// The number of frames from one value to the next.
    pub(super) every: usize,
    /// The values of each trail whose color follows one, by the index of its body. `None` while a value is undefined.
    pub(super) of_bodies: BTreeMap<usize, Vec<Option<f64>>>,
}

impl TrailValues {
    /// The largest number of values of all trails together. In longer runs, only the values of some frames are kept.
    const MOST_VALUES: usize = 500_000;

    fn new(scene: &Scene) -> TrailValues {
        let bodies = scene.bodies.iter().enumerate();
        let bodies = bodies.filter(|(_, body)| scene.trail_map_of(body).is_some());
        let of_bodies: BTreeMap<_, _> = bodies.map(|(number, _)| (number, Vec::new())).collect();
        let values = scene.simulation.timeline.frames().saturating_mul(of_bodies.len());
        TrailValues { every: values.div_ceil(TrailValues::MOST_VALUES).max(1), of_bodies }
    }

    /// Adds the values of the next frame.
    fn note(&mut self, frame: &Frame) {
        if !frame.index.is_multiple_of(self.every) {
            return;
        }
        for path in &frame.past.trails {
            if let Some(values) = self.of_bodies.get_mut(&path.body) {
                let here = path.points.last().filter(|point| point.time == frame.time);
                values.push(here.and_then(|point| point.value));
            }
        }
    }
}

/// The results of a run that are known after its last frame.
pub struct Outcome {
    /// The survey of the run.
    pub survey: Survey,
    /// The contents of the pictures: the plan of the main camera, then the plan of each view.
    pub plans: Vec<Plan>,
    /// The warnings about the run, such as energy drift.
    pub warnings: Report,
}

/// The progress of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Progress {
    /// The id of the run.
    id: String,
    /// The number of frames of the whole run.
    frames: usize,
    /// The number of frames that have been simulated.
    recorded: usize,
    /// True if the run has ended, so that all results are known.
    settled: bool,
    /// The error that ended the run early, as text.
    pub problem: Option<String>,
    warnings: Option<String>,
}

/// The work that is left of a run, done piece by piece.
pub struct RunWork {
    run: Arc<PageRun>,
    /// The work borrows from the scene that it contains, which only a future can.
    rest: Pin<Box<dyn Future<Output = Result<Outcome, Report>>>>,
}

impl RunWork {
    /// Does the next piece of the work, which simulates one frame in most cases. Returns false after the end of the run.
    pub fn advance(&mut self) -> bool {
        if self.run.outcome().is_some() {
            return false;
        }
        let mut context = Context::from_waker(Waker::noop());
        let outcome = match caught("simulating", || Ok(self.rest.as_mut().poll(&mut context))) {
            Ok(Poll::Pending) => return true,
            Ok(Poll::Ready(outcome)) => outcome,
            Err(panic) => Err(panic),
        };
        // Only this place sets the outcome, so setting it cannot fail.
        let _ = self.run.outcome.set(outcome);
        false
    }
}

/// A pause between two pieces of the work.
struct Pause {
    is_over: bool,
}

impl Future for Pause {
    type Output = ();

    fn poll(mut self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<()> {
        if self.is_over {
            return Poll::Ready(());
        }
        self.is_over = true;
        Poll::Pending
    }
}

/// Ends the current piece of a run's work.
fn pause() -> Pause {
    Pause { is_over: false }
}

impl PageRun {
    /// Makes a run of which nothing is simulated yet. `before` is the run that the page shows now.
    pub(super) fn new(
        id: RunId,
        scene: Arc<Scene>,
        host: Arc<dyn Host>,
        before: Option<&PageRun>,
    ) -> Arc<PageRun> {
        // A mistake of jabuka here will be one of the run, too, and is reported there.
        let look = caught("preparing", || Ok(before.and_then(|before| provisional::outcome(&scene, before))));
        let provisional = look.unwrap_or_default();
        let moments = Moments::of(&scene);
        let empty = Recording::new(Counts::of(&scene), Box::<MemoryStore>::default());
        Arc::new(PageRun {
            id,
            recording: Mutex::new(Arc::new(empty)),
            host,
            moments,
            scene,
            cancelled: AtomicBool::new(false),
            past: Mutex::default(),
            swarms: swarms::KeptSwarms::default(),
            outcome: OnceLock::new(),
            provisional,
        })
    }

    /// Makes a finished run from a recording. Its id is 1, and its texts name files without their folders, so its page is the same on all
    /// machines.
    ///
    /// # Errors
    /// If the recording cannot be read.
    #[cfg(feature = "render")]
    pub(super) fn of(recorded: &Recorded<'_>) -> Result<Arc<PageRun>, Report> {
        let mut scene = recorded.scene().clone();
        scene.warnings.sources.forget_folders();
        let run = PageRun::new(1, Arc::new(scene), Arc::new(NoHost), None);
        let recording = Arc::clone(recorded.recording());
        run.show(Arc::clone(&recording));
        let outcome = {
            let recorded = Recorded::of_parts(&run.scene, recording, recorded.survey().clone());
            let mut work = std::pin::pin!(run.conclude(recorded));
            let mut context = Context::from_waker(Waker::noop());
            loop {
                if let Poll::Ready(outcome) = work.as_mut().poll(&mut context) {
                    break outcome?;
                }
            }
        };
        // Nothing else sets the outcome of this run.
        let _ = run.outcome.set(Ok(outcome));
        Ok(run)
    }

    /// Returns the work of this run, of which nothing is done yet. It is done only once.
    pub fn work(self: &Arc<PageRun>) -> RunWork {
        let run = Arc::clone(self);
        RunWork { rest: Box::pin(Arc::clone(&run).simulate()), run }
    }

    /// Returns the frames that have been simulated so far.
    pub fn recording(&self) -> Arc<Recording> {
        Arc::clone(&self.recording.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Returns the number of frames that have been simulated so far.
    pub fn recorded(&self) -> usize {
        self.recording().frames()
    }

    /// Cancels the run, since no page shows it any more.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Returns the results after the last frame, or the errors that ended the run early. `None` while the run is being simulated.
    pub fn outcome(&self) -> Option<Result<&Outcome, &Report>> {
        self.outcome.get().map(Result::as_ref)
    }

    /// Returns how the run looks: by its own results, or by those of the run before it until its own are known. `None` if neither is known.
    pub fn look(&self) -> Option<&Outcome> {
        match self.outcome() {
            Some(outcome) => outcome.ok(),
            None => self.provisional.as_ref(),
        }
    }

    /// Returns the finished run.
    ///
    /// # Errors
    /// If the run is not finished, or an error has ended it early.
    pub fn finished(&self) -> Result<Recorded<'_>, Report> {
        match self.outcome() {
            Some(Ok(outcome)) => {
                Ok(Recorded::of_parts(&self.scene, self.recording(), outcome.survey.clone()))
            }
            Some(Err(report)) => Err(report.clone()),
            None => {
                let message = "the run is not finished: its results are not known yet";
                Err(Report::of_error(Code::NotFinished, message))
            }
        }
    }

    /// Returns the finished run as a camera sees it: 0 for the main camera, then the views in their order.
    ///
    /// # Errors
    /// If the run is not finished, an error has ended it early, there is no such camera, or a template fails.
    pub fn seen_by(&self, view: usize) -> Result<Run<'_>, Failed> {
        let main = Run::of(self.finished()?)?;
        match view.checked_sub(1) {
            None => Ok(main),
            Some(view) => Ok(main.seen_by(self.scene.views.get(view).ok_or(Failed::Gone)?)?),
        }
    }

    /// Returns the progress of the run.
    pub fn progress(&self) -> Progress {
        let outcome = self.outcome();
        let warnings = outcome.and_then(Result::ok).map(|outcome| outcome.warnings.to_text(false));
        Progress {
            id: self.id.to_string(),
            frames: self.scene.simulation.timeline.frames(),
            recorded: self.recorded(),
            settled: outcome.is_some(),
            problem: outcome.and_then(Result::err).map(|report| report.to_text(false)),
            warnings: warnings.filter(|text| !text.is_empty()),
        }
    }

    /// Reads a recorded frame, with the ghosts, swept areas and lagging cameras that it shows.
    pub(super) fn frame(&self, index: usize) -> io::Result<Frame> {
        let mut frame = self.recording().read().seen(index)?;
        let past = self.past.lock().unwrap_or_else(PoisonError::into_inner);
        let slack = self.scene.simulation.timeline.slack();
        let is_past = |ghost: &&Arc<Ghost>| ghost.time < frame.time - slack;
        frame.past.ghosts = past.ghosts.iter().filter(is_past).cloned().collect();
        frame.past.lagging = past.lagging.get(index).cloned().unwrap_or_default();
        let is_complete = |sector: &&Arc<Sector>| sector.until <= frame.time + slack;
        let complete = |all: &Vec<Arc<Sector>>| all.iter().filter(is_complete).cloned().collect();
        frame.past.areas = past.areas.iter().map(complete).collect();
        Ok(frame)
    }

    /// Returns the ghosts (earlier poses of bodies) that are known so far.
    pub(super) fn ghosts(&self) -> Vec<Arc<Ghost>> {
        self.past.lock().unwrap_or_else(PoisonError::into_inner).ghosts.clone()
    }

    /// Returns the values that the colors of trails follow. Empty until the run is finished.
    pub(super) fn trail_values(&self) -> TrailValues {
        self.past.lock().unwrap_or_else(PoisonError::into_inner).trail_values.clone()
    }

    /// Returns the box around the motion so far. `None` before the first frame.
    pub(super) fn bounds(&self) -> Option<Bounds> {
        self.past.lock().unwrap_or_else(PoisonError::into_inner).bounds
    }

    async fn simulate(self: Arc<PageRun>) -> Result<Outcome, Report> {
        let recorded = match self.kept() {
            Some(recorded) => recorded,
            None => self.record().await?,
        };
        self.conclude(recorded).await
    }

    /// Finds the results that are known after the last frame.
    async fn conclude(self: &Arc<PageRun>, recorded: Recorded<'_>) -> Result<Outcome, Report> {
        let scene: &Scene = &self.scene;
        self.remember(&recorded).await?;
        let survey = recorded.survey().clone();
        let plan = |camera| Plan::new(scene, camera, &survey);
        let views = scene.views.iter().map(|view| plan(&view.camera));
        let plans = std::iter::once(plan(&scene.camera)).chain(views).collect();
        let mut warnings = Run::of(recorded).map_err(|error| error.report())?.report();
        for (name, stride) in swarms::thinned(self) {
            let message = format!("this page shows 1 of {stride} particles of `{name}`");
            let help = "a rendered frame shows all: press `Render this`, or use `jabuka still`";
            warnings.diagnostics.push(Diagnostic::warning(Code::NotDrawn, message).help(help));
        }
        Ok(Outcome { survey, plans, warnings })
    }

    /// Returns the recording of the run, if it was simulated before. `None` if the host does not know it, or the recording is damaged.
    fn kept(&self) -> Option<Recorded<'_>> {
        let scene: &Scene = &self.scene;
        let recording = Arc::new(self.host.known(scene, &self.moments)?);
        match Recorded::read(scene, Arc::clone(&recording), |_| {}) {
            Ok(recorded) => {
                self.show(recording);
                Some(recorded)
            }
            Err(_) => {
                self.host.forget(scene, &self.moments);
                None
            }
        }
    }

    fn show(&self, recording: Arc<Recording>) {
        *self.recording.lock().unwrap_or_else(PoisonError::into_inner) = recording;
    }

    async fn record(&self) -> Result<Recorded<'_>, Report> {
        let (scene, begun): (&Scene, _) = (&self.scene, Instant::now());
        let storage = self.host.storage(scene, &self.moments);
        let mut recorder =
            Recorder::new(scene, self.moments.clone(), &PairCounter::default(), storage.store());
        self.show(Arc::clone(recorder.recording()));
        while recorder.advance().map_err(|error| error.report())?.is_some() {
            if self.cancelled.load(Ordering::Relaxed) {
                return Err(Report::default());
            }
            self.past.lock().unwrap_or_else(PoisonError::into_inner).bounds = recorder.bounds();
            pause().await;
        }
        let recorded = recorder.finish().map_err(|error| error.report())?;
        storage.complete(recorded.recording(), begun.elapsed());
        Ok(recorded)
    }

    /// Collects the ghosts, swept areas, values of trails and lagging cameras of all frames, if the scene has any.
    async fn remember(&self, recorded: &Recorded<'_>) -> Result<(), Report> {
        let (bounds, scene): (_, &Scene) = (recorded.survey().bounds(), &self.scene);
        let trail_values = TrailValues::new(scene);
        let mut collected = PastOfRun { bounds, trail_values, ..PastOfRun::default() };
        if Frames::recorded(scene, recorded.recording()).remember_anything() {
            for frame in recorded.frames() {
                let frame = frame.map_err(|error| error.report())?;
                collected.trail_values.note(&frame);
                collected.ghosts = frame.past.ghosts;
                collected.areas = frame.past.areas;
                if !frame.past.lagging.is_empty() {
                    collected.lagging.push(frame.past.lagging);
                }
                pause().await;
            }
        }
        *self.past.lock().unwrap_or_else(PoisonError::into_inner) = collected;
        Ok(())
    }
}

/// Returns the error that there is no room for the recording of a run.
pub(super) fn no_room(error: &io::Error) -> Report {
    let message = format!("the frames cannot be kept: {error}");
    let help = "they go to a file below /var/tmp, or where TMPDIR says; take fewer frames, or another folder";
    Report {
        diagnostics: vec![Diagnostic::error(Code::CannotWrite, message).help(help)],
        ..Report::default()
    }
}

#[cfg(test)]
impl PageRun {
    /// Simulates a whole run.
    pub(super) fn whole(scene: Scene) -> Arc<PageRun> {
        let run = PageRun::new(1, Arc::new(scene), Arc::new(NoHost), None);
        let mut work = run.work();
        while work.advance() {}
        run
    }
}
