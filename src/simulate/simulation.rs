//! Runs the simulation of a scene.

use super::build::dynamics;
use super::joint_angles::JointAngles;
use super::{ImpactCounts, Moments, SimulateError};
use crate::physics::{Breakdown, Dynamics, Impact, PairCounter, Snapshot};
use crate::scene::Scene;

/// The state of a run at a frame, or at a requested time between frames.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    /// The number of the frame. `None` between two frames.
    pub(super) frame: Option<usize>,
    pub(super) snapshot: Snapshot,
    /// The impacts since the previous entry.
    pub(super) impacts: Vec<Impact>,
    /// The numbers of impacts from the start of the run.
    pub(super) counts: ImpactCounts,
}

/// A simulation of a scene from its initial state.
pub(super) struct Simulation<'a> {
    scene: &'a Scene,
    dynamics: Box<dyn Dynamics>,
    moments: Moments,
    /// The number of intervals of the timeline that the next advance completes.
    next: usize,
    intervals: usize,
    counts: ImpactCounts,
    angles: JointAngles,
    /// The impacts since the last entry, which will be part of the next entry.
    waiting: Vec<Impact>,
}

impl<'a> Simulation<'a> {
    /// Creates a simulation at the start of its run. `pair_counter` counts the evaluated interactions between pairs of bodies.
    pub(super) fn new(scene: &'a Scene, moments: Moments, pair_counter: &PairCounter) -> Simulation<'a> {
        Simulation::of(scene, moments, dynamics(scene, pair_counter))
    }

    /// Creates a simulation of the caller's own dynamics, which must be at time 0.
    pub(super) fn of(scene: &'a Scene, moments: Moments, dynamics: Box<dyn Dynamics>) -> Simulation<'a> {
        let intervals = moments.intervals();
        let (counts, angles) = (ImpactCounts::new(scene), JointAngles::new(scene));
        Simulation { scene, dynamics, moments, next: 0, intervals, counts, angles, waiting: Vec::new() }
    }

    /// Advances by an interval of the timeline, as far as frames and requested times need. Calls `see` with each moment on the way, including
    /// frames. Returns false after the end of the run.
    pub(super) fn advance(&mut self, see: &mut dyn FnMut(Entry)) -> Result<bool, SimulateError> {
        if self.next > self.intervals {
            return Ok(false);
        }
        let done = self.advance_to_next(see);
        // All states after a non-finite one would be non-finite, too.
        self.next = if done.is_ok() { self.next + 1 } else { usize::MAX };
        done.map(|()| true).map_err(|error| SimulateError::of(self.scene, error))
    }

    /// The number of timesteps since the start of the run.
    pub(super) fn steps(&self) -> u64 {
        self.dynamics.steps()
    }

    /// Saves the present state as bytes, from which [`resume`](Self::resume) continues. `None` if the dynamics has no checkpoints, if the
    /// run is over, or if impacts wait for the next entry.
    pub(super) fn checkpoint(&mut self) -> Option<Vec<u8>> {
        if !self.waiting.is_empty() || self.next > self.intervals {
            return None;
        }
        let dynamics = self.dynamics.checkpoint()?;
        let numbers = [self.next as u64, self.counts.0.len() as u64];
        let mut bytes: Vec<u8> = numbers.into_iter().flat_map(u64::to_le_bytes).collect();
        let counts = self.counts.0.iter().copied().chain(self.angles.numbers());
        bytes.extend(counts.flat_map(f64::to_le_bytes));
        bytes.extend(dynamics);
        Some(bytes)
    }

    /// Continues from a checkpoint of the same run. Returns false if the checkpoint is invalid.
    pub(super) fn resume(&mut self, checkpoint: &[u8]) -> bool {
        let (count, (numbers, _)) = (self.counts.0.len(), checkpoint.as_chunks::<8>());
        let [next, counted, rest @ ..] = numbers else { return false };
        let [next, counted] = [next, counted].map(|number| u64::from_le_bytes(*number));
        let size = count + self.angles.size();
        if next > self.intervals as u64 || counted != count as u64 || rest.len() < size {
            return false;
        }
        let rest: Vec<f64> = rest[..size].iter().map(|number| f64::from_le_bytes(*number)).collect();
        let (counts, angles) = rest.split_at(count);
        self.next = usize::try_from(next).unwrap_or(usize::MAX);
        self.counts = ImpactCounts(counts.to_vec());
        self.angles.resume(angles);
        self.dynamics.resume(&checkpoint[8 * (2 + size)..])
    }

    fn advance_to_next(&mut self, see: &mut dyn FnMut(Entry)) -> Result<(), Breakdown> {
        let simulation = &self.scene.simulation;
        let timeline = &simulation.timeline;
        if let Some(before) = self.next.checked_sub(1) {
            let moments = self.moments.within(before);
            let mut between = Vec::new();
            let counts_impacts = simulation.contacts.is_some();
            let angles = &mut self.angles;
            let done = self.dynamics.advance(timeline.interval_start(self.next), &moments, &mut |snapshot| {
                if counts_impacts {
                    between.push(snapshot);
                } else {
                    see(of_scene(self.scene, angles, snapshot));
                }
            });
            self.see_between(between, see);
            done?;
        }
        if let Some(frame) = timeline.frame_at(timeline.interval_start(self.next)) {
            let snapshot = self.dynamics.snapshot()?;
            let impacts = self.dynamics.impacts();
            let entry = of_scene(self.scene, &mut self.angles, snapshot);
            let entry = self.with_impacts(entry, impacts);
            see(Entry { frame: Some(frame), ..entry });
        }
        Ok(())
    }

    /// Calls `see` with the moments between two frames. Each gets the impacts since the moment before it.
    fn see_between(&mut self, between: Vec<Snapshot>, see: &mut dyn FnMut(Entry)) {
        if between.is_empty() {
            return;
        }
        let mut impacts = self.dynamics.impacts();
        for snapshot in between {
            let later = impacts.split_off(impacts.partition_point(|impact| impact.time <= snapshot.time));
            let entry = of_scene(self.scene, &mut self.angles, snapshot);
            see(self.with_impacts(entry, std::mem::replace(&mut impacts, later)));
        }
        self.waiting.append(&mut impacts);
    }

    /// Adds the impacts since the last entry to a new one, and updates the counts.
    fn with_impacts(&mut self, entry: Entry, impacts: Vec<Impact>) -> Entry {
        let mut all = std::mem::take(&mut self.waiting);
        all.extend(impacts);
        all.iter().for_each(|impact| self.counts.note(self.scene, impact));
        Entry { impacts: all, counts: self.counts.clone(), ..entry }
    }
}

/// Converts a snapshot of the world into an entry without impacts. Removes the ground, which is a body of the world but not of the scene,
/// and completes the joints.
fn of_scene(scene: &Scene, angles: &mut JointAngles, mut snapshot: Snapshot) -> Entry {
    while snapshot.bodies.last().is_some_and(|body| body.id >= scene.bodies.len()) {
        snapshot.bodies.pop();
    }
    angles.see(scene, &mut snapshot);
    let frame = scene.simulation.timeline.frame_at(snapshot.time);
    Entry { frame, snapshot, impacts: Vec::new(), counts: ImpactCounts::default() }
}
