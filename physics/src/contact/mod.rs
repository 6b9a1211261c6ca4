//! Contacts between bodies: impacts, friction and rest.
//!
//! Bodies move freely until two of them touch. The step ends at that moment, and an impulse follows the laws of impact and
//! friction. A contact that does not rebound becomes a constraint that pushes and never pulls. Source: F. Pfeiffer & C.
//! Glocker, *Multibody Dynamics with Unilateral Contacts* (1996).
//!
//! # Geometry
//!
//! The surface of a body for contacts is a `Solid` (`solid.rs`): convex parts, each with its corners, edges, faces and rims as `Patch`es.
//! The distance of two patches has a closed form (`meet`); only rims need Newton's method, to find the angle. The gap between two parts is
//! the largest distance along the normals of all pairs of patches that may be nearest (`closest_points.rs`). Each of these distances is a
//! lower bound, and one of them is the gap, so the gap is exact up to rounding. The crate parry only finds the candidates: its GJK algorithm
//! finds the patches, and a tree of boxes (`tree.rs`) finds the parts. Without the feature `time-stepping`, all pairs of features of two
//! convex parts are compared (`no_gjk.rs`): gaps are as exact, and scenes with boxes take about three times as long.
//!
//! `touches` lists the pairs of patches at which two bodies touch, at most eight for each pair of parts. It needs the gap and its normal
//! only to choose the patches, and for two boxes that lie on each other, separating axes give both faster (`facing.rs`). A mesh is a surface
//! of triangles with a tree of boxes, and has contacts on both sides. An edge in a flat or concave part of the surface is a seam: it causes
//! no contacts of its own, so sliding bodies do not catch on it. A torus has no `Solid`.
//!
//! # Groups
//!
//! An event ends a part of a step for all bodies that advance together. If no joint or force couples bodies, groups of bodies that cannot
//! meet within a step (`group.rs`) are advanced separately (`world/separate_groups.rs`).
//!
//! # Crowds and heaps
//!
//! If some bodies have too many events within a step, they become a `Crowd` (`crowd.rs`): their contacts are solved together until the end
//! of the step, and, if this happens repeatedly, for up to sixteen more steps. A heap (`crowd/heap.rs`) is a crowd from its first event
//! until it rests. Bodies that may hit a large crowd within a step join it at the beginning (`crowd/hits.rs`), so the motion of the crowd is
//! computed once a step.
//!
//! Moreau's midpoint scheme (`crowd/substep_motion.rs`) moves a crowd in two or more parts of a step, with impulses at all contacts, limits
//! and motors at once. Each part first stops approaching bodies, or lets them rebound. It moves all bodies for half of its time, computes
//! velocities that satisfy the constraints there, and uses these for the second half. So the work of impulses is that of the midpoint
//! velocities, and the energy balances up to the accuracy of rotations. Then overlapping bodies are moved apart.
//!
//! # Laws that no contact can break
//!
//! Each impact and each part of a step of the crowd is checked for what no contact can do (`laws.rs`): the energy that all impulses give is
//! measured on the bodies, not summed up from the contacts. A part of a step that adds energy is repeated in halves, and an impact gets the
//! largest restitution that adds none; if neither helps, the run fails. The worst residuals go through snapshots and frames into the survey
//! and the report.

mod approach;
mod ball;
mod closest_points;
mod collider;
mod contact_rates;
mod crowd;
mod facing;
mod feature;
mod flush;
#[cfg_attr(not(feature = "time-stepping"), path = "no_gjk.rs")]
mod gjk;
mod group;
mod impacts;
mod impulse;
mod lasting_contact;
mod laws;
mod pairs;
mod patch;
mod path;
mod rim_bound;
mod solid;
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
pub(super) use impacts::kinetic;
pub(super) use lasting_contact::LastingContact;
pub use laws::{LawResidual, MotionLaw};
pub(super) use path::pose;
pub(super) use solid::{Pose, Solid};
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
