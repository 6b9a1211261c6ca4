//! Exports frames as a binary glTF 2.0 file for Blender, three.js and other programs. The file contains all bodies with their animation,
//! cameras and lights.
//!
//! | what | where |
//! | --- | --- |
//! | the poses of the bodies in all frames | `motion` |
//! | the times at which bodies are present | `visibility` |
//! | the poses and properties of cameras and lights | `cameras_and_lights` |
//! | the poses and lengths of springs and joints | `links` |
//! | triangles, once for each base shape | `geometry` |
//! | materials | `materials` |
//! | base shapes with their materials | `meshes` |
//! | the nodes, and the whole document | `document_builder` |
//! | the animation of nodes | `channels` |
//! | the types of glTF | `document` |
//! | both chunks of the file as bytes | `container` |
//!
//! The file uses meters and seconds, with y up. Everything is below one node, so that programs with other units can scale that node.
//! Vertices and poses are `f32`, as glTF requires.

mod cameras_and_lights;
mod channels;
mod container;
mod document;
mod document_builder;
mod geometry;
mod links;
mod materials;
mod meshes;
mod motion;
#[cfg(test)]
mod tests;
mod visibility;

use std::io::Write;

use self::cameras_and_lights::CamerasAndLights;
use self::motion::SampledMotion;
use super::ExportError;
use super::format::{Contents, FileKind, Format, MODEL, count_of_bodies};
use crate::simulate::{Recorded, Selection};

/// An animated model.
pub(super) struct Model;

impl Format for Model {
    fn file_kind(&self) -> &'static FileKind {
        &MODEL
    }

    fn without_particles(&self) -> Option<&'static str> {
        Some("a model has no place for what comes and goes")
    }

    fn write(
        &self,
        run: &Recorded<'_>,
        selection: &Selection,
        out: &mut dyn Write,
    ) -> Result<Contents, ExportError> {
        let Exported { frames, bytes, faster } = write_glb(run, selection, out)?;
        let frames = if frames == 1 { "1 frame".to_owned() } else { format!("{frames} frames") };
        let words = format!("{}, {frames}", count_of_bodies(run.scene()));
        Ok(Contents { words, bytes: Some(bytes), faster })
    }
}

/// A summary of the exported file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exported {
    /// The number of frames.
    pub frames: usize,
    /// The size of the file, bytes.
    pub bytes: u64,
    /// The ratio of the simulated time to the time of the animation. It is 1 if films can have the scene's frame rate.
    pub faster: f64,
}

/// Writes a `.glb` file with the bodies, cameras and lights of a run and their motion in the selected frames. Only moving objects get
/// keyframes. glTF cannot animate the angle of view, so the angle of the first frame is kept.
///
/// # Errors
/// If the file cannot be written, the recording cannot be read, or the format cannot hold the scene. In the last case, nothing is written.
pub fn write_glb(
    run: &Recorded<'_>,
    selection: &Selection,
    mut out: impl Write,
) -> Result<Exported, ExportError> {
    let scene = run.scene();
    let mut motion = SampledMotion::of(run, selection)?;
    let sight = CamerasAndLights::of(run, selection, &mut motion)?;
    let links = links::nodes(run, selection, &mut motion)?;
    let (document, geometry) = document_builder::document(scene, sight, &links, &motion);
    let bytes = container::write(&document, &geometry, &motion, &mut out)?;
    out.flush()?;
    Ok(Exported { frames: motion.times().len(), bytes, faster: motion.faster() })
}
