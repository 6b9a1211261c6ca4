//! A sample of the frames of a run. From it, pictures choose the places of texts for the whole run, and cameras and lights know where they begin.

use crate::scene::{LabelPlace, Scene};
use crate::simulate::tallies::SoFar;
use crate::simulate::{Frame, Past};

/// The largest number of frames in a sample.
const MOST_FRAMES: usize = 80;
/// The largest number of bodies in all frames of a sample together, since a sample stays in memory.
const MOST_BODIES: usize = 100_000;

pub(super) struct Samples {
    /// The sample has the frames whose numbers are multiples of this. `None` without a sample.
    stride: Option<usize>,
    frames: Vec<Frame>,
}

impl Samples {
    pub(super) fn new(scene: &Scene) -> Samples {
        let most = (MOST_BODIES / scene.bodies.len().max(1)).clamp(2, MOST_FRAMES);
        let frames = scene.simulation.timeline.frames();
        let stride = if has_movable_texts(scene) {
            Some(frames.div_ceil(most).max(1))
        } else {
            // Only the first frame is needed.
            scene.stage_follows_measures().then_some(frames.max(1))
        };
        Samples { stride, frames: Vec::new() }
    }

    /// Adds a frame if it is one of the sample. Of its past, only what measures know of earlier frames is kept.
    pub(super) fn see(&mut self, frame: &Frame, past: SoFar<'_>) {
        if self.stride.is_some_and(|stride| frame.index.is_multiple_of(stride)) {
            let SoFar { areas, closest } = past;
            let past = Past { areas: areas.to_vec(), closest: closest.to_vec(), ..Past::default() };
            self.frames.push(Frame { particles: Vec::new(), past, ..frame.clone() });
        }
    }

    pub(super) fn finish(self) -> Vec<Frame> {
        self.frames
    }
}

/// True if a scene has texts that move with what they name: at bodies, arrows, angles or distances.
fn has_movable_texts(scene: &Scene) -> bool {
    let is_at_body = |place| matches!(place, LabelPlace::Body { .. });
    !scene.angles.is_empty()
        || !scene.distances.is_empty()
        || !scene.arrow_marks.is_empty()
        || scene.labels.iter().any(|label| is_at_body(label.place))
}
