//! A counter of pair interactions. It lets progress bars advance within a step.
//!
//! With many pairs, the simulation of a frame can take minutes. The forces between pairs count their interactions. The total of a run is
//! computed beforehand, so that the progress bar can move within a frame.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A counter of the computed interactions between pairs of bodies. One evaluation for a hundred thousand bodies takes seconds, so counting
/// steps would be too coarse for a progress bar. Clones share one counter. The counter does not affect the run.
#[derive(Clone, Debug, Default)]
pub struct PairCounter(Arc<AtomicU64>);

impl PairCounter {
    /// Adds a number of computed pair interactions.
    pub(super) fn add(&self, interactions: usize) {
        self.0.fetch_add(interactions as u64, Ordering::Relaxed);
    }

    /// Returns the number of pair interactions computed so far.
    #[must_use]
    pub fn done(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}
