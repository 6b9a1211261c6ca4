//! Advances several runs side by side, frame by frame, so that they can be compared without storing them.

use super::Stopped;
use crate::physics::Snapshot;
use crate::scene::Scene;
use crate::simulate::{SimulateError, Snapshots};
use crate::threads;

/// A progress callback. It receives the number of force evaluations since its previous call, and returns false to stop the computation.
pub type Watch<'a> = dyn FnMut(f64) -> bool + 'a;

/// A run that broke down before its last frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Ended {
    /// The time of the last computed frame, s. `None` if the run has no frame.
    pub after: Option<f64>,
    /// The error that ended the run.
    pub why: SimulateError,
}

/// A run that advances side by side with others.
pub(super) struct ComparedRun<'a> {
    snapshots: Snapshots<'a>,
    /// The computed frames that have not been compared yet, oldest first.
    waiting: std::collections::VecDeque<Snapshot>,
    pub(super) ended: Option<Ended>,
    last: Option<f64>,
    /// The approximate number of force evaluations from one frame to the next.
    cost: f64,
    /// The largest allowed number of timesteps, and whether the run has exceeded it (`is_long`).
    most: u64,
    pub(super) is_long: bool,
}

impl<'a> ComparedRun<'a> {
    /// Starts the run of a scene. `cost` is its number of force evaluations per frame.
    pub(super) fn new(scene: &'a Scene, cost: f64) -> ComparedRun<'a> {
        let waiting = std::collections::VecDeque::new();
        let snapshots = Snapshots::new(scene);
        ComparedRun { snapshots, waiting, ended: None, last: None, cost, most: u64::MAX, is_long: false }
    }

    /// Limits the run to about `steps` timesteps. This is for adaptive methods, whose number of timesteps is unknown in advance.
    pub(super) fn of_at_most(self, steps: u64) -> ComparedRun<'a> {
        ComparedRun { most: steps, ..self }
    }

    /// Returns the number of timesteps of the run so far.
    pub(super) fn steps(&self) -> u64 {
        self.snapshots.steps()
    }

    fn advance(&mut self, frames: usize) {
        for _ in 0..frames {
            self.is_long |= self.steps() > self.most;
            if self.ended.is_some() || self.is_long {
                return;
            }
            match self.snapshots.next() {
                Some(Ok(snapshot)) => {
                    self.last = Some(snapshot.time);
                    self.waiting.push_back(snapshot);
                }
                Some(Err(why)) => self.ended = Some(Ended { after: self.last, why }),
                None => return,
            }
        }
    }
}

/// Advances all runs to the last frame of the scene. At each frame, `see` receives the snapshot of every run, `None` for a run that has
/// ended.
pub(super) fn together(
    runs: &mut [ComparedRun<'_>],
    scene: &Scene,
    watch: &mut Watch<'_>,
    see: &mut dyn FnMut(&[Option<Snapshot>]),
) -> Result<(), Stopped> {
    /// The largest number of body states that wait in memory for their comparison, per run.
    const MAX_WAITING_STATES: usize = 4096;
    let (frames, room) =
        (scene.simulation.timeline.frames(), (MAX_WAITING_STATES / scene.bodies.len().max(1)).clamp(1, 64));
    let mut done = 0;
    while done < frames && runs.iter().any(|run| run.ended.is_none() && !run.is_long) {
        let now = room.min(frames - done);
        threads::each(runs, |run| run.advance(now));
        for _ in 0..now {
            let seen: Vec<Option<Snapshot>> = runs.iter_mut().map(|run| run.waiting.pop_front()).collect();
            if seen.iter().any(Option::is_some) {
                see(&seen);
            }
        }
        done += now;
        let cost: f64 = runs.iter().map(|run| run.cost).sum();
        #[allow(clippy::cast_precision_loss, reason = "there are at most 64")]
        let cost = cost * now as f64;
        if !watch(cost) {
            return Err(Stopped);
        }
    }
    Ok(())
}
