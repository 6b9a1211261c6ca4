//! Tests of the language of scenes: valid scenes, mistakes, and the diagnostics for them.
#![allow(clippy::unwrap_used, clippy::panic, unreachable_pub, reason = "these are tests")]

mod diagnostics;
mod editor;
mod explanations;
mod include;
mod mistakes;
mod schema;
#[path = "../support/mod.rs"]
mod support;
mod trust;
#[cfg(feature = "tests-with-tools")]
mod with_tools;
