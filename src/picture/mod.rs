//! Frames → the contents of their pictures.
//!
//! A [`Plan`] is made once for a run and a camera. For any frame, in any order and from several threads, the plan computes the camera, the
//! lights, and everything that is drawn besides the bodies: arrows, axes, springs, joints, ghosts, trails, texts, a grid, a scale bar. All
//! lengths are in meters and independent of the renderer, so all renderers draw the same picture.

mod arrows;
mod bar;
mod beside;
mod camera;
mod catenary;
mod colors;
mod framing;
mod ghosts;
mod grid;
mod in_front;
mod labels;
mod length;
mod lights;
mod links;
mod not_drawn;
pub(crate) mod number;
mod occupancy;
mod pace;
mod plan;
mod pulley;
mod scope;
mod screen;
mod sight;
mod stage;
#[cfg(test)]
mod tests;
mod text;
mod trails;

pub use arrows::{Arrow, ArrowOwner, Axes};
pub use bar::Bar;
pub use camera::{Lens, Placed};
pub use colors::pale;
pub(crate) use framing::{decimal_step, rounded_outward};
pub use grid::{Grid, Line};
pub use lights::{Lamp, PlacedLight};
pub use links::{Link, LinkKind, LinkShape, PlannedLink};
pub use not_drawn::{NotDrawn, Reason, RequestedItem};
pub use pace::Pace;
pub(crate) use plan::has_texts;
pub use plan::{Largest, Plan, Written};
pub use scope::Part;
pub use screen::{Screen, ScreenPoint};
pub use stage::{Scenery, Stage, StageGround};
pub use text::{Text, Vertical};
pub use trails::{Stretch, Trail};
