//! Tests of the playground: the static page in a real browser, and its module in Node. `playground/build` must have made the page.
#![cfg(feature = "tests-with-tools")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests")]

#[path = "../support/mod.rs"]
mod support;

#[macro_use]
mod site;

mod digests;
mod page;
mod plots;
mod size;
