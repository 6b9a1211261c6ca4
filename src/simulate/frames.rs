//! An iterator over the frames of a run.

use std::collections::VecDeque;
use std::sync::Arc;

use super::particles::Clouds;
use super::past::History;
use super::recording::{Reader, Recording};
use super::simulation::{Entry, Simulation};
use super::{Frame, Moments, SimulateError};
use crate::physics::PairCounter;
use crate::scene::Scene;

/// An iterator over the frames of a run. Each frame is simulated or read on demand.
///
/// The scene holds the initial state. Another `Frames` of the same scene therefore restarts the run, and gives the same frames, bit for
/// bit.
pub struct Frames<'a> {
    scene: &'a Scene,
    source: Source<'a>,
    history: History,
    clouds: Clouds,
}

/// The source of a run's moments: a simulation or a recording.
enum Source<'a> {
    /// A running simulation, and a queue of computed moments that have not been returned.
    Live(Simulation<'a>, VecDeque<Entry>),
    /// A recording, and a reader of its moments.
    Recorded(Arc<Recording>, Reader),
}

impl<'a> Frames<'a> {
    /// Simulates the frames of a scene from its initial state, on demand.
    pub fn new(scene: &'a Scene) -> Frames<'a> {
        Frames::watched(scene, &PairCounter::default())
    }

    /// Simulates the frames of a scene as [`new`](Self::new) does. `pair_counter` counts the evaluated interactions between pairs of
    /// bodies.
    pub fn watched(scene: &'a Scene, pair_counter: &PairCounter) -> Frames<'a> {
        Frames::with(scene, Moments::of_ghosts(scene), pair_counter)
    }

    fn with(scene: &'a Scene, moments: Moments, pair_counter: &PairCounter) -> Frames<'a> {
        let simulation = Simulation::new(scene, moments, pair_counter);
        let source = Source::Live(simulation, VecDeque::new());
        Frames::from(scene, source)
    }

    fn from(scene: &'a Scene, source: Source<'a>) -> Frames<'a> {
        Frames { scene, source, history: History::new(scene), clouds: Clouds::new(scene) }
    }

    /// Reads the frames of a recorded run.
    pub fn recorded(scene: &'a Scene, recording: &Arc<Recording>) -> Frames<'a> {
        let source = Source::Recorded(Arc::clone(recording), recording.read());
        Frames::from(scene, source)
    }

    /// Simulates a scene up to a time (s), and returns its state at that time. At the time of a frame, the result equals that frame, bit
    /// for bit. A time outside the run gives the run's first or last moment.
    ///
    /// # Errors
    /// If the run becomes non-finite before that time.
    pub fn at(scene: &Scene, time: f64) -> Result<Frame, SimulateError> {
        let time = within(scene, time);
        let moments = Moments::of_ghosts(scene).with(time);
        Frames::with(scene, moments, &PairCounter::default()).moment(time)
    }

    /// Returns the first moment at a time (s) or later, with its trails, ghosts and particles.
    fn moment(mut self, time: f64) -> Result<Frame, SimulateError> {
        let mut before = 0;
        while let Some(entry) = self.entry()? {
            before = entry.frame.unwrap_or(before);
            if entry.snapshot.time >= time {
                self.history.note_moment(&entry);
                return Ok(self.see(entry.frame.is_some(), Frame::of_entry(before, entry)));
            }
            self.remember(entry);
        }
        Err(SimulateError::Recording("the recording ends before this time".to_owned()))
    }

    /// Returns a moment of the recording by its number, with its trails, ghosts and particles, and the state needed to read on. `index` is
    /// the number of the frame at or before the moment.
    pub(super) fn recorded_moment(
        mut self,
        moment: usize,
        index: usize,
    ) -> Result<(Frame, History, Clouds), SimulateError> {
        self.clouds.begin_at(self.clouds.first_frame(index));
        if let Source::Recorded(_, reader) = &mut self.source
            && self.history.is_idle()
        {
            match self.clouds.is_idle() {
                true => reader.seek(moment),
                false => _ = reader.seek_frame(self.clouds.first_frame(index)),
            }
        }
        while let Some(entry) = self.entry()? {
            if self.position() > moment {
                self.history.note_moment(&entry);
                let frame = self.see(entry.frame.is_some(), Frame::of_entry(index, entry));
                return Ok((frame, self.history, self.clouds));
            }
            self.remember(entry);
        }
        Err(SimulateError::Recording("the recording ends before this time".to_owned()))
    }

    /// True if frames have trails, ghosts or delayed camera targets.
    pub fn remember_anything(&self) -> bool {
        !self.history.is_idle()
    }

    /// The number of the next moment of the recording. 0 for a simulated run.
    pub(super) fn position(&self) -> usize {
        match &self.source {
            Source::Recorded(_, reader) => reader.position(),
            Source::Live(..) => 0,
        }
    }

    /// The trails, ghosts and delayed camera targets up to the last frame.
    pub(super) fn history(&self) -> &History {
        &self.history
    }

    /// The particles at the last frame.
    pub(super) fn clouds(&self) -> &Clouds {
        &self.clouds
    }

    /// Moves to a frame of the recording. Skips earlier frames, except those that its trails, ghosts or particles depend on.
    pub(super) fn pass_to(&mut self, frame: usize) {
        let Source::Recorded(recording, reader) = &mut self.source else { return };
        if self.clouds.is_idle() {
            if self.history.is_idle() {
                reader.seek_frame(frame);
            }
            return;
        }
        let next = recording.frame_at(reader.position());
        if self.clouds.go_on_to(frame, next) {
            return;
        }
        let first = self.clouds.first_frame(frame);
        self.clouds.begin_at(first);
        if self.history.is_idle() {
            reader.seek_frame(first);
        }
    }

    /// Restarts the run: the next frame is the first one.
    pub fn reset(&mut self) {
        *self = match &self.source {
            Source::Live(..) => Frames::new(self.scene),
            Source::Recorded(recording, _) => Frames::recorded(self.scene, recording),
        };
    }

    /// Returns the next moment of the run. `None` after the end.
    fn entry(&mut self) -> Result<Option<Entry>, SimulateError> {
        match &mut self.source {
            Source::Recorded(_, reader) => Ok(reader.entry()?),
            Source::Live(simulation, waiting) => {
                while waiting.is_empty() {
                    if !simulation.advance(&mut |entry| waiting.push_back(entry))? {
                        return Ok(None);
                    }
                }
                Ok(waiting.pop_front())
            }
        }
    }

    fn remember(&mut self, entry: Entry) {
        self.history.note_moment(&entry);
        if let Some(index) = entry.frame {
            let frame = Frame::of_entry(index, entry);
            self.clouds.note(&frame);
            self.history.note(&frame);
        }
    }

    /// Adds particles, trails, ghosts and delayed camera targets to a moment.
    fn see(&mut self, is_frame: bool, mut moment: Frame) -> Frame {
        if is_frame {
            self.clouds.note(&moment);
            moment.particles = self.clouds.now();
        } else {
            moment.particles = self.clouds.at(&moment);
        }
        if self.history.is_idle() {
            return moment;
        }
        if is_frame {
            self.history.note(&moment);
        }
        moment.past = self.history.before(&moment);
        moment
    }
}

impl Iterator for Frames<'_> {
    type Item = Result<Frame, SimulateError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            match self.entry() {
                Ok(Some(entry)) => {
                    let Some(index) = entry.frame else {
                        self.remember(entry);
                        continue;
                    };
                    if !self.history.is_idle() {
                        self.history.note_moment(&entry);
                    }
                    return Some(Ok(self.see(true, Frame::of_entry(index, entry))));
                }
                Ok(None) => return None,
                Err(error) => return Some(Err(error)),
            }
        }
    }
}

/// Limits a time (s) to the duration of a run.
pub fn within(scene: &Scene, time: f64) -> f64 {
    let simulation = &scene.simulation;
    let end = simulation.timeline.latest();
    if time > 0.0 { time.min(end) } else { 0.0 }
}

impl From<std::io::Error> for SimulateError {
    fn from(error: std::io::Error) -> SimulateError {
        SimulateError::Recording(error.to_string())
    }
}
