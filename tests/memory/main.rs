//! Memory: inner loops allocate nothing, and small scenes take little. An allocator that counts stands behind all of
//! this program, so it holds no other tests.
#![allow(clippy::unwrap_used, clippy::panic, reason = "these are tests")]

mod allocations;
mod bounds;
