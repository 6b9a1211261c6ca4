//! The collision shapes of infinite planes.

use glam::{DQuat, DVec3};
use rapier3d_f64::prelude::{Group, InteractionGroups, InteractionTestMode, Pose, SharedShape};

use super::super::shape::Shape;
use super::shape::Solid;

/// The edge length of the cube that replaces a plane, in multiples of the thickness of the thinnest moving body.
const PLANE_CUBE_EDGE: f64 = 1e6;
/// A plane counts as aligned with a world axis if a component of its unit normal differs from ±1 by no more than this.
const AXIS_ALIGNMENT_TOLERANCE: f64 = 1e-12;

/// The collision group of spheres and boxes, whose contacts with a block have a closed form.
const SIMPLE_GROUP: Group = Group::GROUP_1;
/// The collision group of all shapes other than spheres, boxes and planes.
const OTHER_GROUP: Group = Group::GROUP_2;
/// The collision group of planes. Planes do not touch each other.
const PLANE_GROUP: Group = Group::GROUP_3;

/// Returns the solids of a plane, each with its collision groups. `normal` (body axes) and `orientation` give the direction of the plane.
/// `meets_others` is true if any moving body is neither sphere nor box.
///
/// The physics engine has half-spaces, but compares each half-space with every body, near or far: four walls and a ground cost as much as
/// the remaining work of a step. So a block replaces a plane that is aligned with a world axis, because the engine compares a block only
/// with near bodies. Spheres and boxes touch the block exactly. Other shapes are compared with the half-space, which is exact for these
/// shapes.
pub(super) fn solids(
    normal: DVec3,
    orientation: DQuat,
    length: f64,
    meets_others: bool,
) -> Vec<(Solid, InteractionGroups)> {
    let half_space = Solid::angular(Pose::IDENTITY, SharedShape::halfspace(normal));
    let faces = orientation * normal;
    let is_aligned = faces.abs().max_element() >= 1.0 - AXIS_ALIGNMENT_TOLERANCE;
    if !is_aligned {
        return vec![(half_space, groups(PLANE_GROUP, SIMPLE_GROUP | OTHER_GROUP))];
    }
    let half = 0.5 * PLANE_CUBE_EDGE * length;
    // This rotation makes the edges of the block parallel to the world axes.
    let turn = orientation.conjugate();
    let pose = Pose::from_parts(-half * normal, turn);
    let block = Solid::angular(pose, SharedShape::cuboid(half, half, half));
    let mut all = vec![(block, groups(PLANE_GROUP, SIMPLE_GROUP))];
    if meets_others {
        all.push((half_space, groups(PLANE_GROUP, OTHER_GROUP)));
    }
    all
}

/// Returns whether contacts of a shape with a block have a closed form: true for spheres and boxes.
pub(super) fn is_simple(shape: &Shape) -> bool {
    matches!(shape, Shape::Sphere { .. } | Shape::Box { .. })
}

/// Returns the collision groups of a shape other than a plane: its own group, and the groups that it touches.
pub(super) fn groups_of(shape: &Shape) -> InteractionGroups {
    let own = if is_simple(shape) { SIMPLE_GROUP } else { OTHER_GROUP };
    groups(own, SIMPLE_GROUP | OTHER_GROUP | PLANE_GROUP)
}

fn groups(own: Group, others: Group) -> InteractionGroups {
    InteractionGroups::new(own, others, InteractionTestMode::And)
}
