//! How a world handles contacts within a step.

use super::World;

/// How contacts between bodies, limits of joints and motors act within a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactPolicy {
    /// Each impact and each change of a contact ends a piece of the step. Bodies with too many of them are advanced by Moreau's scheme.
    #[default]
    EventDriven,
    /// No events are located: Moreau's scheme advances all bodies, with all contacts of a part of a step at once.
    TimeStepping,
}

impl World {
    /// Selects how contacts are handled from now on.
    pub fn set_contact_policy(&mut self, policy: ContactPolicy) {
        self.about_to_change();
        self.policy = policy;
    }

    /// Returns true if Moreau's scheme advances all bodies.
    pub(super) fn is_stepped(&self) -> bool {
        self.policy == ContactPolicy::TimeStepping
    }
}
