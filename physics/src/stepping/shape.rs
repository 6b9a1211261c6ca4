//! Translates shapes into the collision shapes of the physics engine.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};
use rapier3d_f64::prelude::{Pose, SharedShape};

use super::super::shape::{Shape, cone_base};
use super::mesh::MeshSolids;

/// The number of sides of the pyramid frustum that replaces a conical frustum. Its corners lie outside the circle, and the middles of its
/// sides inside, both by a quarter of a percent of the radius.
const FRUSTUM_SIDES: u32 = 32;
/// The deviation between a torus and the ring of capsules that replaces it, as a fraction of the tube's radius. A torus with a very thin
/// tube deviates more.
const TORUS_DEVIATION: f64 = 0.01;

/// A collision shape of the physics engine, with its pose in the frame of its body.
pub(super) struct Solid {
    pub(super) pose: Pose,
    pub(super) shape: SharedShape,
    /// The symmetry of each part of the shape. A simple shape is its only part.
    pub(super) symmetries: Vec<Symmetry>,
}

impl Solid {
    /// Makes a solid without any symmetry under rotations.
    pub(super) fn angular(pose: Pose, shape: SharedShape) -> Solid {
        Solid { pose, shape, symmetries: vec![Symmetry::None] }
    }
}

/// The rotations that leave a shape in place. Centre and axis are in the frame of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Symmetry {
    /// No rotation, or rotations by a few angles only.
    None,
    /// All rotations about an axis, which has unit length and goes through a centre.
    Axis { centre: DVec3, axis: DVec3 },
    /// All rotations about a centre.
    Point { centre: DVec3 },
}

impl Symmetry {
    /// Returns the symmetry of a shape of revolution about the y axis of `pose`.
    fn about_y(pose: Pose) -> Symmetry {
        Symmetry::Axis { centre: pose.translation, axis: pose.rotation * DVec3::Y }
    }

    /// Transforms the symmetry by a pose.
    pub(super) fn placed(self, pose: Pose) -> Symmetry {
        match self {
            Symmetry::None => Symmetry::None,
            Symmetry::Axis { centre, axis } => {
                Symmetry::Axis { centre: pose * centre, axis: pose.rotation * axis }
            }
            Symmetry::Point { centre } => Symmetry::Point { centre: pose * centre },
        }
    }
}

/// Returns the solids that make up a shape, in the shape's own frame. A plane has none, because [`plane`](super::plane) makes its solids.
/// Moving bodies need solids with an inside; bodies at rest may be surfaces.
pub(super) fn solids(shape: &Shape, moves: bool, meshes: &mut MeshSolids) -> Vec<Solid> {
    let mut all = Vec::new();
    collect(shape, (moves, meshes), Pose::IDENTITY, &mut all);
    // A single compound shape lets the physics engine treat all contacts of the shape as those of one pair of bodies.
    if all.len() > 1 && all.iter().all(|solid| solid.shape.as_composite_shape().is_none()) {
        let symmetries = all.iter().flat_map(|solid| solid.symmetries.iter().copied()).collect();
        let parts = all.into_iter().map(|solid| (solid.pose, solid.shape)).collect();
        return vec![Solid { pose: Pose::IDENTITY, shape: SharedShape::compound(parts), symmetries }];
    }
    all
}

fn collect(shape: &Shape, (moves, meshes): (bool, &mut MeshSolids), pose: Pose, all: &mut Vec<Solid>) {
    let of_revolution = |pose: Pose, shape| Solid { pose, shape, symmetries: vec![Symmetry::about_y(pose)] };
    match *shape {
        Shape::Sphere { radius } => all.push(Solid {
            pose,
            shape: SharedShape::ball(radius),
            symmetries: vec![Symmetry::Point { centre: pose.translation }],
        }),
        Shape::Box { size } => {
            let half = 0.5 * size;
            all.push(Solid::angular(pose, SharedShape::cuboid(half.x, half.y, half.z)));
        }
        Shape::RoundedBox { size, rounding } => {
            let half = 0.5 * size - rounding;
            // A box with the largest possible rounding has no extent between its roundings in some direction. The physics engine needs a
            // small extent.
            let half = half.max(DVec3::splat(1e-9 * rounding));
            all.push(Solid::angular(pose, SharedShape::round_cuboid(half.x, half.y, half.z, rounding)));
        }
        Shape::Cylinder { radius, height } => {
            all.push(of_revolution(pose, SharedShape::cylinder(0.5 * height, radius)));
        }
        Shape::Capsule { radius, height } => {
            all.push(of_revolution(pose, SharedShape::capsule_y(0.5 * height - radius, radius)));
        }
        Shape::Cone { radius, top_radius: 0.0, height } => {
            let middle = cone_base(radius, 0.0, height) + 0.5 * height;
            let pose = pose * Pose::from_parts(middle * DVec3::Y, DQuat::IDENTITY);
            all.push(of_revolution(pose, SharedShape::cone(0.5 * height, radius)));
        }
        Shape::Cone { radius, top_radius, height } => {
            all.extend(frustum(radius, top_radius, height).map(|wedge| of_revolution(pose, wedge)));
        }
        Shape::Torus { radius, tube_radius } => {
            all.extend(torus(radius, tube_radius).map(|capsule| of_revolution(pose, capsule)));
        }
        Shape::Plane { .. } | Shape::Axes { .. } => {}
        Shape::Compound(ref compound) => {
            for part in compound.parts() {
                let pose = pose * Pose::from_parts(part.location, part.orientation);
                collect(&part.shape, (moves, &mut *meshes), pose, all);
            }
        }
        Shape::Mesh { ref mesh, scale } => {
            let parts = meshes.of(mesh, scale, moves).into_iter();
            all.extend(parts.map(|(own, shape)| Solid::angular(pose * own, shape)));
        }
    }
}

/// Returns wedges around the axis that together form a frustum, because the physics engine uses only four corners of a face.
fn frustum(radius: f64, top_radius: f64, height: f64) -> impl Iterator<Item = SharedShape> {
    let base = cone_base(radius, top_radius, height);
    // The circle lies midway between the circumscribed and the inscribed circle of the polygon.
    let outer = 2.0 / (1.0 + libm::cos(PI / f64::from(FRUSTUM_SIDES)));
    let corner = move |i: u32, radius: f64, y: f64| {
        let (sin, cos) = libm::sincos(TAU * f64::from(i) / f64::from(FRUSTUM_SIDES));
        DVec3::new(outer * radius * cos, y, outer * radius * sin)
    };
    let ends = [(radius, base), (top_radius, base + height)];
    (0..FRUSTUM_SIDES).filter_map(move |i| {
        let corners = ends.map(|(radius, y)| [corner(i, radius, y), corner(i + 1, radius, y), y * DVec3::Y]);
        SharedShape::convex_hull(corners.as_flattened())
    })
}

/// Returns capsules along the circle that replace a torus.
fn torus(radius: f64, tube_radius: f64) -> impl Iterator<Item = SharedShape> {
    // A chord deviates from its arc by radius · (1 − cos(π/n)). A chord that is shifted outwards by half of this deviates by half as much.
    let deviation = (2.0 * TORUS_DEVIATION * tube_radius / radius).min(0.1);
    let sides = (PI / libm::acos(1.0 - deviation)).ceil().clamp(12.0, 96.0);
    let ring = radius * 2.0 / (1.0 + libm::cos(PI / sides));
    let corner = move |i: f64| {
        let (sin, cos) = libm::sincos(TAU * i / sides);
        DVec3::new(ring * cos, 0.0, ring * sin)
    };
    (0..sides as u32)
        .map(move |i| SharedShape::capsule(corner(f64::from(i)), corner(f64::from(i) + 1.0), tube_radius))
}
