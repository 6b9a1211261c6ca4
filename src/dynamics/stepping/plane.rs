//! Planes without end.

use glam::{DQuat, DVec3};
use rapier3d_f64::prelude::{Group, InteractionGroups, InteractionTestMode, Pose, SharedShape};

use super::super::shape::Shape;
use super::shape::Solid;

/// The edges of the block that stands for a plane, in typical lengths of the scene.
const EDGE: f64 = 1e6;
/// A plane is along an axis of the world where its normal is off by no more than this.
const ALIGNED: f64 = 1e-12;

/// The group of solids that a block meets in closed form.
const SIMPLE: Group = Group::GROUP_1;
/// The group of all others.
const OTHER: Group = Group::GROUP_2;
/// The groups of planes are their own: planes do not meet.
const PLANE: Group = Group::GROUP_3;

/// The solids of a plane, each with what it meets. The normal and the orientation of its body say where it faces; `meets_others` says whether
/// anything moves that is neither sphere nor box.
///
/// The engine has half-spaces, but compares each with every body there is, near or far: four walls and a ground cost as much as
/// the rest of the step. Where a plane faces along an axis of the world, a block stands for it, which only meets what is near.
/// Spheres and boxes meet the block exactly. Others are compared with the half-space, which is exact for them.
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
    // The block has its edges along the axes of the world.
    let turn = orientation.conjugate();
    let block = (Pose::from_parts(-half * normal, turn), SharedShape::cuboid(half, half, half));
    let mut all = vec![(block, groups(PLANE, SIMPLE))];
    if meets_others {
        all.push((half_space, groups(PLANE, OTHER)));
    }
    all
}

/// Whether a shape meets the block in closed form.
pub(super) fn is_simple(shape: &Shape) -> bool {
    matches!(shape, Shape::Sphere { .. } | Shape::Box { .. })
}

/// What the solids of a shape that is no plane meet.
pub(super) fn groups_of(shape: &Shape) -> InteractionGroups {
    let own = if is_simple(shape) { SIMPLE } else { OTHER };
    groups(own, SIMPLE | OTHER | PLANE)
}

fn groups(own: Group, others: Group) -> InteractionGroups {
    InteractionGroups::new(own, others, InteractionTestMode::And)
}
