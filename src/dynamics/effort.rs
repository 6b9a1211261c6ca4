//! Progress of the forces between pairs, for progress bars.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Counts the interactions of pairs that have been computed. One evaluation of a hundred thousand bodies takes seconds,
/// so that steps are too coarse to see that a run goes on. A clone counts into the same number; nothing in a run
/// depends on it.
#[derive(Clone, Debug, Default)]
pub struct Effort(Arc<AtomicU64>);

impl Effort {
    /// Counts some more.
    pub(super) fn add(&self, interactions: usize) {
        self.0.fetch_add(interactions as u64, Ordering::Relaxed);
    }

    /// The number computed so far.
    #[must_use]
    pub fn done(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}
