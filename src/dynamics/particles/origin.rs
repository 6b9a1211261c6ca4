//! Origins of particles.

use glam::{DQuat, DVec3};

use super::{Triangles, surface};
use crate::dynamics::Shape;
use crate::random::Stream;

/// The origin of particles, in the axes of the body that sends them out, from its centre of mass, or else in those of the world.
/// Within a disc, a box or a surface, the distribution is uniform.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// A point, m.
    Point(DVec3),
    /// A flat disc.
    Disc {
        /// Its middle, m.
        centre: DVec3,
        /// The unit vector that stands on it.
        normal: DVec3,
        /// Its radius, m.
        radius: f64,
    },
    /// A box along the axes.
    Box {
        /// Its middle, m.
        centre: DVec3,
        /// Full lengths of its edges, m.
        size: DVec3,
    },
    /// The surface of a shape that [has one](super::has_surface).
    Surface(Shape),
    /// The triangles of a mesh.
    Triangles(Triangles),
}

/// A body that sends out particles, at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Its centre of mass, m.
    pub location: DVec3,
    /// Its orientation (`world_from_body`).
    pub orientation: DQuat,
    /// Its velocity, m/s.
    pub velocity: DVec3,
    /// Its angular velocity, world axes, rad/s.
    pub angular_velocity: DVec3,
}

impl Spot {
    /// The place of a point of the body, and its velocity.
    #[must_use]
    pub fn point(&self, at: DVec3) -> (DVec3, DVec3) {
        let arm = self.orientation * at;
        (self.location + arm, self.velocity + self.angular_velocity.cross(arm))
    }
}

impl Origin {
    /// A place, and the normal there.
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

/// A place in a disc about the origin: the square of its distance is uniform.
pub(super) fn within_disc(radius: f64, random: &mut Stream) -> (f64, f64) {
    let distance = radius * random.uniform().sqrt();
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * random.uniform());
    (distance * cos, distance * sin)
}
