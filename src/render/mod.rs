//! Scripts → images.

mod contact_sheet;
mod cpu;
mod error;
mod fault;
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
mod sequence;

pub use contact_sheet::{ContactSheet, Shot};
pub use error::RenderError;
pub use fault::Fault;
pub use film::{Ffmpeg, Film, FilmError, Format};
pub use images::Images;
pub use job::{Event, Job, Outcome};
pub use options::{Quality, options};
pub use povray::PovRay;
pub use record::{Compare, Files, HIDDEN, Record, State};
pub use sequence::{Script, Sequence};
