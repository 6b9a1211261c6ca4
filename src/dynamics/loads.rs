//! Forces and torques on the bodies at one moment.

use glam::DVec3;

use super::Accounts;

/// The sums of all forces and torques at one moment: one entry for each body.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Loads {
    /// Resultant force on each body, N.
    pub force: Vec<DVec3>,
    /// Resultant torque on each body about its centre of mass, world axes, N m.
    pub torque: Vec<DVec3>,
    /// Power of everything without a potential, F·v + τ·ω, summed over the bodies, W: one entry for each account.
    pub power: Accounts,
}
