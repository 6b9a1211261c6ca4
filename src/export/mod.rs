//! Exports frames as tables, models and drawings for other programs.
//!
//! # Models
//!
//! Each part of a spring or a joint is a node that is stretched from end to end; a rope is a chain of cylinders. From frame to frame, a rod
//! takes the smallest rotation; otherwise it would spin about its axis.
//!
//! A `.glb` stores the poses of moving bodies as `f32`: locations and orientations separately, each from its first change. So the size of
//! the file is known early, and a file that would be too large is refused early. Of the equivalent quaternions q and −q, the one closer to
//! the previous frame is stored; otherwise viewers would interpolate the longer rotation. If frames are too far apart in time for a film (39
//! days, for example), the model has 25 frames a second, and `extras` hold the time factor. Lights fade in glTF, so at the center of the
//! scene they are as bright as POV-Ray's: a white surface there that faces a light of 1 gets π lux and is white. A lamp nearer than half the
//! size of the scene counts as if it were at that distance.
//!
//! Our own structs with serde write the JSON: `gltf-json` adds types for all of glTF, of which a tenth is used here, and its fields repeat
//! the specification.

mod bodies;
mod error;
mod events;
mod format;
mod glb;
mod joints;
mod particles;
mod plot;
mod plot_values;
mod table;

pub use self::bodies::{HEADER, write_csv};
pub use self::error::ExportError;
pub use self::events::{EVENT_HEADER, write_events};
#[cfg(feature = "render")]
pub(crate) use self::format::count_of_bodies;
pub use self::format::{Contents, DRAWING, FORMATS, FileKind, Format, IMAGE, MODEL, PAGE, TABLE};
pub use self::glb::{Exported, write_glb};
pub use self::joints::{JOINT_HEADER, write_joints};
pub use self::particles::{PARTICLE_HEADER, write_particles};
pub use self::plot::{PlotDrawing, PlotFile};
