//! Tests that lead from the text of a scene to its frames, scripts, tables and reports.
#![allow(clippy::unwrap_used, clippy::panic, unreachable_pub, reason = "these are tests")]

mod color_maps;
mod coming_and_going;
mod contacts;
mod digests;
mod first;
mod followed;
mod given_motion;
mod joints;
mod looks;
mod many;
mod measures;
mod not_drawn;
mod particles;
mod particles_and_meshes;
mod particles_stopped;
mod report;
mod snapshots;
#[path = "../support/mod.rs"]
mod support;
