//! The documentation: its pages are true, up to date, and name only what there is.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test stops at the first surprise")]

mod help;
mod page;
mod pages;
mod reference;
#[path = "../support/mod.rs"]
mod support;
#[cfg(feature = "tests-with-tools")]
mod with_tools;
