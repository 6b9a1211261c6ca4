//! The files that `jabuka compile` would write, for users who take them along from the browser.

use std::collections::HashSet;
use std::io::Read as _;

use super::{Failed, Frames, PageRun};
use crate::Run;
use crate::emit::{ASSETS, frame_name, shutter_name};
use crate::simulate::{Frame, Selection};

/// Encodes the scripts of some frames and the files that they include. The files that all frames share come with the first frame of the
/// run. Each file has the length of its name, its name, the length of its contents, and its contents. The lengths are little-endian 32-bit
/// numbers. Files that several frames include may come several times.
pub(super) fn of_frames(run: &PageRun, frames: &Frames) -> Result<Vec<u8>, Failed> {
    let (scene, view) = (&run.scene, run.seen_by(frames.view)?);
    let mut files = Files::default();
    if frames.from == 0 {
        let all = 0..scene.simulation.timeline.frames();
        let sequence = view.emitter().sequence(scene, all).map_err(crate::RunError::Emit)?;
        sequence.iter().for_each(|(name, text)| files.add(name, text.as_bytes()));
        for asset in &scene.povray.assets {
            let mut contents = Vec::new();
            asset.open()?.read_to_end(&mut contents)?;
            files.add(&format!("{ASSETS}/{}", asset.name), &contents);
        }
    }
    let selection: Selection = frames.recorded(run).collect();
    let count = scene.simulation.timeline.frames();
    for exposure in view.recorded().exposures(&selection) {
        let exposure = exposure?;
        let frame = &exposure.frame;
        let script = view.script(frame).map_err(crate::RunError::Emit)?;
        files.add(&frame_name(frame.index, count), script.as_bytes());
        files.add_trails(&view, frame);
        if let Some(shutter) = view.shutter() {
            let blurred = view.shutter_script(&exposure)?.unwrap_or_default();
            files.add(&shutter_name(frame.index, count), blurred.as_bytes());
            for moment in exposure.moments(shutter) {
                files.add_trails(&view, &moment?);
            }
        }
    }
    Ok(files.bytes)
}

/// Encoded files.
#[derive(Default)]
struct Files {
    bytes: Vec<u8>,
    /// The names of the trail files that are there.
    trails: HashSet<String>,
}

impl Files {
    fn add(&mut self, name: &str, contents: &[u8]) {
        for part in [name.as_bytes(), contents] {
            let length = u32::try_from(part.len()).unwrap_or(u32::MAX);
            self.bytes.extend_from_slice(&length.to_le_bytes());
            self.bytes.extend_from_slice(part);
        }
    }

    /// Adds the trail files that the script of a frame includes.
    fn add_trails(&mut self, run: &Run<'_>, frame: &Frame) {
        for file in run.emitter().trail_files(frame, &|name| self.trails.contains(name)) {
            self.add(&file.name, file.text.as_bytes());
            self.trails.insert(file.name);
        }
    }
}
