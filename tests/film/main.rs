//! Films and contact sheets, by real ffmpeg; ffprobe and ffmpeg tell what is in them.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "these are tests")]

mod colors;
mod contact_sheet;
mod failures;
mod frames;
mod gif;
mod images;
mod probe;
