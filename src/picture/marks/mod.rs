//! Marks: what a scene measures or names in the picture, such as angles and dimension lines.
//!
//! A mark draws itself in each frame as a list of things and notes (texts at points of the world). Everything else follows from these
//! lists: scripts, page, room for texts. A new kind of mark is one file here, and a line in [`Marks::new`].

mod angle;
mod arrow;
mod distance;
mod note;

use std::fmt::Debug;
use std::sync::Arc;

pub(super) use self::arrow::ArrowMarks;
pub(super) use self::note::{Note, Says, place};

use super::camera::Placed;
use super::screen::Screen;
use super::thing::Thing;
use crate::scene::{Color, Scene};
use crate::simulate::Frame;

/// The radius of a mark's main line, in strokes. A stroke is the width of a clearly visible line.
const MAIN_LINE_RADIUS: f64 = 0.4;
/// The radius of a mark's helping line, in strokes.
const HELPING_LINE_RADIUS: f64 = 0.22;

/// A frame, and how its camera sees it.
pub(super) struct Scale<'a> {
    pub(super) frame: &'a Frame,
    pub(super) camera: &'a Placed,
    pub(super) screen: &'a Screen,
    /// The width in view of the camera, m.
    pub(super) view: f64,
    /// The width of a clearly visible line, m.
    pub(super) stroke: f64,
}

/// What marks draw in a frame.
#[derive(Default)]
pub(super) struct Sketch<'a> {
    pub(super) things: Vec<Thing<'a>>,
    pub(super) notes: Vec<Note<'a>>,
}

/// Something that a scene measures or names in the picture.
trait Mark: Debug + Send + Sync {
    /// Draws the mark in a frame. Draws nothing while a body that it needs is absent.
    fn draw<'a>(&'a self, scale: &Scale<'_>, sketch: &mut Sketch<'a>);
}

/// The marks of a scene.
#[derive(Clone, Debug)]
pub(super) struct Marks {
    marks: Vec<Arc<dyn Mark>>,
}

impl Marks {
    /// Plans the marks of a scene. `ink` is their default color.
    pub(super) fn new(scene: &Scene, ink: Color) -> Marks {
        let mut marks: Vec<Arc<dyn Mark>> = Vec::new();
        marks.extend(angle::marks(scene, ink));
        marks.extend(distance::marks(scene, ink));
        Marks { marks }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.marks.is_empty()
    }

    /// Draws all marks in a frame.
    pub(super) fn sketch(&self, scale: &Scale<'_>) -> Sketch<'_> {
        let mut sketch = Sketch::default();
        self.marks.iter().for_each(|mark| mark.draw(scale, &mut sketch));
        sketch
    }
}
