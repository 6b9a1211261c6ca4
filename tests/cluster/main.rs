//! Tests of rendering on many machines: `jabuka batch`, the job folders that it writes, and `jabuka status`.
//!
//! These tests need bash, POV-Ray, ffmpeg, Slurm and munge, GNU parallel, shellcheck, and Python for Open Job Description; `tests/run`
//! installs them.
#![cfg(feature = "tests-with-tools")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test stops at the first surprise"
)]

mod batch;
mod chunk;
mod hostile;
mod job;
mod openjd;
mod recipes;
mod slurm;
#[path = "../support/mod.rs"]
mod support;
