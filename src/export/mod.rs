//! Exports frames as tables and models for other programs.

mod bodies;
mod error;
mod events;
mod format;
mod glb;
mod joints;
mod particles;
mod table;

pub use self::bodies::{HEADER, write_csv};
pub use self::error::ExportError;
pub use self::events::{EVENT_HEADER, write_events};
pub use self::format::{Contents, FORMATS, Format};
pub use self::glb::{Exported, write_glb};
pub use self::joints::{JOINT_HEADER, write_joints};
pub use self::particles::{PARTICLE_HEADER, write_particles};
