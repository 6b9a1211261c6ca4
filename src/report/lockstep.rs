//! Several runs that advance side by side, so that they can be compared without storing them.

use super::Stopped;
use crate::dynamics::Snapshot;
use crate::scene::Scene;
use crate::simulate::{SimulateError, Snapshots};
use crate::threads;

/// Receives the amount of computation so far, in force evaluations. Returns false to stop.
pub type Watch<'a> = dyn FnMut(f64) -> bool + 'a;

/// The end of a run before its last frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Ended {
    /// The time of the last frame, s; `None` if there was no frame.
    pub after: Option<f64>,
    /// The reason.
    pub why: SimulateError,
}

/// A run that is compared with others.
pub(super) struct Track<'a> {
    snapshots: Snapshots<'a>,
    /// Computed states that have not been compared yet.
    waiting: std::collections::VecDeque<Snapshot>,
    pub(super) ended: Option<Ended>,
    last: Option<f64>,
    /// The cost of an interval between two frames, in force evaluations.
    cost: f64,
    /// The largest number of timesteps, and whether more would have been needed.
    most: u64,
    pub(super) is_long: bool,
}

impl<'a> Track<'a> {
    /// The run of a scene, with its number of force evaluations per frame.
    pub(super) fn new(scene: &'a Scene, cost: f64) -> Track<'a> {
        let waiting = std::collections::VecDeque::new();
        let snapshots = Snapshots::new(scene);
        Track { snapshots, waiting, ended: None, last: None, cost, most: u64::MAX, is_long: false }
    }

    /// The same with a limit of about this many timesteps, since adaptive methods do not know their number in advance.
    pub(super) fn of_at_most(self, steps: u64) -> Track<'a> {
        Track { most: steps, ..self }
    }

    /// The number of timesteps so far.
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

/// Advances runs of a scene to its end. `see` receives each frame, with the runs that have reached it.
pub(super) fn together(
    tracks: &mut [Track<'_>],
    scene: &Scene,
    watch: &mut Watch<'_>,
    see: &mut dyn FnMut(&[Option<Snapshot>]),
) -> Result<(), Stopped> {
    /// The largest number of states of single bodies that wait for their comparison.
    const ROOM: usize = 4096;
    let (frames, room) = (scene.simulation.frames(), (ROOM / scene.bodies.len().max(1)).clamp(1, 64));
    let mut done = 0;
    while done < frames && tracks.iter().any(|track| track.ended.is_none() && !track.is_long) {
        let now = room.min(frames - done);
        threads::each(tracks, |track| track.advance(now));
        for _ in 0..now {
            let seen: Vec<Option<Snapshot>> =
                tracks.iter_mut().map(|track| track.waiting.pop_front()).collect();
            if seen.iter().any(Option::is_some) {
                see(&seen);
            }
        }
        done += now;
        let cost: f64 = tracks.iter().map(|track| track.cost).sum();
        #[allow(clippy::cast_precision_loss, reason = "there are at most 64")]
        let cost = cost * now as f64;
        if !watch(cost) {
            return Err(Stopped);
        }
    }
    Ok(())
}
