//! Where the moving bodies are in the course of a run, for a camera that goes along with them.

use super::Bounds;
use crate::scene::Scene;

/// The largest number of stretches of a course.
const MAX_STRETCHES: usize = 512;

/// A short time of a run, and where its moving bodies are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// The time of the first frame, s.
    pub from: f64,
    /// The time of the last frame, s.
    pub until: f64,
    /// The box around all particles and all bodies that are not fixed, m.
    pub bounds: Bounds,
}

/// Collects the course of a run, frame by frame.
pub(super) struct Course {
    /// The number of frames in a stretch.
    frames_per_stretch: usize,
    stretches: Vec<Stretch>,
}

impl Course {
    pub(super) fn new(scene: &Scene) -> Course {
        let frames_per_stretch = scene.simulation.timeline.frames().div_ceil(MAX_STRETCHES).max(1);
        Course { frames_per_stretch, stretches: Vec::new() }
    }

    /// Adds a part of what moves in a frame, with its time (s).
    pub(super) fn see(&mut self, frame: usize, time: f64, here: Bounds) {
        let is_same = !frame.is_multiple_of(self.frames_per_stretch);
        match self.stretches.last_mut().filter(|last| is_same || last.until == time) {
            Some(last) => {
                last.until = time;
                last.bounds = last.bounds.union(here);
            }
            None => self.stretches.push(Stretch { from: time, until: time, bounds: here }),
        }
    }

    /// The stretches of the run, in order. Times at which nothing moves are left out.
    pub(super) fn finish(self) -> Vec<Stretch> {
        self.stretches
    }
}
