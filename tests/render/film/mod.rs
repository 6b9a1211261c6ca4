//! Films and contact sheets, by real ffmpeg; ffprobe and ffmpeg tell what is in them.

mod colors;
mod contact_sheet;
mod failures;
mod frames;
mod gif;
mod images;
mod probe;
