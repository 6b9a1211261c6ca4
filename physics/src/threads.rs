//! Runs work on several processor cores, or on one core without the feature `threads`. The results have the same bits in both cases.

#[cfg(feature = "threads")]
pub(crate) use rayon::join;

/// Calls both functions, one after the other, and returns both results.
#[cfg(not(feature = "threads"))]
pub(crate) fn join<A, B>(one: impl FnOnce() -> A, other: impl FnOnce() -> B) -> (A, B) {
    (one(), other())
}
