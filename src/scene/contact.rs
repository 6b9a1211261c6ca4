//! How the bodies of a checked scene collide.

use std::sync::Arc;

use crate::dynamics::Surface;

/// The method that detects contacts and stops bodies there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactLaw {
    /// The time of each impact is found within the step.
    EventDriven,
    /// All contacts of a step are solved together.
    TimeStepping,
}

impl ContactLaw {
    /// All of them.
    pub const ALL: [ContactLaw; 2] = [ContactLaw::EventDriven, ContactLaw::TimeStepping];

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            ContactLaw::EventDriven => "event-driven",
            ContactLaw::TimeStepping => "time-stepping",
        }
    }

    /// When to choose it.
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

/// How a body collides.
#[derive(Clone, Debug, PartialEq)]
pub struct Collider {
    /// How its surface behaves where others touch it.
    pub surface: Surface,
    /// The name of its group: bodies of one group pass through each other.
    pub group: Option<Arc<str>>,
}
