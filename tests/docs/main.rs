//! Tests of the documentation: every page is correct and up to date, and names only existing commands, options and files.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test stops at the first surprise")]

mod gallery;
mod help;
mod page;
mod pages;
mod reference;
mod stages;
#[path = "../support/mod.rs"]
mod support;
#[cfg(feature = "tests-with-tools")]
mod with_tools;
