//! Work on many processor cores at once, or on one without the feature `threads`. The results are the same bit for bit.

#[cfg(feature = "threads")]
pub(crate) use rayon::join;

/// Calls both, one after the other.
#[cfg(not(feature = "threads"))]
pub(crate) fn join<A, B>(one: impl FnOnce() -> A, other: impl FnOnce() -> B) -> (A, B) {
    (one(), other())
}

/// Calls `work` with each of the items.
#[cfg(feature = "threads")]
pub(crate) fn each<T: Send>(items: &mut [T], work: impl Fn(&mut T) + Send + Sync) {
    use rayon::iter::{IntoParallelRefMutIterator, ParallelIterator};

    items.par_iter_mut().for_each(work);
}

/// Calls `work` with each of the items.
#[cfg(not(feature = "threads"))]
pub(crate) fn each<T>(items: &mut [T], work: impl Fn(&mut T)) {
    items.iter_mut().for_each(work);
}
