//! A sample of the frames of a run, from which pictures choose the places of texts for the whole run.

use crate::scene::{LabelPlace, Scene};
use crate::simulate::{Frame, Past};

/// The number of frames in a sample.
const FRAMES: usize = 80;
/// The number of bodies in all frames of a sample, which limits the number of frames, since a sample stays in memory.
const BODIES: usize = 100_000;

pub(super) struct Samples {
    /// Every frame whose number is a multiple of this is in the sample. `None` if no text looks for its place.
    stride: Option<usize>,
    frames: Vec<Frame>,
}

impl Samples {
    pub(super) fn new(scene: &Scene) -> Samples {
        let most = (BODIES / scene.bodies.len().max(1)).clamp(2, FRAMES);
        let stride = scene.simulation.timeline.frames().div_ceil(most).max(1);
        Samples { stride: has_movable_texts(scene).then_some(stride), frames: Vec::new() }
    }

    pub(super) fn see(&mut self, frame: &Frame) {
        if self.stride.is_some_and(|stride| frame.index.is_multiple_of(stride)) {
            let past = Past { trails: Vec::new(), ..frame.past.clone() };
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
