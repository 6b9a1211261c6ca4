//! The origins of particles: where on a source they are born.

use glam::{DQuat, DVec3};

use super::{Triangles, surface};
use crate::dynamics::Shape;
use crate::random::Stream;

/// The region in which particles are born, in the axes of the carrier from its centre of mass, or in world axes without
/// a carrier. The distribution in a disc, a box or a surface is uniform.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// A point, m.
    Point(DVec3),
    /// A flat disc.
    Disc {
        /// The centre of the disc, m.
        centre: DVec3,
        /// The unit normal of the disc.
        normal: DVec3,
        /// The radius of the disc, m.
        radius: f64,
    },
    /// A box with edges along the axes.
    Box {
        /// The centre of the box, m.
        centre: DVec3,
        /// The full lengths of the edges, m.
        size: DVec3,
    },
    /// The surface of a shape. The shape must have one: see [`has_surface`](super::has_surface).
    Surface(Shape),
    /// The triangles of a mesh.
    Triangles(Triangles),
}

/// The place and motion of a body at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The location of the centre of mass, m.
    pub location: DVec3,
    /// The orientation of the body (`world_from_body`).
    pub orientation: DQuat,
    /// The velocity of the centre of mass, m/s.
    pub velocity: DVec3,
    /// The angular velocity, world axes, rad/s.
    pub angular_velocity: DVec3,
}

impl Spot {
    /// The place of a point of the body, m, and its velocity, m/s, both in world axes. `at` is in the body's axes.
    #[must_use]
    pub fn point(&self, at: DVec3) -> (DVec3, DVec3) {
        let arm = self.orientation * at;
        (self.location + arm, self.velocity + self.angular_velocity.cross(arm))
    }
}

impl Origin {
    /// Draws a place in the region, m. Returns the place and the normal there.
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

/// Draws a point in a disc about the origin, with uniform distribution: the square of its distance is uniform.
pub(super) fn within_disc(radius: f64, random: &mut Stream) -> (f64, f64) {
    let distance = radius * random.uniform().sqrt();
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * random.uniform());
    (distance * cos, distance * sin)
}
