//! The part of a checked scene that is physics.

use std::sync::Arc;

use glam::DVec3;

use super::motion::BodyMotion;
use super::{Collider, ContactLaw, Showing};
use crate::dynamics::{Method, Presence, RigidBody, Shape};

/// How the world is advanced.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// The time of the last frame asked for, s.
    pub duration: f64,
    /// Frames per second.
    pub frame_rate: f64,
    /// The longest timestep allowed, s; infinite where the method chooses its own.
    pub step: f64,
    /// The error that a step of an adaptive method may have.
    pub tolerance: f64,
    /// The method that advances the world.
    pub method: &'static Method,
    /// The acceleration of every body that can move, m/s².
    pub gravity: DVec3,
    /// The method that stops bodies where they touch. `None`: bodies pass through each other.
    pub contacts: Option<ContactLaw>,
}

impl Simulation {
    /// The number of frames: both ends of the duration are drawn.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the check of a scene limits the number of frames"
    )]
    pub fn frames(&self) -> usize {
        (self.duration * self.frame_rate).round() as usize + 1
    }

    /// The time of a frame, s.
    #[allow(clippy::cast_precision_loss, reason = "the check of a scene limits the number of frames")]
    pub fn time(&self, frame: usize) -> f64 {
        frame as f64 / self.frame_rate
    }

    /// The time of the last frame, s.
    pub fn end(&self) -> f64 {
        self.time(self.frames() - 1)
    }

    /// The time of the nearest frame, if `time` (s) differs from that by rounding alone; else `time`.
    pub fn nearest_frame(&self, time: f64) -> f64 {
        let frame = (time * self.frame_rate).round();
        let at_frame = frame / self.frame_rate;
        if (time - at_frame).abs() <= 1e-6 / self.frame_rate { at_frame } else { time }
    }
}

/// A rigid body and its look.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name, unique among bodies.
    pub name: Arc<str>,
    /// Its form.
    pub shape: Shape,
    /// Its state at the start.
    pub start: RigidBody,
    /// Its magnetic moment in its own axes, A m².
    pub magnetic_moment: DVec3,
    /// When it is there. What it is at the start, it is when it first comes.
    pub presence: Presence,
    /// The motion that it follows, whatever acts on it.
    pub motion: Option<Arc<BodyMotion>>,
    /// How it collides; none: others pass through it.
    pub collider: Option<Arc<Collider>>,
    /// The number of its material among the scene's; none for axes, which have colors of their own, and for
    /// an object in SDL that is given none.
    pub material: Option<usize>,
    /// How it differs in pictures from what it is in mechanics.
    pub look: Arc<BodyLook>,
    /// The physics shown beside the body. Copies of a body share it.
    pub showing: Arc<Showing>,
}

/// How a body differs in pictures from what it is in mechanics.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyLook {
    /// How many times larger it is drawn.
    pub scale: f64,
    /// The object that is drawn, in POV-Ray's own words and in metres; none: its shape is drawn.
    pub object: Option<Arc<str>>,
    /// POV-Ray's own words in its object, before its place.
    pub sdl_before: Option<Arc<str>>,
    /// POV-Ray's own words in its object, after its place.
    pub sdl_after: Option<Arc<str>>,
}

impl BodyLook {
    /// Whether the body has words of POV-Ray's own.
    pub fn has_sdl(&self) -> bool {
        self.object.is_some() || self.sdl_before.is_some() || self.sdl_after.is_some()
    }
}

impl Body {
    /// The shape that pictures show, or that stands in for what they show.
    pub fn drawn(&self) -> Shape {
        self.shape.scaled(self.look.scale)
    }
}
