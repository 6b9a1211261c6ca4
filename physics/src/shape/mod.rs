//! Shapes of bodies: their volume, inertia and extent.

mod compound;
mod convex;
mod exit;
mod mesh;
mod principal;
mod solids;
mod submerged;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::{DQuat, DVec2, DVec3};

pub use compound::{Compound, Part};
pub use convex::Placed;
pub use mesh::{Flaw, Mesh};
pub use submerged::Submerged;

/// The shape of a body in its own frame. The origin is the centre of mass. Except for compounds and meshes, the coordinate axes are the
/// principal axes of inertia. If a shape has an axis of symmetry, this axis is along y. Lengths are in metres.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A solid sphere about the origin.
    Sphere {
        /// The radius of the sphere, m.
        radius: f64,
    },
    /// A solid box with edges parallel to the axes.
    Box {
        /// The full lengths of the edges along x, y and z, m.
        size: DVec3,
    },
    /// A solid box with rounded edges and corners: all points within the distance `rounding` of a smaller box.
    RoundedBox {
        /// The full lengths of the box along x, y and z, m.
        size: DVec3,
        /// The radius of the rounded edges and corners, m; at most half of the smallest edge.
        rounding: f64,
    },
    /// A solid cylinder along y.
    Cylinder {
        /// The radius of the cylinder, m.
        radius: f64,
        /// The height of the cylinder, m.
        height: f64,
    },
    /// A solid cylinder along y with a half ball at each end.
    Capsule {
        /// The radius of the cylinder and of the half balls, m.
        radius: f64,
        /// The full height of the capsule, including the half balls, m; at least twice the radius.
        height: f64,
    },
    /// A solid cone or frustum along y, with its base at the bottom. The origin is the centre of mass: for a whole cone, it is a quarter
    /// of the height above the base.
    Cone {
        /// The radius of the base, m.
        radius: f64,
        /// The radius of the top, m; 0 for a whole cone.
        top_radius: f64,
        /// The height from the base to the top, m.
        height: f64,
    },
    /// A solid torus about the y axis.
    Torus {
        /// The distance from the axis to the middle of the tube, m.
        radius: f64,
        /// The radius of the tube, m; at most `radius`.
        tube_radius: f64,
    },
    /// An infinite plane through the origin. The half-space below it is solid.
    Plane {
        /// The unit normal of the plane in the frame of the body. It points out of the solid half-space.
        normal: DVec3,
    },
    /// A triad of axes, which shows an orientation: three arms from the origin along x, y and z. Its volume and inertia are those of a
    /// solid sphere with the radius `length / 2`.
    Axes {
        /// The length of an arm, m.
        length: f64,
    },
    /// Several solids that form one rigid body.
    Compound(Compound),
    /// The solid inside a surface of triangles. If the surface is not closed, the shape has neither volume nor inertia.
    Mesh {
        /// The surface of the solid. Several bodies may share it.
        mesh: Arc<Mesh>,
        /// The length of one unit of the mesh, m.
        scale: f64,
    },
}

/// The largest radius of an arm of [`Shape::Axes`], as a fraction of the arm's length.
const ARM_RADIUS: f64 = 0.078;

impl Shape {
    /// The name of the shape in scenes.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Shape::Sphere { .. } => "sphere",
            Shape::Box { .. } | Shape::RoundedBox { .. } => "box",
            Shape::Cylinder { .. } => "cylinder",
            Shape::Capsule { .. } => "capsule",
            Shape::Cone { .. } => "cone",
            Shape::Torus { .. } => "torus",
            Shape::Plane { .. } => "plane",
            Shape::Axes { .. } => "axes",
            Shape::Compound(_) => "compound",
            Shape::Mesh { .. } => "mesh",
        }
    }

    /// Returns the volume of the shape, m³; `None` for a plane, whose volume is infinite, and for a mesh that is not closed.
    #[must_use]
    pub fn volume(&self) -> Option<f64> {
        Some(match *self {
            Shape::Sphere { radius } => solids::sphere_volume(radius),
            Shape::Box { size } => size.element_product(),
            Shape::RoundedBox { size, rounding } => solids::rounded_box(size, rounding).0,
            Shape::Cylinder { radius, height } => solids::cylinder_volume(radius, height),
            Shape::Capsule { radius, height } => solids::capsule_volume(radius, height),
            Shape::Cone { radius, top_radius, height } => solids::cone_volume(radius, top_radius, height),
            Shape::Torus { radius, tube_radius } => solids::torus_volume(radius, tube_radius),
            Shape::Plane { .. } => return None,
            Shape::Axes { length } => solids::sphere_volume(length / 2.0),
            Shape::Compound(ref compound) => compound.volume(),
            Shape::Mesh { ref mesh, scale } => mesh.volume()? * scale * scale * scale,
        })
    }

    /// Returns the radius of a ball of the same volume, m; `None` if the shape has no finite volume.
    pub fn radius_of_ball(&self) -> Option<f64> {
        self.volume().map(|volume| libm::cbrt(volume * 0.75 / std::f64::consts::PI))
    }

    /// Returns the principal moments of inertia of a homogeneous solid of `mass` kg, kg m².
    ///
    /// Moments of zero mean that no torque rotates the body: for a plane, whose moments are infinite, and for a mesh that is not closed,
    /// whose moments are unknown.
    #[must_use]
    pub fn inertia(&self, mass: f64) -> DVec3 {
        match *self {
            Shape::Sphere { radius } => mass * solids::sphere(radius),
            Shape::Box { size } => mass / 12.0 * solids::box_times_12(size),
            Shape::RoundedBox { size, rounding } => mass * solids::rounded_box(size, rounding).1,
            Shape::Cylinder { radius, height } => mass * solids::cylinder(radius, height),
            Shape::Capsule { radius, height } => mass * solids::capsule(radius, height),
            Shape::Cone { radius, top_radius, height } => mass * solids::cone(radius, top_radius, height),
            Shape::Torus { radius, tube_radius } => mass * solids::torus(radius, tube_radius),
            Shape::Plane { .. } => DVec3::ZERO,
            Shape::Axes { length } => mass * solids::sphere(length / 2.0),
            Shape::Compound(ref compound) => mass * compound.inertia(),
            Shape::Mesh { ref mesh, scale } => mass * scale * scale * mesh.inertia(),
        }
    }

    /// Returns the rotation from the principal axes of inertia to the frame of the body. It is the identity, except for compounds and
    /// meshes.
    #[must_use]
    pub fn principal_axes(&self) -> DQuat {
        match self {
            Shape::Compound(compound) => compound.principal_axes(),
            Shape::Mesh { mesh, .. } => mesh.principal_axes(),
            _ => DQuat::IDENTITY,
        }
    }

    /// Returns the extent of the shape from its centre of mass in the unit direction `direction` (world axes), m. This is the support
    /// function: the largest `p · direction` over all points `p`. Returns `None` for a plane.
    #[must_use]
    pub fn support(&self, world_from_body: DQuat, direction: DVec3) -> Option<f64> {
        if let Shape::Sphere { radius } = *self {
            // This is a fast path for spheres, the most frequent shape. Their extent does not depend on the direction.
            return Some(radius);
        }
        let direction = world_from_body.conjugate() * direction;
        // The variable is the component of the direction perpendicular to the axis of symmetry.
        let across = (direction.x * direction.x + direction.z * direction.z).sqrt();
        Some(match *self {
            Shape::Sphere { radius } => radius,
            Shape::Box { size } => 0.5 * size.dot(direction.abs()),
            Shape::RoundedBox { size, rounding } => (0.5 * size - rounding).dot(direction.abs()) + rounding,
            Shape::Cylinder { radius, height } => 0.5 * height * direction.y.abs() + radius * across,
            Shape::Capsule { radius, height } => (0.5 * height - radius) * direction.y.abs() + radius,
            Shape::Cone { radius, top_radius, height } => {
                let base = cone_base(radius, top_radius, height);
                let top = base + height;
                (base * direction.y + radius * across).max(top * direction.y + top_radius * across)
            }
            Shape::Torus { radius, tube_radius } => radius * across + tube_radius,
            Shape::Plane { .. } => return None,
            // The extreme points are the ends of the three arms and the origin. At the origin, p · direction is 0.
            Shape::Axes { length } => length * (direction.max_element().max(0.0) + ARM_RADIUS),
            Shape::Compound(ref compound) => return compound.support(direction),
            Shape::Mesh { ref mesh, scale } => scale * mesh.support(direction),
        })
    }

    /// Returns the point of the shape that is farthest in a direction, m. The direction is in the frame of the body, and need not be a
    /// unit vector. Returns `None` for shapes that this function does not support: planes, axes, tori, compounds and meshes.
    #[must_use]
    pub fn farthest(&self, direction: DVec3) -> Option<DVec3> {
        let sign = |number: f64| if number < 0.0 { -1.0 } else { 1.0 };
        let corner = |half: DVec3| half * DVec3::new(sign(direction.x), sign(direction.y), sign(direction.z));
        let rim = DVec3::new(direction.x, 0.0, direction.z).normalize_or_zero();
        Some(match *self {
            Shape::Sphere { radius } => radius * direction.normalize_or_zero(),
            Shape::Box { size } => corner(0.5 * size),
            Shape::RoundedBox { size, rounding } => {
                corner(0.5 * size - rounding) + rounding * direction.normalize_or_zero()
            }
            Shape::Cylinder { radius, height } => radius * rim + 0.5 * height * sign(direction.y) * DVec3::Y,
            Shape::Capsule { radius, height } => {
                (0.5 * height - radius) * sign(direction.y) * DVec3::Y
                    + radius * direction.normalize_or_zero()
            }
            Shape::Cone { radius, top_radius, height } => {
                let base = cone_base(radius, top_radius, height);
                let ends = [radius * rim + base * DVec3::Y, top_radius * rim + (base + height) * DVec3::Y];
                if ends[0].dot(direction) > ends[1].dot(direction) { ends[0] } else { ends[1] }
            }
            Shape::Torus { .. }
            | Shape::Plane { .. }
            | Shape::Axes { .. }
            | Shape::Compound(_)
            | Shape::Mesh { .. } => return None,
        })
    }

    /// Returns the radius of a ball around the centre of mass that contains the whole shape, m; `None` for a plane.
    ///
    /// It is the smallest such radius, except for compounds, where it may be slightly larger.
    #[must_use]
    pub fn bounding_radius(&self) -> Option<f64> {
        Some(match *self {
            Shape::Sphere { radius } => radius,
            Shape::Box { size } => size.length() / 2.0,
            Shape::RoundedBox { size, rounding } => (size / 2.0 - rounding).length() + rounding,
            Shape::Cylinder { radius, height } => DVec2::new(radius, height / 2.0).length(),
            Shape::Capsule { height, .. } => height / 2.0,
            Shape::Cone { radius, top_radius, height } => {
                let base = cone_base(radius, top_radius, height);
                DVec2::new(radius, base).length().max(DVec2::new(top_radius, base + height).length())
            }
            Shape::Torus { radius, tube_radius } => radius + tube_radius,
            Shape::Plane { .. } => return None,
            Shape::Axes { length } => length * (1.0 + ARM_RADIUS),
            Shape::Compound(ref compound) => {
                let reach = |part: &Part| Some(part.location.length() + part.shape.bounding_radius()?);
                compound.parts().iter().filter_map(reach).fold(0.0, f64::max)
            }
            Shape::Mesh { ref mesh, scale } => scale * mesh.bounding_radius(),
        })
    }

    /// Returns true if the shape is a torus, or a compound with a torus among its parts.
    #[must_use]
    pub fn has_torus(&self) -> bool {
        match self {
            Shape::Torus { .. } => true,
            Shape::Compound(compound) => compound.parts().iter().any(|part| part.shape.has_torus()),
            Shape::Sphere { .. }
            | Shape::Box { .. }
            | Shape::RoundedBox { .. }
            | Shape::Cylinder { .. }
            | Shape::Capsule { .. }
            | Shape::Cone { .. }
            | Shape::Plane { .. }
            | Shape::Axes { .. }
            | Shape::Mesh { .. } => false,
        }
    }

    /// Returns half of the smallest thickness of the shape, m; `None` for a plane and for a flat mesh. POV-Ray cannot draw a shape whose
    /// thickness is too small.
    #[must_use]
    pub fn half_thickness(&self) -> Option<f64> {
        // This is the radius of the shaft of each arm of the axes, as a fraction of the arm's length.
        const SHAFT_RADIUS: f64 = 0.03;
        Some(match *self {
            Shape::Sphere { radius } => radius,
            Shape::Box { size } | Shape::RoundedBox { size, .. } => size.min_element() / 2.0,
            Shape::Cylinder { radius, height } => radius.min(height / 2.0),
            Shape::Capsule { radius, .. } => radius,
            Shape::Cone { radius, top_radius, height } => radius.max(top_radius).min(height / 2.0),
            Shape::Torus { tube_radius, .. } => tube_radius,
            Shape::Plane { .. } => return None,
            Shape::Axes { length } => length * SHAFT_RADIUS,
            Shape::Compound(ref compound) => return compound.half_thickness(),
            Shape::Mesh { ref mesh, scale } => scale * mesh.half_thickness()?,
        })
    }

    /// Returns the largest extent of the shape from its centre of mass along the positive x, y and z axes of its body, m; `None` for a
    /// plane.
    pub fn extent(&self) -> Option<f64> {
        let reach = |axis: DVec3| self.support(DQuat::IDENTITY, axis);
        Some(reach(DVec3::X)?.max(reach(DVec3::Y)?).max(reach(DVec3::Z)?))
    }

    /// Returns the shape, enlarged by a factor. A plane stays the same.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Shape {
        let mut scaled = self.clone();
        match &mut scaled {
            Shape::Sphere { radius } => *radius *= factor,
            Shape::Box { size } => *size *= factor,
            Shape::RoundedBox { size, rounding } => {
                *size *= factor;
                *rounding *= factor;
            }
            Shape::Cylinder { radius, height } | Shape::Capsule { radius, height } => {
                *radius *= factor;
                *height *= factor;
            }
            Shape::Cone { radius, top_radius, height } => {
                *radius *= factor;
                *top_radius *= factor;
                *height *= factor;
            }
            Shape::Torus { radius, tube_radius } => {
                *radius *= factor;
                *tube_radius *= factor;
            }
            Shape::Plane { .. } => {}
            Shape::Axes { length } => *length *= factor,
            Shape::Compound(compound) => compound.scale(factor),
            Shape::Mesh { scale, .. } => *scale *= factor,
        }
        scaled
    }

    /// Returns whether the shape is infinite, which is true only for a plane.
    #[must_use]
    pub fn is_unbounded(&self) -> bool {
        matches!(self, Shape::Plane { .. })
    }
}

/// Returns the y coordinate of the base of a cone or frustum whose centre of mass is the origin, m; negative.
#[must_use]
pub fn cone_base(radius: f64, top_radius: f64, height: f64) -> f64 {
    -solids::cone_centre(radius, top_radius, height)
}
