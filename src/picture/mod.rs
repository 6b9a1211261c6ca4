//! Frames → the contents of their pictures.
//!
//! A [`Plan`] is made once for a run and a camera. For any frame, in any order and from several threads, the plan computes the camera, the
//! lights, and everything that is drawn besides the bodies: arrows, axes, springs, joints, ghosts, trails, texts, plots, a grid, a scale bar. All
//! lengths are in meters and independent of the renderer, so all renderers draw the same picture.
//!
//! Texts are placed on a plane in front of the camera (`screen.rs`); their heights are relative to the image. Where a text beside a body or arrow
//! stands is chosen for the whole run, so that it does not jump from frame to frame (`surroundings.rs`, `favored_places.rs`). Springs and joints are planned
//! as parts (`links/`). Each part has a shape, and follows the ends of the spring or joint in the frame. A slack rope is a catenary of its
//! length (`catenary.rs`), and the rope of a pulley goes around its wheels (`pulley.rs`). Unused features yield empty lists. The widths of
//! lines, and the lengths of arrows without a scale, follow from the width of the camera's view: at each frame if the camera moves,
//! otherwise once for the run.
//!
//! The camera shows the whole motion. Where the bodies would be too small, it goes along with them (`track.rs`), or shows the motion up to the
//! last of several times at which they are still large enough (`framed_run.rs`). The default lights are defined here, and again in
//! `templates/lights.inc`, which a scene may replace. A test in `emit/stage.rs` checks that the two are equal.
//!
//! Numbers in scripts and texts are written by `number.rs`: as short as possible, and never as `-0`.

mod arrows;
mod bar;
mod beside;
mod camera;
mod catenary;
mod color_maps;
mod colors;
mod direction_hints;
mod favored_places;
mod followed;
mod framed_run;
mod framing;
mod ghosts;
mod grid;
mod in_front;
mod labels;
mod length;
mod lights;
mod links;
mod looks;
mod marks;
mod not_drawn;
pub(crate) mod number;
mod occupancy;
mod pace;
mod plan;
mod plots;
mod pulley;
mod screen;
mod stage;
mod surroundings;
#[cfg(test)]
mod tests;
mod text;
mod thing;
mod track;
mod trails;

pub use bar::Bar;
pub use camera::{Lens, Placed};
pub use colors::pale;
pub use framed_run::FramedPart;
pub(crate) use framing::rounded_outward;
pub use lights::{Lamp, PlacedLight};
pub use looks::Looks;
pub use not_drawn::{NotDrawn, Reason, RequestedItem};
pub use pace::Pace;
pub use plan::{Largest, Plan, Written};
pub(crate) use plan::{Lost, has_texts};
pub(crate) use plots::plot_alone;
pub use plots::{CurveNow, PlannedCurve, PlannedPlot, PlotBar, PlotLine, PlotNow, Strip, UnseenPlot};
pub use screen::{Screen, ScreenPoint};
pub use stage::{Scenery, Stage, StageGround};
pub use text::{LINE, Text, Vertical};
pub use thing::{Form, FormKind, Line, PlannedThing, Thing};
pub use trails::{Stretch, Trail};
