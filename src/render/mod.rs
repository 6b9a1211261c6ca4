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

pub mod batch;
mod contact_sheet;
mod cpu;
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
pub use record::{Compare, Files, HIDDEN_FOLDER, Record, State, Verdict};
pub use sequence::{Script, Sequence};
pub use status::{Failed, Running, Status};
