//! Records a run of a scene, and reads the recorded run.

use std::collections::VecDeque;
use std::io;
use std::sync::Arc;

use super::frames::within;
use super::particles::Clouds;
use super::past::History;
use super::recording::{Counts, MemoryStore, Recording, Store};
use super::simulation::Simulation;
use super::{Exposure, Frame, Frames, Moments, Selection, SimulateError, Survey, Surveyor};
use crate::physics::{Dynamics, Impact, PairCounter};
use crate::scene::Scene;

/// A simulated run with its recording and its survey. Its moments can be read in any order, to draw, measure or export them.
#[derive(Clone)]
pub struct Recorded<'a> {
    scene: &'a Scene,
    recording: Arc<Recording>,
    survey: Survey,
    /// The error that ended the run before its last frame. `None` if the run is complete.
    breakdown: Option<SimulateError>,
    /// The simulated time at which an interrupted run was resumed, s. `None` if the run was never interrupted.
    resumed: Option<f64>,
    /// Whether the caller's own dynamics made the run, so that the scene's dynamics must not add moments to it.
    of_own_dynamics: bool,
}

impl<'a> Recorded<'a> {
    /// Simulates a scene, and keeps the recording in memory.
    ///
    /// # Errors
    /// If the run becomes non-finite.
    pub fn new(scene: &'a Scene) -> Result<Recorded<'a>, SimulateError> {
        let store = Box::<MemoryStore>::default();
        let mut recorder = Recorder::new(scene, Moments::of(scene), &PairCounter::default(), store);
        while recorder.advance()?.is_some() {}
        recorder.finish()
    }

    /// Simulates a scene with the caller's own dynamics, which must be at time 0. The bodies of the dynamics have the indices of the
    /// scene. Only the moments that the scene requests are recorded: for any other moment, [`at`](Self::at) returns an error.
    ///
    /// # Errors
    /// If the run becomes non-finite.
    pub fn of(scene: &'a Scene, dynamics: Box<dyn Dynamics>) -> Result<Recorded<'a>, SimulateError> {
        let simulation = Simulation::of(scene, Moments::of(scene), dynamics);
        let mut recorder = Recorder::of(scene, simulation, Box::<MemoryStore>::default());
        while recorder.advance()?.is_some() {}
        Ok(Recorded { of_own_dynamics: true, ..recorder.finish()? })
    }

    /// Combines a scene with the recording and the survey of its complete run.
    pub fn of_parts(scene: &'a Scene, recording: Arc<Recording>, survey: Survey) -> Recorded<'a> {
        Recorded { scene, recording, survey, breakdown: None, resumed: None, of_own_dynamics: false }
    }

    /// Surveys a recorded run, and calls `seen` with every frame. The survey depends on the look of the scene, so it is computed again
    /// from all frames.
    ///
    /// # Errors
    /// If the recording lacks frames or cannot be read.
    pub fn read(
        scene: &'a Scene,
        recording: Arc<Recording>,
        mut seen: impl FnMut(&Frame),
    ) -> Result<Recorded<'a>, SimulateError> {
        if recording.frames() != scene.simulation.timeline.frames() {
            return Err(SimulateError::Recording("the recording lacks frames".to_owned()));
        }
        let mut surveyor = Surveyor::new(scene);
        see_all(&recording, &mut surveyor, &mut seen)?;
        Ok(Recorded::of_parts(scene, recording, surveyor.finish()))
    }

    /// The scene that was simulated.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The survey of the run: the space that it takes, its energy error, its contacts, and more.
    pub fn survey(&self) -> &Survey {
        &self.survey
    }

    /// The recorded moments of the run.
    pub fn recording(&self) -> &Arc<Recording> {
        &self.recording
    }

    /// The error that ended the run before its last frame. `None` if the run is complete.
    pub fn breakdown(&self) -> Option<&SimulateError> {
        self.breakdown.as_ref()
    }

    /// The simulated time at which an interrupted run was resumed, s. `None` if the run was never interrupted.
    pub fn resumed(&self) -> Option<f64> {
        self.resumed
    }

    /// The number of frames that can be drawn. After a breakdown, a frame counts only if all moments of its open shutters were recorded,
    /// too.
    pub fn whole_frames(&self) -> usize {
        let moments = Moments::of(self.scene);
        let is_recorded = |time| self.recording.moment_at(time).is_some();
        let is_whole =
            |frame: usize| moments.times_of(self.scene.simulation.timeline.time(frame)).all(is_recorded);
        let frames = self.recording.frames();
        if self.breakdown.is_none() {
            return frames;
        }
        (0..frames).rev().find(|&frame| is_whole(frame)).map_or(0, |last| last + 1)
    }

    /// Reads all frames in order, from the first one.
    pub fn frames(&self) -> Frames<'a> {
        Frames::recorded(self.scene, &self.recording)
    }

    /// Reads all impacts of the run in order of time.
    pub fn impacts(&self) -> impl Iterator<Item = Result<Impact, SimulateError>> + use<'a> {
        let mut reader = self.recording.read();
        let mut waiting = Vec::new().into_iter();
        std::iter::from_fn(move || {
            loop {
                if let Some(impact) = waiting.next() {
                    return Some(Ok(impact));
                }
                match reader.entry() {
                    Ok(entry) => waiting = entry?.impacts.into_iter(),
                    Err(error) => return Some(Err(error.into())),
                }
            }
        })
    }

    /// Reads the selected frames. Each comes with the recorded moments after it, for cameras with an open shutter.
    pub fn exposures(
        &self,
        selection: &Selection,
    ) -> impl Iterator<Item = Result<Exposure, SimulateError>> + Send + use<'a> {
        let (mut frames, recording) = (self.frames(), Arc::clone(&self.recording));
        let scene = self.scene;
        let count = self.recording.frames();
        let mut cameras = self.scene.views.iter().map(|view| &view.camera).chain([&self.scene.camera]);
        let is_exposed = cameras.any(|camera| camera.shutter.is_some());
        let last = selection.last().map_or(0, |last| last.saturating_add(1).min(count));
        let mut wanted = (0..last).filter({
            let selection = selection.clone();
            move |&frame| selection.contains(frame)
        });
        std::iter::from_fn(move || {
            let wanted = wanted.next()?;
            frames.pass_to(wanted);
            loop {
                match frames.next()? {
                    Ok(frame) if frame.index < wanted => {}
                    Ok(frame) => {
                        let rest = (Arc::clone(&recording), frames.position());
                        // Only cameras with shutters read on from this frame, so only they need its past and its particles.
                        let (history, clouds) = match is_exposed {
                            true => (frames.history().clone(), frames.clouds().clone()),
                            false => (History::default(), Clouds::new(scene)),
                        };
                        return Some(Ok(Exposure::new(
                            frame,
                            history,
                            clouds,
                            rest,
                            &scene.simulation.timeline,
                        )));
                    }
                    Err(error) => return Some(Err(error)),
                }
            }
        })
    }

    /// Returns the moment at any time (s), with the moments after it for cameras with an open shutter. A time outside the run gives the
    /// run's first or last moment. If the moment was not recorded, the run is simulated again.
    ///
    /// # Errors
    /// If the run broke down before that time, or the recording cannot be read. Also if the moment was not recorded and the run
    /// is one of the caller's own dynamics ([`of`](Self::of)): the scene's dynamics would give another motion.
    pub fn at(&self, time: f64) -> Result<Exposure, SimulateError> {
        let time = within(self.scene, time);
        let moments = Moments::of(self.scene).with(time);
        if let Some(moment) = self.recording.moment_at(time)
            && moments.times_of(time).all(|time| self.recording.moment_at(time).is_some())
        {
            return exposure(self.scene, &self.recording, moment);
        }
        if let Some(breakdown) = &self.breakdown {
            return Err(breakdown.clone());
        }
        if self.of_own_dynamics {
            let message =
                format!("t = {time} s was not recorded, and a run of your own dynamics cannot be repeated");
            return Err(SimulateError::Recording(message));
        }
        let store = Box::<MemoryStore>::default();
        let mut recorder = Recorder::new(self.scene, moments, &PairCounter::default(), store);
        while recorder.advance()?.is_some() {}
        let Recorder { recording, .. } = recorder;
        let moment = recording.moment_at(time);
        let lost = || SimulateError::Recording(format!("t = {time} s was not recorded"));
        exposure(self.scene, &recording, moment.ok_or_else(lost)?)
    }
}

fn exposure(scene: &Scene, recording: &Arc<Recording>, moment: usize) -> Result<Exposure, SimulateError> {
    let frames = Frames::recorded(scene, recording);
    let (frame, history, clouds) = frames.recorded_moment(moment, recording.frame_at(moment))?;
    Ok(Exposure::new(frame, history, clouds, (Arc::clone(recording), moment + 1), &scene.simulation.timeline))
}

/// Reads all frames of a recording, and passes each to the surveyor and to `seen`.
fn see_all(
    recording: &Arc<Recording>,
    surveyor: &mut Surveyor<'_>,
    seen: &mut dyn FnMut(&Frame),
) -> Result<(), SimulateError> {
    let lost = || SimulateError::Recording("the recording lacks frames".to_owned());
    let mut reader = recording.read();
    for index in 0..recording.frames() {
        reader.seek_frame(index);
        let entry = reader.entry()?.ok_or_else(lost)?;
        if entry.frame != Some(index) {
            return Err(lost());
        }
        let frame = Frame::of_entry(index, entry);
        surveyor.see(&frame);
        seen(&frame);
    }
    Ok(())
}

/// The saved state of an unfinished run, from which the run can be resumed.
pub struct Checkpoint {
    /// The index of the recording so far, as returned by [`Recording::index`].
    pub index: Vec<u8>,
    /// The state of the simulation as bytes.
    pub simulation: Vec<u8>,
}

/// Simulates and records a run, frame by frame.
pub struct Recorder<'a> {
    scene: &'a Scene,
    simulation: Simulation<'a>,
    surveyor: Surveyor<'a>,
    recording: Arc<Recording>,
    /// The recorded frames that have not been returned yet. Slow motion has several frames in an interval.
    waiting: VecDeque<Frame>,
    resumed: Option<f64>,
}

impl<'a> Recorder<'a> {
    /// Creates a recorder at the start of a run. `pair_counter` counts the evaluated interactions between pairs of bodies.
    pub fn new(
        scene: &'a Scene,
        moments: Moments,
        pair_counter: &PairCounter,
        store: Box<dyn Store>,
    ) -> Recorder<'a> {
        Recorder::of(scene, Simulation::new(scene, moments, pair_counter), store)
    }

    fn of(scene: &'a Scene, simulation: Simulation<'a>, store: Box<dyn Store>) -> Recorder<'a> {
        let recording = Arc::new(Recording::new(Counts::of(scene), store));
        let (surveyor, waiting) = (Surveyor::new(scene), VecDeque::new());
        Recorder { scene, simulation, surveyor, recording, waiting, resumed: None }
    }

    /// Resumes a run from its checkpoint. The store must hold all recorded pages. `seen` receives every recorded frame. Returns `None` if
    /// the checkpoint is invalid or a page is damaged.
    pub fn resume(
        scene: &'a Scene,
        moments: Moments,
        pair_counter: &PairCounter,
        checkpoint: &Checkpoint,
        store: Box<dyn Store>,
        seen: &mut dyn FnMut(&Frame),
    ) -> Option<Recorder<'a>> {
        let mut simulation = Simulation::new(scene, moments, pair_counter);
        if !simulation.resume(&checkpoint.simulation) {
            return None;
        }
        let recording = Recording::to_be_continued(Counts::of(scene), &checkpoint.index, store).ok()?;
        let recording = Arc::new(recording);
        let mut surveyor = Surveyor::new(scene);
        see_all(&recording, &mut surveyor, seen).ok()?;
        let resumed = recording.frames().checked_sub(1).map(|frame| scene.simulation.timeline.time(frame));
        Some(Recorder { scene, simulation, surveyor, recording, waiting: VecDeque::new(), resumed })
    }

    /// Creates a checkpoint at the present frame. Returns `None` if the dynamics cannot be resumed from this state.
    ///
    /// # Errors
    /// If the store has no room for the recording.
    pub fn checkpoint(&mut self) -> io::Result<Option<Checkpoint>> {
        let Some(simulation) = self.simulation.checkpoint() else { return Ok(None) };
        Ok(Some(Checkpoint { index: self.recording.index()?, simulation }))
    }

    /// Creates a recorder as [`new`](Self::new) does, but one that writes to the given empty recording.
    pub fn into(
        scene: &'a Scene,
        moments: Moments,
        pair_counter: &PairCounter,
        recording: Arc<Recording>,
    ) -> Recorder<'a> {
        let simulation = Simulation::new(scene, moments, pair_counter);
        let (surveyor, waiting) = (Surveyor::new(scene), VecDeque::new());
        Recorder { scene, simulation, surveyor, recording, waiting, resumed: None }
    }

    /// The simulated time at which an interrupted run was resumed, s. `None` if the run was never interrupted.
    pub fn resumed(&self) -> Option<f64> {
        self.resumed
    }

    /// The recording, which can be read while the run continues.
    pub fn recording(&self) -> &Arc<Recording> {
        &self.recording
    }

    /// Simulates up to the next frame, and returns it without trails, ghosts and particles. Returns `None` after the end.
    ///
    /// # Errors
    /// If the run becomes non-finite, or the store has no room for the recording.
    pub fn advance(&mut self) -> Result<Option<Frame>, SimulateError> {
        let Self { simulation, surveyor, recording, waiting, .. } = self;
        let mut failed: Option<io::Error> = None;
        while waiting.is_empty() && failed.is_none() {
            let goes_on = simulation.advance(&mut |entry| {
                failed = failed.take().or(recording.push(&entry).err());
                if let Some(index) = entry.frame {
                    waiting.push_back(Frame::of_entry(index, entry));
                }
            })?;
            if !goes_on {
                break;
            }
        }
        if let Some(error) = failed {
            return Err(error.into());
        }
        let frame = waiting.pop_front();
        if let Some(frame) = &frame {
            surveyor.see(frame);
        }
        Ok(frame)
    }

    /// The box around all bodies and particles in the frames so far. `None` if all bodies are planes.
    pub fn bounds(&self) -> Option<super::Bounds> {
        self.surveyor.bounds()
    }

    /// Returns the recorded run after its last frame.
    ///
    /// # Errors
    /// If the store has no room for the recording.
    pub fn finish(self) -> Result<Recorded<'a>, SimulateError> {
        self.finish_after(None)
    }

    /// Returns the part of the run before a breakdown. A diverging run is wrong long before it stops, so it is refused as a whole.
    ///
    /// # Errors
    /// Returns the breakdown if there is no frame before it or the run diverged. Also fails if the store has no room for the recording.
    pub fn finish_early(self, breakdown: SimulateError) -> Result<Recorded<'a>, SimulateError> {
        if matches!(breakdown, SimulateError::Recording(_) | SimulateError::Diverged(_)) {
            return Err(breakdown);
        }
        let recorded = self.finish_after(Some(breakdown.clone()))?;
        if recorded.whole_frames() > 0 { Ok(recorded) } else { Err(breakdown) }
    }

    fn finish_after(self, breakdown: Option<SimulateError>) -> Result<Recorded<'a>, SimulateError> {
        let Recorder { scene, surveyor, recording, resumed, .. } = self;
        recording.index()?;
        Ok(Recorded { breakdown, resumed, ..Recorded::of_parts(scene, recording, surveyor.finish()) })
    }
}
