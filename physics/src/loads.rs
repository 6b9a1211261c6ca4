//! The loads on all bodies at one moment: forces and torques.

use glam::DVec3;

use super::Accounts;

/// The sums of all forces and torques at one moment, with one entry for each body.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Loads {
    /// The resultant force on each body, world axes, N.
    pub force: Vec<DVec3>,
    /// The resultant torque on each body about its center of mass, world axes, N m.
    pub torque: Vec<DVec3>,
    /// The power F·v + τ·ω of all forces without a potential, summed over the bodies, W: one entry for each account.
    pub power: Accounts,
}
