//! Frames → a binary glTF 2.0 file: all bodies with their animation, cameras and lights, for Blender, three.js and their kin.
//!
//! | what | where |
//! | --- | --- |
//! | where the bodies are in all frames | `motion` |
//! | when they are there | `shown` |
//! | where cameras and lights are, how they see and shine | `sight` |
//! | where springs and joints are, and how long | `links` |
//! | triangles, those of a form once | `geometry` |
//! | looks | `materials` |
//! | forms in their looks | `meshes` |
//! | the nodes, and the document of all | `model` |
//! | what moves nodes | `channels` |
//! | the words of glTF | `document` |
//! | both chunks as bytes | `container` |
//!
//! The file is of metres and seconds, y is up, and all is below one node, so that whoever needs other units scales that.
//! Numbers of vertices and poses are `f32`, as glTF has it.

mod channels;
mod container;
mod document;
mod geometry;
mod links;
mod materials;
mod meshes;
mod model;
mod motion;
mod shown;
mod sight;
#[cfg(test)]
mod tests;

use std::io::Write;

use self::motion::Motion;
use self::sight::Sight;
use super::ExportError;
use crate::simulate::{Recorded, Selection};

/// Figures on the exported file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exported {
    /// The number of frames.
    pub frames: usize,
    /// The size of the file, bytes.
    pub bytes: u64,
    /// How many times faster than in life the animation is shown; it is 1 where films can have the scene's frame rate.
    pub faster: f64,
}

/// Writes the bodies, cameras and lights of a run with their motion in some frames. Poses are kept for what
/// moves, 28 bytes for each frame at most. An angle of view that changes stays as it is in the first of the frames, since
/// glTF has no word for that.
///
/// # Errors
/// If it cannot be written, the recording cannot be read, or the format cannot hold it; then nothing is written.
pub fn write_glb(
    run: &Recorded<'_>,
    selection: &Selection,
    mut out: impl Write,
) -> Result<Exported, ExportError> {
    let scene = run.scene();
    let mut motion = Motion::of(run, selection)?;
    let sight = Sight::of(run, selection, &mut motion)?;
    let links = links::nodes(run, selection, &mut motion)?;
    let (document, geometry) = model::model(scene, sight, &links, &motion);
    let bytes = container::write(&document, &geometry, &motion, &mut out)?;
    out.flush()?;
    Ok(Exported { frames: motion.times().len(), bytes, faster: motion.faster() })
}
