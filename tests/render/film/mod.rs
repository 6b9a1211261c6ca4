//! Tests of films and contact sheets, made by real ffmpeg and examined by ffprobe and ffmpeg.

mod colors;
mod contact_sheet;
mod failures;
mod frames;
mod gif;
mod images;
mod probe;
