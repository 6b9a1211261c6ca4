//! Tests of `jabuka preview`: its page in a real browser, and its server.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests")]

#[path = "../support/mod.rs"]
mod support;

mod http;
mod server;

mod access;
mod orders;
mod process;
#[cfg(feature = "tests-with-tools")]
mod with_tools;
