//! A run that is being computed.

use super::build::dynamics;
use super::{Moments, SimulateError};
use crate::dynamics::{Breakdown, Dynamics, Effort, Snapshot};
use crate::scene::Scene;

/// A moment of a run, and whether it is that of a frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    /// The number of the frame; none between two frames.
    pub(super) frame: Option<usize>,
    pub(super) snapshot: Snapshot,
}

/// A run of a scene from its initial state on.
pub(super) struct Simulation<'a> {
    scene: &'a Scene,
    dynamics: Box<dyn Dynamics>,
    moments: Moments,
    next: usize,
    intervals: usize,
}

impl<'a> Simulation<'a> {
    /// One that has not begun; the interactions of pairs are counted meanwhile.
    pub(super) fn new(scene: &'a Scene, moments: Moments, effort: &Effort) -> Simulation<'a> {
        Simulation::of(scene, moments, dynamics(scene, effort))
    }

    /// That of somebody else's dynamics, at time 0.
    pub(super) fn of(scene: &'a Scene, moments: Moments, dynamics: Box<dyn Dynamics>) -> Simulation<'a> {
        let intervals = moments.intervals();
        Simulation { scene, dynamics, moments, next: 0, intervals }
    }

    /// Advances to the next frame, or by the time between two where there are moments after the last; `see` is told of
    /// all moments on the way. It is false after the end.
    pub(super) fn advance(&mut self, see: &mut dyn FnMut(Entry)) -> Result<bool, SimulateError> {
        if self.next > self.intervals {
            return Ok(false);
        }
        let done = self.advance_to_next(see);
        // After what is not finite, nothing could be.
        self.next = if done.is_ok() { self.next + 1 } else { usize::MAX };
        done.map(|()| true).map_err(|error| SimulateError::of(self.scene, error))
    }

    fn advance_to_next(&mut self, see: &mut dyn FnMut(Entry)) -> Result<(), Breakdown> {
        let simulation = &self.scene.simulation;
        if let Some(before) = self.next.checked_sub(1) {
            let moments = self.moments.after(before);
            let mut between = |snapshot| see(Entry { frame: None, snapshot });
            self.dynamics.advance(simulation.time(self.next), &moments, &mut between)?;
        }
        if self.next < simulation.frames() {
            see(Entry { frame: Some(self.next), snapshot: self.dynamics.snapshot()? });
        }
        Ok(())
    }
}
