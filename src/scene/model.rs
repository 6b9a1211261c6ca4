//! The simulation settings and the bodies of a scene.

use std::sync::Arc;

use glam::DVec3;

use super::motion::BodyMotion;
use super::{Collider, ContactLaw, Showing, Timeline, Visibility};
use crate::physics::{Method, Presence, RigidBody, Shape};

/// The settings of the simulation: times, integrator, gravity and contacts.
#[derive(Clone, Debug)]
pub struct SimulationSettings {
    /// The times of the frames.
    pub timeline: Timeline,
    /// The largest timestep, s. Infinite for an adaptive integrator, which chooses its own timesteps.
    pub step: f64,
    /// The error tolerance of one timestep of an adaptive integrator.
    pub tolerance: f64,
    /// The integrator, with its properties.
    pub method: &'static Method,
    /// The uniform gravitational acceleration of all free bodies, m/s², in world axes.
    pub gravity: DVec3,
    /// The contact law. `None` if bodies pass through each other.
    pub contacts: Option<ContactLaw>,
}

/// A rigid body, with its look and its contact properties.
#[derive(Clone, Debug)]
pub struct Body {
    /// The name of the body, unique among bodies.
    pub name: Arc<str>,
    /// The shape of the body in the simulation, from which contacts and moments of inertia are computed.
    pub shape: Shape,
    /// The initial state and the mass properties of the body.
    pub start: RigidBody,
    /// The magnetic moment, A·m², in body axes.
    pub magnetic_moment: DVec3,
    /// The intervals of time in which the body is present. A body that appears later starts with its initial state.
    pub presence: Presence,
    /// The prescribed motion of the body. `None` if forces move the body.
    pub motion: Option<Arc<BodyMotion>>,
    /// The contact properties of the body. `None` if other bodies pass through the body.
    pub collider: Option<Arc<Collider>>,
    /// The index of the body's material in the scene. `None` for axes, which have fixed colors, and for a POV-Ray object without a
    /// material.
    pub material: Option<usize>,
    /// The scale and the POV-Ray code with which the body is drawn.
    pub look: Arc<BodyLook>,
    /// The physical quantities that are drawn with the body, such as arrows and trails. Copies of a body share this value.
    pub showing: Arc<Showing>,
}

/// The scale and the POV-Ray code with which a body is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyLook {
    /// The factor by which the drawn body is larger than the simulated body. If it follows a value, the largest factor.
    pub scale: f64,
    /// The map that gives this factor, by its index in the scene. `None` if the factor never changes.
    pub scale_map: Option<usize>,
    /// Whether the body is drawn.
    pub visible: Visibility,
    /// POV-Ray code for the object to draw, with lengths in meters. `None` to draw the shape of the body.
    pub object: Option<Arc<str>>,
    /// POV-Ray code that is inserted in the body's object before its transformation.
    pub sdl_before: Option<Arc<str>>,
    /// POV-Ray code that is inserted in the body's object after its transformation.
    pub sdl_after: Option<Arc<str>>,
}

impl BodyLook {
    /// Returns whether the body has POV-Ray code from the scene.
    pub fn has_sdl(&self) -> bool {
        self.object.is_some() || self.sdl_before.is_some() || self.sdl_after.is_some()
    }
}

impl Body {
    /// Returns the shape of the body scaled as it is drawn. If POV-Ray code draws the body, this is the shape that stands in for the code.
    pub fn drawn(&self) -> Shape {
        self.shape.scaled(self.look.scale)
    }
}

/// Returns the thickness of the thinnest body that forces move and that touches others, m. `None` if there is no such body.
pub(crate) fn thinnest(bodies: &[Body]) -> Option<f64> {
    let touches = |body: &&Body| body.collider.is_some() && !body.start.fixed && body.motion.is_none();
    let thickness = bodies.iter().filter(touches).filter_map(|body| body.shape.half_thickness());
    thickness.min_by(f64::total_cmp).map(|half| 2.0 * half)
}
