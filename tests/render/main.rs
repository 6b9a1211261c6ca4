//! Tests of `jabuka render` with real POV-Ray: the images are right, nothing is rendered twice, and failures during a long render do no
//! damage.
#![cfg(feature = "tests-with-tools")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "these are tests")]

mod again;
mod commands;
mod crowded;
mod faults;
mod film;
mod folders;
mod killed;
mod pictures;
mod sandbox;
mod scene;
#[allow(unreachable_pub, reason = "a test program has no outside")]
#[path = "../support/mod.rs"]
mod support;
mod terminal;
