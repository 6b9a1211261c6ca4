//! The contact laws of scenes, and the contact properties of bodies.

use std::sync::Arc;

use super::{Body, Scene};
use crate::physics::Surface;

/// The method that detects contacts and keeps bodies from passing through each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactLaw {
    /// Event-driven contacts: finds the time of each impact within a timestep.
    EventDriven,
    /// Time stepping: solves all contacts of a timestep together.
    TimeStepping,
}

impl ContactLaw {
    /// All contact laws.
    pub const ALL: [ContactLaw; 2] = [ContactLaw::EventDriven, ContactLaw::TimeStepping];

    /// Returns the name of the contact law in scenes.
    pub fn name(self) -> &'static str {
        match self {
            ContactLaw::EventDriven => "event-driven",
            ContactLaw::TimeStepping => "time-stepping",
        }
    }

    /// Returns one line about when to choose the contact law.
    pub fn summary(self) -> &'static str {
        match self {
            ContactLaw::EventDriven => {
                "few bodies, exactly: each impact at its own time, with any integrator; rebounds keep their height"
            }
            ContactLaw::TimeStepping => {
                "many bodies: piles, stacks, machines; all contacts of a step at once, bodies sink into each other by \
                 about a percent, rebounds lose height; with `euler-cromer` alone"
            }
        }
    }
}

/// The largest number of moving bodies that Moreau's scheme advances. Its time for a step grows faster than that of the engine for many
/// bodies. Scenes of this size take some seconds, which is three to fifteen times as long.
const MAX_BODIES_BY_MOREAU: usize = 60;

/// Returns true if time stepping advances these bodies by Moreau's scheme, with exact joints. The engine for many bodies advances all others.
pub fn is_by_moreau(bodies: &[Body]) -> bool {
    why_for_many_bodies(bodies).is_none()
}

/// Returns the reason why time stepping needs the engine for many bodies: forces move too many bodies for Moreau's scheme, or a torus collides,
/// whose contacts this scheme cannot compute. `None` if Moreau's scheme can advance the bodies.
pub fn why_for_many_bodies(bodies: &[Body]) -> Option<String> {
    let moving = bodies.iter().filter(|body| !body.start.fixed && body.motion.is_none()).count();
    if moving > MAX_BODIES_BY_MOREAU {
        return Some(format!("more than {MAX_BODIES_BY_MOREAU} move"));
    }
    let has_torus = |body: &Body| body.collider.is_some() && body.shape.has_torus();
    bodies.iter().any(has_torus).then(|| "a torus collides".to_owned())
}

impl Scene {
    /// Returns true if the engine for many bodies computes the contacts of the scene.
    pub fn is_for_many_bodies(&self) -> bool {
        self.simulation.contacts == Some(ContactLaw::TimeStepping) && !is_by_moreau(&self.bodies)
    }
}

/// The contact properties of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Collider {
    /// The restitution and friction of the body's surface.
    pub surface: Surface,
    /// The name of the body's collision group. Bodies of the same group pass through each other. `None` if the body is in no group.
    pub group: Option<Arc<str>>,
}
