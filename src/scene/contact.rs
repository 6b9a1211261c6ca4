//! How the bodies of a checked scene collide.

use std::sync::Arc;

use crate::dynamics::Surface;

/// What finds out where bodies touch, and stops them there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactLaw {
    /// The time of each impact is found within the step.
    EventDriven,
}

impl ContactLaw {
    /// All of them.
    pub const ALL: [ContactLaw; 1] = [ContactLaw::EventDriven];

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            ContactLaw::EventDriven => "event-driven",
        }
    }
}

/// How a body collides.
#[derive(Clone, Debug, PartialEq)]
pub struct Collider {
    /// How its surface behaves where others touch it.
    pub surface: Surface,
    /// The name of its group: bodies of one group pass through each other.
    pub group: Option<Arc<str>>,
}
