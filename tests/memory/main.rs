//! Tests of memory: inner loops allocate nothing, and short scenes need little. A counting allocator serves the whole program, so other
//! tests must not run in it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "these are tests")]

mod allocations;
mod bounds;
