//! The regions in which particles are born.

use glam::{DQuat, DVec3};

use super::{Triangles, surface};
use crate::Shape;
use crate::random::Stream;

/// The region in which particles are born, relative to the centre of mass of the body that carries the source, in body axes. If no body
/// carries the source, the region is in world axes. The distribution in a disc, in a box or on a surface is uniform.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// A single point, m.
    Point(DVec3),
    /// A flat circular disc.
    Disc {
        /// The centre of the disc, m.
        centre: DVec3,
        /// The unit normal of the disc.
        normal: DVec3,
        /// The radius of the disc, m.
        radius: f64,
    },
    /// A box with edges parallel to the axes.
    Box {
        /// The centre of the box, m.
        centre: DVec3,
        /// The full lengths of the edges, m.
        size: DVec3,
    },
    /// The surface of a shape for which [`has_surface`](super::has_surface) is true.
    Surface(Shape),
    /// The surface of a mesh, as triangles.
    Triangles(Triangles),
}

/// The pose, the velocity and the angular velocity of a body at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// The location of the centre of mass, world axes, m.
    pub location: DVec3,
    /// The orientation of the body: the rotation from body axes to world axes.
    pub orientation: DQuat,
    /// The velocity of the centre of mass, world axes, m/s.
    pub velocity: DVec3,
    /// The angular velocity of the body, world axes, rad/s.
    pub angular_velocity: DVec3,
}

impl BodyState {
    /// Returns the position (m) and the velocity (m/s) of a point of the body, both in world axes. `at` is the point in body axes, from
    /// the centre of mass.
    #[must_use]
    pub fn point(&self, at: DVec3) -> (DVec3, DVec3) {
        let arm = self.orientation * at;
        (self.location + arm, self.velocity + self.angular_velocity.cross(arm))
    }
}

impl Origin {
    /// Draws a random position in the region. Returns the position (m) and the unit normal at this position.
    #[must_use]
    pub fn place(&self, random: &mut Stream) -> (DVec3, DVec3) {
        match self {
            Origin::Point(point) => (*point, DVec3::Y),
            Origin::Disc { centre, normal, radius } => {
                let (x, y) = within_disc(*radius, random);
                let (along, across) = normal.any_orthonormal_pair();
                (*centre + x * along + y * across, *normal)
            }
            Origin::Box { centre, size } => {
                let part = DVec3::new(random.uniform(), random.uniform(), random.uniform());
                (*centre + (part - 0.5) * *size, DVec3::Y)
            }
            Origin::Surface(shape) => surface::place(shape, random),
            Origin::Triangles(triangles) => triangles.place(random),
        }
    }
}

/// Draws a random point in a disc about the origin, with uniform distribution over the area: the square of the distance from the centre is
/// uniform.
pub(super) fn within_disc(radius: f64, random: &mut Stream) -> (f64, f64) {
    let distance = radius * random.uniform().sqrt();
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * random.uniform());
    (distance * cos, distance * sin)
}
