//! What measures know of the frames so far: swept areas and smallest distances.

use std::sync::Arc;

use super::approaches::Approaches;
use super::sectors::Sweeps;
use super::{Frame, Sector};
use crate::scene::Scene;

/// Collects what measures know of the frames so far.
#[derive(Clone, Default)]
pub(super) struct Tallies {
    sweeps: Sweeps,
    approaches: Approaches,
}

/// What measures know of the frames so far.
#[derive(Clone, Copy, Default)]
pub(super) struct SoFar<'a> {
    /// The complete sectors of each swept area, in order of time.
    pub(super) areas: &'a [Vec<Arc<Sector>>],
    /// The smallest distance of each pair in `approaches` of the scene, m. NaN before both bodies have been present.
    pub(super) closest: &'a [f64],
}

impl Tallies {
    /// Begins at the start of a run.
    pub(super) fn new(scene: &Scene) -> Tallies {
        Tallies { sweeps: Sweeps::new(scene), approaches: Approaches::new(scene) }
    }

    /// True if no measure of the scene depends on earlier frames.
    pub(super) fn is_idle(&self) -> bool {
        let SoFar { areas, closest } = self.so_far();
        areas.is_empty() && closest.is_empty()
    }

    /// Goes on to a frame, or to a moment after the last frame.
    pub(super) fn note(&mut self, frame: &Frame) {
        self.sweeps.note(frame);
        self.approaches.note(frame);
    }

    pub(super) fn so_far(&self) -> SoFar<'_> {
        SoFar { areas: self.sweeps.complete(), closest: self.approaches.closest() }
    }

    /// Returns the complete sectors and the smallest distances.
    pub(super) fn finish(self) -> (Vec<Vec<Arc<Sector>>>, Vec<f64>) {
        (self.sweeps.into_complete(), self.approaches.into_closest())
    }
}
