//! Scripts → images.

mod cpu;
mod error;
mod fault;
mod images;
mod inputs;
mod job;
mod options;
mod order;
mod pool;
mod povray;
mod process;
mod record;
mod sequence;

pub use error::RenderError;
pub use fault::Fault;
pub use images::Images;
pub use job::{Event, Job, Outcome};
pub use options::{Quality, options};
pub use povray::PovRay;
pub use record::{Compare, Files, HIDDEN, Record, State};
pub use sequence::{Script, Sequence};
