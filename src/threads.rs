//! Runs work on several processor cores, or on one core without the feature `threads`. The results have the same bits in both cases.

/// Calls `work` with each of the items, in parallel.
#[cfg(feature = "threads")]
pub(crate) fn each<T: Send>(items: &mut [T], work: impl Fn(&mut T) + Send + Sync) {
    use rayon::iter::{IntoParallelRefMutIterator, ParallelIterator};

    items.par_iter_mut().for_each(work);
}

/// Calls `work` with each of the items, one after another.
#[cfg(not(feature = "threads"))]
pub(crate) fn each<T>(items: &mut [T], work: impl Fn(&mut T)) {
    items.iter_mut().for_each(work);
}
