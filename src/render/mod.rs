//! Renders scripts into images, and makes films from the images.
//!
//! | what | where |
//! | --- | --- |
//! | the scripts of a film in their folder | [`Sequence`] |
//! | the locked folder of the images | [`Images`] |
//! | the digests of an image's inputs | [`Record`] |
//! | the installed POV-Ray, and its options | [`PovRay`], [`options`] |
//! | all images of a sequence, by a pool of POV-Ray processes | [`Job`], its [`Outcome`] |
//! | a frame that POV-Ray cannot render | [`Fault`] |
//! | the mean of images, for motion blur | [`linear_light`] |
//! | films and contact sheets from images | [`Film`], [`ContactSheet`] |
//! | jobs for clusters, and their progress | [`batch`], [`Status`] |
//!
//! # Images
//!
//! POV-Ray waits before and between images, whatever it renders, and hardly uses a second core. So `pool.rs` runs more processes than there
//! are cores, each with one thread. Each process renders a series of frames with POV-Ray's animation loop (`process.rs`): a script of jabuka
//! includes another frame's script for every `frame_number`. The first image is rendered alone, before all others. An image is complete when
//! it ends with the chunk `IEND`; then it is renamed. A process is killed after its last image, since waiting for its end would take longer.
//! The order is coarse to fine (`order.rs`): at any time, the finished images are spread over the whole film.
//!
//! - Each image has a record (`record.rs`) with the digests of the script from line 2 on, of its includes and of the assets; the options;
//!   and POV-Ray's version. Line 1 has the frame's number, so equal pictures have equal records, and are rendered once. A script that uses
//!   `clock` or `frame_number` is rendered by its own process, and its record contains the frame's number. The record also contains the
//!   digest of its image. The check whether an image is up to date does not read the image. `--verify` reads it, and so does copying it for
//!   another frame.
//! - `.jabuka/` among the images holds the records, a lock, failures, and work folders. Each run removes the leftovers of killed runs.
//! - Many failures of POV-Ray look alike. `fault.rs` finds the line of an error and, by the comment at the end of this line, the body. A
//!   process that ended without an image and without a reason is tried again, first alone. A process that uses no CPU time for 20 s counts
//!   as hung. A full disk is detected by a test write.
//! - A child process ends with its parent, even when the parent is killed (`started.rs`).
//! - POV-Ray writes the date of rendering into each image. `undated.rs` removes it before an image gets its name, and so does
//!   `render-chunk`, with the tools of any node. So equal pictures are equal files.
//!
//! # Jobs for clusters
//!
//! Jobs for clusters (`batch/`) use the same records: `render-chunk` writes them in bash, byte for byte, so any machine can tell which
//! images are up to date. `jabuka status` reads the images and never asks the engine. Nothing in a job's settings is executed: `job.conf`
//! and `local.conf` are lines of `KEY=value`, and `settings.sh` and `batch/settings.rs` read them in the same way. Templates are filled in a
//! single pass, so inserted values are never expanded. Names for an engine are reduced to letters, digits and `-_.`.
//!
//! # Films
//!
//! jabuka reads the images itself and pipes their pixels to ffmpeg. So it can name a broken image, and it handles odd sizes and transparency
//! itself. The film is written under a temporary, locked name. It is renamed when ffmpeg has ended well and has counted as many frames as
//! there are images. ffmpeg runs in its own process group, so an interrupt of jabuka does not truncate a film.
//!
//! The palette of a GIF is computed from 32 evenly spaced images, which ffmpeg gets before the film's images. For a palette from all images,
//! ffmpeg would hold all of them in memory. Colors, rates and their limits are described in `film/mod.rs`; `picture/pace.rs` chooses the
//! rate. Whether a film can be made is checked before anything is rendered. jabuka draws the contact sheet itself, and shrinks it in linear
//! light, since a mean of sRGB bytes is too dark.
//!
//! # Crates
//!
//! `resize` makes images smaller, by a polynomial filter with the
//! same result everywhere. The letters of contact sheets and plots are those of `noto-sans-mono-bitmap`: 16 and 20 pixels high, ASCII.
//! `which` finds POV-Ray and ffmpeg.

pub mod batch;
mod contact_sheet;
mod error;
mod exposure;
mod fault;
mod files;
pub mod film;
mod images;
mod inputs;
mod job;
pub mod linear_light;
mod options;
mod order;
mod picture;
mod pool;
mod povray;
mod povray_build;
mod process;
mod record;
mod result_collector;
mod sequence;
mod started;
mod status;
mod undated;

pub use contact_sheet::{ContactSheet, Shot};
pub use error::RenderError;
pub use fault::Fault;
pub use files::{ASSETS, of_scripts};
pub use film::{Ffmpeg, Film, FilmError, Format, Pace};
pub use images::Images;
pub(crate) use images::is_folder_of_images;
pub(crate) use inputs::named;
pub use job::{Event, Job, Outcome};
pub use options::{Quality, options};
pub use povray::PovRay;
pub use povray_build::PovRayBuild;
pub use record::{Compare, Files, HIDDEN_FOLDER, Record, State, Verdict};
pub use sequence::{Script, Sequence};
pub use status::{Failed, Running, Status};
