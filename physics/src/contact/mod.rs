//! Contacts between bodies: impacts, friction and rest.
//!
//! Bodies move freely until two of them touch. The step ends at that moment, and an impulse follows the laws of impact and
//! friction. A contact that does not rebound becomes a constraint that pushes and never pulls. Source: F. Pfeiffer & C.
//! Glocker, *Multibody Dynamics with Unilateral Contacts* (1996).

mod approach;
mod ball;
mod change;
mod closest_points;
mod collider;
mod crowd;
mod facing;
mod feature;
#[cfg_attr(not(feature = "time-stepping"), path = "no_gjk.rs")]
mod gjk;
mod group;
mod impulse;
mod lasting_contact;
mod laws;
mod pairs;
mod patch;
mod path;
mod rim_bound;
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
use serde::{Deserialize, Serialize};

pub(super) use ball::Ball;
pub(super) use closest_points::ClosestPoints;
pub(super) use collider::Collider;
#[cfg(feature = "time-stepping")]
pub(super) use collider::crowded;
pub(super) use group::Parting;
pub(super) use lasting_contact::LastingContact;
pub use laws::{LawResidual, MotionLaw};
pub(super) use path::pose;
pub(super) use solid::{Pose, Solid};
pub(super) use strike::kinetic;
pub use surface::{ContactProperties, Surface};
pub(super) use tree::Tree;

/// The contact properties of the bodies: their surfaces, and the pairs that pass through each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contacts {
    /// The surface of each body, in the order in which the bodies were added; `None` for a body that other bodies pass through.
    pub surfaces: Vec<Option<Surface>>,
    /// Pairs of bodies that pass through each other, by index, the smaller index first.
    pub apart: BTreeSet<(usize, usize)>,
}

/// One impact between two bodies, as the frames and labels of the animation report it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Impact {
    /// The time at which the impact happened, s.
    pub time: f64,
    /// The indices of the two bodies, the smaller one first.
    pub bodies: [usize; 2],
    /// The point at which the bodies hit each other, world axes, m.
    pub place: DVec3,
    /// The unit contact normal, from the first body to the second, world axes.
    pub normal: DVec3,
    /// The impulse on the second body, world axes, N s.
    pub impulse: DVec3,
    /// The kinetic energy that the impact dissipated, J. It is not negative.
    pub energy: f64,
}

/// A contact point of two bodies at one moment, with its forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSnapshot {
    /// The indices of the two bodies, the smaller one first.
    pub bodies: [usize; 2],
    /// The point at which the bodies touch, world axes, m.
    pub place: DVec3,
    /// The unit contact normal, from the first body to the second, world axes.
    pub normal: DVec3,
    /// The normal force on the second body, world axes, N.
    pub force: DVec3,
    /// The friction force on the second body, world axes, N.
    pub friction: DVec3,
}
