//! Tests of the output folder: the same scene always gives the same bytes, and jabuka changes no files of others.
#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

#[path = "../support/mod.rs"]
mod support;

mod assets;
mod cache_files;
mod check;
mod checkpoint;
mod edited;
mod folder;
mod frames;
mod full;
mod kill;
mod memory;
mod meshes;
mod models;
mod plots;
mod recording;
mod sameness;
mod shutter;
mod stranger;
mod templates;
mod trails;
mod up_to_date;
mod views;
#[cfg(feature = "tests-with-tools")]
mod with_tools;
