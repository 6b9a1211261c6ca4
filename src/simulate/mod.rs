//! Checked scene → world → frames.
//!
//! This is the only place where a [`Scene`] meets the [`dynamics`](crate::dynamics).

mod build;
mod frame;
mod survey;

use crate::dynamics::Dynamics;
use crate::scene::Scene;

pub use build::world;
pub use frame::{BodyFrame, Frame};
pub use survey::{Bounds, Crossing, Survey, survey};

/// A run of a scene: its frames, one after another, each made when it is asked for.
///
/// The scene knows the initial state, so a run that begins again is another `Frames` of the same scene, and it
/// gives the same frames bit for bit.
pub struct Frames<'a> {
    scene: &'a Scene,
    dynamics: Box<dyn Dynamics>,
    next: usize,
}

/// That a run left the numbers: what is asked for cannot be computed with this step and method.
#[derive(Clone, Debug, PartialEq)]
pub struct Diverged {
    /// The name of the first body that has no finite place or velocity.
    pub body: String,
    /// The time of the frame, s.
    pub time: f64,
}

impl<'a> Frames<'a> {
    /// The frames of a scene from its initial state.
    pub fn new(scene: &'a Scene) -> Frames<'a> {
        Frames { scene, dynamics: Box::new(world(scene)), next: 0 }
    }

    /// Starts over, as the space key does in a simulation with a window.
    pub fn reset(&mut self) {
        *self = Frames::new(self.scene);
    }
}

impl Iterator for Frames<'_> {
    type Item = Result<Frame, Diverged>;

    fn next(&mut self) -> Option<Self::Item> {
        let index = self.next;
        if index >= self.scene.simulation.frames() {
            return None;
        }
        let time = self.scene.simulation.time(index);
        self.dynamics.advance_to(time);
        let frame = Frame::of(self.dynamics.as_mut(), index, time);
        self.next = index + 1;
        let lost = frame.bodies.iter().position(|body| !body.is_finite());
        Some(match lost {
            None => Ok(frame),
            Some(body) => {
                // Nothing that follows could be finite.
                self.next = usize::MAX;
                Err(Diverged { body: self.scene.bodies[body].name.clone(), time })
            }
        })
    }
}

impl std::fmt::Display for Diverged {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the run diverged: at t = {} s `{}` is at no finite place", self.time, self.body)
    }
}

impl std::error::Error for Diverged {}
