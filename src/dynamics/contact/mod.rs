//! Contacts between bodies: impacts, friction and rest.
//!
//! Bodies move freely until two of them touch. The step ends at that moment, and an impulse follows the laws of impact and
//! friction. A contact that does not rebound becomes a constraint that pushes and never pulls. Source: F. Pfeiffer & C.
//! Glocker, *Multibody Dynamics with Unilateral Contacts* (1996).

mod approach;
mod ball;
mod change;
mod closed;
mod collider;
mod crowd;
mod feature;
#[cfg_attr(not(feature = "time-stepping"), path = "no_gjk.rs")]
mod gjk;
mod group;
mod impulse;
mod nearest;
mod pairs;
mod patch;
mod path;
mod solid;
mod strike;
mod surface;
#[cfg(test)]
mod tests;
mod touch;
mod tree;
mod triangles;

use std::collections::BTreeSet;

use glam::DVec3;

pub(super) use ball::Ball;
pub(super) use closed::Closed;
pub(super) use collider::Collider;
pub(super) use group::Parting;
pub(super) use solid::{Pose, Solid};
pub use surface::{Meeting, Surface};
pub(super) use tree::Tree;

/// Which bodies touch, and how.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contacts {
    /// The surfaces of the bodies, in the order in which the bodies were added; none for a body that others pass through.
    pub surfaces: Vec<Option<Surface>>,
    /// Pairs of bodies that pass through each other, the smaller number first.
    pub apart: BTreeSet<(usize, usize)>,
}

/// One impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// When it was, s.
    pub time: f64,
    /// The numbers of the two bodies, the smaller one first.
    pub bodies: [usize; 2],
    /// Where they touched, m.
    pub place: DVec3,
    /// The unit normal from the first body to the second.
    pub normal: DVec3,
    /// The impulse on the second body, N s.
    pub impulse: DVec3,
    /// The kinetic energy that was lost, J; not negative.
    pub energy: f64,
}

/// A place where two bodies touch at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSnapshot {
    /// The numbers of the two bodies, the smaller one first.
    pub bodies: [usize; 2],
    /// Where they touch, m.
    pub place: DVec3,
    /// The unit normal from the first body to the second.
    pub normal: DVec3,
    /// The normal force on the second body, N.
    pub force: DVec3,
    /// The force of friction on the second body, N.
    pub friction: DVec3,
}
