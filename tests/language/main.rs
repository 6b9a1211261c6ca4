//! The language of scenes: what is right, what is wrong, and what is said of it.
#![allow(clippy::unwrap_used, clippy::panic, unreachable_pub, reason = "these are tests")]

mod diagnostics;
mod explanations;
mod include;
mod mistakes;
mod schema;
#[path = "../support/mod.rs"]
mod support;
mod trust;
#[cfg(feature = "tests-with-tools")]
mod with_tools;
