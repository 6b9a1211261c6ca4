//! The physics of a checked scene: the simulation settings and the bodies.

use std::sync::Arc;

use glam::DVec3;

use super::motion::BodyMotion;
use super::{Collider, ContactLaw, Showing};
use crate::dynamics::{Method, Presence, RigidBody, Shape};

/// The settings of the simulation.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// The duration that the scene asks for, s.
    pub duration: f64,
    /// The frame rate, frames per second.
    pub frame_rate: f64,
    /// The largest timestep, s. Infinite if the method chooses its own timesteps.
    pub step: f64,
    /// The error tolerance of one step of an adaptive method.
    pub tolerance: f64,
    /// The integrator.
    pub method: &'static Method,
    /// The gravitational acceleration of all free bodies, m/s².
    pub gravity: DVec3,
    /// The contact law. `None` if bodies pass through each other.
    pub contacts: Option<ContactLaw>,
}

impl Simulation {
    /// The number of frames, including the frame at time 0 and the last frame.
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

    /// The time of the nearest frame, s, if `time` differs from it only by rounding; else `time`.
    pub fn nearest_frame(&self, time: f64) -> f64 {
        let frame = (time * self.frame_rate).round();
        let at_frame = frame / self.frame_rate;
        if (time - at_frame).abs() <= 1e-6 / self.frame_rate { at_frame } else { time }
    }
}

/// A rigid body and its look.
#[derive(Clone, Debug)]
pub struct Body {
    /// The name of the body, unique among bodies.
    pub name: Arc<str>,
    /// The shape of the body.
    pub shape: Shape,
    /// The state of the body at the start.
    pub start: RigidBody,
    /// The magnetic moment, A m², in the body's axes.
    pub magnetic_moment: DVec3,
    /// The times between which the body is present. A body that appears later begins with its start state.
    pub presence: Presence,
    /// The prescribed motion. `None` if forces move the body.
    pub motion: Option<Arc<BodyMotion>>,
    /// The contact properties. `None` if other bodies pass through the body.
    pub collider: Option<Arc<Collider>>,
    /// The index of the body's material. `None` for axes, which have their own colors, and for a POV-Ray object without
    /// a material.
    pub material: Option<usize>,
    /// The differences between the drawn body and the simulated body.
    pub look: Arc<BodyLook>,
    /// The physics drawn with the body. Copies of a body share it.
    pub showing: Arc<Showing>,
}

/// The differences between the drawn body and the simulated body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyLook {
    /// The factor by which the body is drawn larger.
    pub scale: f64,
    /// The object to draw, as POV-Ray code with lengths in metres. `None` to draw the shape of the body.
    pub object: Option<Arc<str>>,
    /// POV-Ray code inside the object, before its transform.
    pub sdl_before: Option<Arc<str>>,
    /// POV-Ray code inside the object, after its transform.
    pub sdl_after: Option<Arc<str>>,
}

impl BodyLook {
    /// Whether the body has its own POV-Ray code.
    pub fn has_sdl(&self) -> bool {
        self.object.is_some() || self.sdl_before.is_some() || self.sdl_after.is_some()
    }
}

impl Body {
    /// The shape in the picture. If POV-Ray code draws the body, it is the shape that stands for this code.
    pub fn drawn(&self) -> Shape {
        self.shape.scaled(self.look.scale)
    }
}
