//! Infinite planes.

use glam::{DQuat, DVec3};
use rapier3d_f64::prelude::{Group, InteractionGroups, InteractionTestMode, Pose, SharedShape};

use super::super::shape::Shape;
use super::shape::Solid;

/// The edges of the block that replaces a plane, in typical lengths of the scene.
const EDGE: f64 = 1e6;
/// A plane counts as aligned with a world axis if its normal deviates by no more than this.
const ALIGNED: f64 = 1e-12;

/// The group of solids whose contacts with a block have a closed form.
const SIMPLE: Group = Group::GROUP_1;
/// The group of all other solids.
const OTHER: Group = Group::GROUP_2;
/// Planes have their own group, since planes do not touch each other.
const PLANE: Group = Group::GROUP_3;

/// The solids of a plane, each with the groups that it touches. The normal and the orientation of its body give its direction.
/// `meets_others` says whether any moving body is neither sphere nor box.
///
/// The engine has half-spaces, but compares each with every body, near or far: four walls and a ground cost as much as the rest of the
/// step. So a block replaces a plane that is aligned with a world axis: it is compared only with near bodies. Spheres and boxes touch the
/// block exactly. Other shapes are compared with the half-space, which is exact for them.
pub(super) fn solids(
    normal: DVec3,
    orientation: DQuat,
    length: f64,
    meets_others: bool,
) -> Vec<(Solid, InteractionGroups)> {
    let half_space = (Pose::IDENTITY, SharedShape::halfspace(normal));
    let faces = orientation * normal;
    let is_aligned = faces.abs().max_element() >= 1.0 - ALIGNED;
    if !is_aligned {
        return vec![(half_space, groups(PLANE, SIMPLE | OTHER))];
    }
    let half = 0.5 * EDGE * length;
    // The edges of the block are parallel to the world axes.
    let turn = orientation.conjugate();
    let block = (Pose::from_parts(-half * normal, turn), SharedShape::cuboid(half, half, half));
    let mut all = vec![(block, groups(PLANE, SIMPLE))];
    if meets_others {
        all.push((half_space, groups(PLANE, OTHER)));
    }
    all
}

/// Whether contacts of a shape with the block have a closed form.
pub(super) fn is_simple(shape: &Shape) -> bool {
    matches!(shape, Shape::Sphere { .. } | Shape::Box { .. })
}

/// The groups that the solids of a shape touch, unless it is a plane.
pub(super) fn groups_of(shape: &Shape) -> InteractionGroups {
    let own = if is_simple(shape) { SIMPLE } else { OTHER };
    groups(own, SIMPLE | OTHER | PLANE)
}

fn groups(own: Group, others: Group) -> InteractionGroups {
    InteractionGroups::new(own, others, InteractionTestMode::And)
}
