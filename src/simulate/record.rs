//! A scene simulated once: its recording, and figures on the whole run.

use std::io;
use std::sync::Arc;

use super::frames::within;
use super::particles::Clouds;
use super::past::History;
use super::recording::{Counts, MemoryStore, Recording, Store};
use super::simulation::Simulation;
use super::{Exposure, Frame, Frames, Moments, Selection, SimulateError, Survey, Surveyor};
use crate::dynamics::{Dynamics, Effort, Impact};
use crate::scene::Scene;

/// A simulated run, which can be read in any order to draw, measure or export it.
#[derive(Clone)]
pub struct Recorded<'a> {
    scene: &'a Scene,
    recording: Arc<Recording>,
    survey: Survey,
    /// The reason why it ended before its last frame, if it did.
    breakdown: Option<SimulateError>,
    /// The time at which it was resumed, s.
    resumed: Option<f64>,
}

impl<'a> Recorded<'a> {
    /// Simulates a scene, and keeps the recording in memory.
    ///
    /// # Errors
    /// If the run becomes non-finite.
    pub fn new(scene: &'a Scene) -> Result<Recorded<'a>, SimulateError> {
        let store = Box::<MemoryStore>::default();
        let mut recorder = Recorder::new(scene, Moments::of(scene), &Effort::default(), store);
        while recorder.advance()?.is_some() {}
        recorder.finish()
    }

    /// Simulates a scene with the caller's own dynamics, at time 0. Its bodies have the indices of the scene. Moments that the scene does
    /// not request are not recorded: [`at`](Self::at) computes them by the scene's own forces and method.
    ///
    /// # Errors
    /// If the run becomes non-finite.
    pub fn of(scene: &'a Scene, dynamics: Box<dyn Dynamics>) -> Result<Recorded<'a>, SimulateError> {
        let simulation = Simulation::of(scene, Moments::of(scene), dynamics);
        let mut recorder = Recorder::of(scene, simulation, Box::<MemoryStore>::default());
        while recorder.advance()?.is_some() {}
        recorder.finish()
    }

    /// A run that was simulated and surveyed elsewhere.
    pub fn of_parts(scene: &'a Scene, recording: Arc<Recording>, survey: Survey) -> Recorded<'a> {
        Recorded { scene, recording, survey, breakdown: None, resumed: None }
    }

    /// A run that was recorded earlier; `seen` receives every frame. The survey depends on the drawing, so it reads all frames.
    ///
    /// # Errors
    /// If the recording cannot be read.
    pub fn read(
        scene: &'a Scene,
        recording: Arc<Recording>,
        mut seen: impl FnMut(&Frame),
    ) -> Result<Recorded<'a>, SimulateError> {
        if recording.frames() != scene.simulation.frames() {
            return Err(SimulateError::Recording("the recording lacks frames".to_owned()));
        }
        let mut surveyor = Surveyor::new(scene);
        see_all(&recording, &mut surveyor, &mut seen)?;
        Ok(Recorded::of_parts(scene, recording, surveyor.finish()))
    }

    /// The scene.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Figures on the whole run.
    pub fn survey(&self) -> &Survey {
        &self.survey
    }

    /// The moments of the run.
    pub fn recording(&self) -> &Arc<Recording> {
        &self.recording
    }

    /// The reason why the run ended before its last frame, if it did.
    pub fn breakdown(&self) -> Option<&SimulateError> {
        self.breakdown.as_ref()
    }

    /// The time (s) at which the run was resumed, if it had been stopped.
    pub fn resumed(&self) -> Option<f64> {
        self.resumed
    }

    /// The number of frames that can be drawn: all, unless the run broke down. A frame counts if all moments of its open shutters were
    /// recorded as well.
    pub fn whole_frames(&self) -> usize {
        let moments = Moments::of(self.scene);
        let is_recorded = |time| self.recording.moment_at(time).is_some();
        let is_whole = |frame: usize| moments.times_of(moments.time(frame)).all(is_recorded);
        let frames = self.recording.frames();
        if self.breakdown.is_none() {
            return frames;
        }
        (0..frames).rev().find(|&frame| is_whole(frame)).map_or(0, |last| last + 1)
    }

    /// All frames, from the first on.
    pub fn frames(&self) -> Frames<'a> {
        Frames::recorded(self.scene, &self.recording)
    }

    /// All impacts of the run, in the order in which they happened.
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

    /// The selected frames, each with the run from there on as far as shutters are open.
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
                        // Only readers that continue from there need the past.
                        let before = match is_exposed {
                            true => (frames.history().clone(), frames.clouds().clone()),
                            false => (History::default(), Clouds::new(scene)),
                        };
                        return Some(Ok(Exposure::new(frame, before, rest)));
                    }
                    Err(error) => return Some(Err(error)),
                }
            }
        })
    }

    /// The moment at any time (s), and the run from there on as far as shutters are open. Times outside the run give its first or last
    /// moment. A moment that was not recorded is simulated again.
    ///
    /// # Errors
    /// If the run becomes non-finite before that time, or the recording cannot be read.
    pub fn at(&self, time: f64) -> Result<Exposure, SimulateError> {
        let time = within(self.scene, time);
        let moments = Moments::of(self.scene).with(time);
        if let Some(moment) = self.recording.moment_at(time)
            && moments.times_of(time).all(|time| self.recording.moment_at(time).is_some())
        {
            return exposure(self.scene, &self.recording, moment);
        }
        let store = Box::<MemoryStore>::default();
        let mut recorder = Recorder::new(self.scene, moments, &Effort::default(), store);
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
    Ok(Exposure::new(frame, (history, clouds), (Arc::clone(recording), moment + 1)))
}

/// Reads all frames of a recording.
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

/// A moment of a run from which it can be resumed.
pub struct Checkpoint {
    /// The description of the recording so far, as [`Recording::index`] gives it.
    pub index: Vec<u8>,
    /// The state of the run.
    pub simulation: Vec<u8>,
}

/// Simulates and records a run, frame by frame.
pub struct Recorder<'a> {
    scene: &'a Scene,
    simulation: Simulation<'a>,
    surveyor: Surveyor<'a>,
    recording: Arc<Recording>,
    resumed: Option<f64>,
}

impl<'a> Recorder<'a> {
    /// A recorder of a run that has not begun. `effort` counts the pair interactions.
    pub fn new(scene: &'a Scene, moments: Moments, effort: &Effort, store: Box<dyn Store>) -> Recorder<'a> {
        Recorder::of(scene, Simulation::new(scene, moments, effort), store)
    }

    fn of(scene: &'a Scene, simulation: Simulation<'a>, store: Box<dyn Store>) -> Recorder<'a> {
        let recording = Arc::new(Recording::new(Counts::of(scene), store));
        Recorder { scene, simulation, surveyor: Surveyor::new(scene), recording, resumed: None }
    }

    /// Resumes from a checkpoint of the same run, whose recorded pages are all in the store; `seen` receives every recorded frame. `None`
    /// if the checkpoint is invalid, or a page is damaged.
    pub fn resume(
        scene: &'a Scene,
        moments: Moments,
        effort: &Effort,
        (checkpoint, store): (&Checkpoint, Box<dyn Store>),
        seen: &mut dyn FnMut(&Frame),
    ) -> Option<Recorder<'a>> {
        let mut simulation = Simulation::new(scene, moments, effort);
        if !simulation.resume(&checkpoint.simulation) {
            return None;
        }
        let recording = Recording::to_be_continued(Counts::of(scene), &checkpoint.index, store).ok()?;
        let recording = Arc::new(recording);
        let mut surveyor = Surveyor::new(scene);
        see_all(&recording, &mut surveyor, seen).ok()?;
        let resumed = recording.frames().checked_sub(1).map(|frame| scene.simulation.time(frame));
        Some(Recorder { scene, simulation, surveyor, recording, resumed })
    }

    /// A checkpoint of the present moment, which must be that of a frame. `None` if the run cannot be resumed from it.
    ///
    /// # Errors
    /// If there is no room for the recording.
    pub fn checkpoint(&mut self) -> io::Result<Option<Checkpoint>> {
        let Some(simulation) = self.simulation.checkpoint() else { return Ok(None) };
        Ok(Some(Checkpoint { index: self.recording.index()?, simulation }))
    }

    /// Like [`new`](Self::new), with an empty recording.
    pub fn into(
        scene: &'a Scene,
        moments: Moments,
        effort: &Effort,
        recording: Arc<Recording>,
    ) -> Recorder<'a> {
        let simulation = Simulation::new(scene, moments, effort);
        Recorder { scene, simulation, surveyor: Surveyor::new(scene), recording, resumed: None }
    }

    /// The time (s) at which the run was resumed, if it had been stopped.
    pub fn resumed(&self) -> Option<f64> {
        self.resumed
    }

    /// The recording, which can be read while it grows.
    pub fn recording(&self) -> &Arc<Recording> {
        &self.recording
    }

    /// Simulates up to the next frame, and returns it without its past; `None` after the end.
    ///
    /// # Errors
    /// If the run becomes non-finite, or there is no room for it.
    pub fn advance(&mut self) -> Result<Option<Frame>, SimulateError> {
        let Self { simulation, surveyor, recording, .. } = self;
        let (mut seen, mut failed): (_, Option<io::Error>) = (None, None);
        while seen.is_none() && failed.is_none() {
            let goes_on = simulation.advance(&mut |entry| {
                failed = failed.take().or(recording.push(&entry).err());
                if let Some(index) = entry.frame {
                    seen = Some(Frame::of_entry(index, entry));
                }
            })?;
            if !goes_on {
                break;
            }
        }
        if let Some(error) = failed {
            return Err(error.into());
        }
        if let Some(frame) = &seen {
            surveyor.see(frame);
        }
        Ok(seen)
    }

    /// The box around everything so far.
    pub fn bounds(&self) -> Option<super::Bounds> {
        self.surveyor.bounds()
    }

    /// The simulated run.
    ///
    /// # Errors
    /// If there is no room for it.
    pub fn finish(self) -> Result<Recorded<'a>, SimulateError> {
        self.finish_after(None)
    }

    /// The part of the run before a breakdown. A run that diverges is wrong long before it stops, so none of it is returned.
    ///
    /// # Errors
    /// Returns the breakdown if there is no frame before it or the run diverged. Also fails if there is no room for the
    /// recording.
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
        Ok(Recorded { scene, recording, survey: surveyor.finish(), breakdown, resumed })
    }
}
