//! Progress of forces between pairs, for progress bars.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Counts the computed pair interactions. One evaluation of a hundred thousand bodies takes seconds, so steps are too coarse to show
/// progress. Clones share one counter. A run does not depend on it.
#[derive(Clone, Debug, Default)]
pub struct Effort(Arc<AtomicU64>);

impl Effort {
    /// Adds to the count.
    pub(super) fn add(&self, interactions: usize) {
        self.0.fetch_add(interactions as u64, Ordering::Relaxed);
    }

    /// The count so far.
    #[must_use]
    pub fn done(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}
