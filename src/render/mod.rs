//! Images → film and contact sheet.
//!
//! | what | from → to | by |
//! | --- | --- | --- |
//! | [`Film`] | images → `.mp4`, `.webm`, `.gif` | ffmpeg, which gets the pixels through a pipe |
//! | [`ContactSheet`] | some of the images → one PNG with their times | jabuka itself |
//!
//! Both take a list of images, so they serve any selection of frames in any folder and under any names. Both write
//! under a temporary name and rename at the end: what was there before stays until the new one is whole.
//! Both say why they could not be made by a [`FilmError`].

mod contact_sheet;
pub mod film;
mod picture;

pub use contact_sheet::{ContactSheet, Shot};
pub use film::{Ffmpeg, Film, FilmError, Format};
