//! Initial values of particles.

use std::fmt::Debug;
use std::sync::Arc;

use glam::DVec3;

use super::{Births, Origin, Spot};
use crate::random::Stream;

/// A number that every particle has of its own.
pub trait Draw: Debug + Send + Sync {
    /// The number of a particle that is born at time `t`, s. `random` is the particle's own.
    fn draw(&self, t: f64, random: &mut Stream) -> f64;
}

/// It is the same for all.
impl Draw for f64 {
    fn draw(&self, _: f64, _: &mut Stream) -> f64 {
        *self
    }
}

/// A source of particles.
#[derive(Clone, Debug)]
pub struct ParticleSource {
    /// When they are born.
    pub births: Births,
    /// The lifetime of a particle, s.
    pub lifetime: Arc<dyn Draw>,
    /// No particle lives longer, s; it may be infinite.
    pub longest_life: f64,
    /// The origin of the particles.
    pub origin: Origin,
    /// The middle of the directions in which they leave, a unit vector in the axes of the body that sends them out, or of the
    /// world where none does; none: along the normal of the surface that they come from.
    pub direction: Option<DVec3>,
    /// The half angle of the cone of directions, rad; within it, each direction is as likely.
    pub spread: f64,
    /// The speed relative to the source, m/s.
    pub speed: Arc<dyn Draw>,
    /// The mass of each, kg.
    pub mass: f64,
    /// The charge of each, C.
    pub charge: f64,
    /// Their random numbers: each particle has branches of its own.
    pub random: Stream,
}

/// The branches of random numbers that a particle has.
const BRANCHES: u64 = 4;

impl ParticleSource {
    /// The lifetime of a particle that is born at time `t`, s.
    #[must_use]
    pub fn life(&self, number: u64, t: f64) -> f64 {
        self.lifetime.draw(t, &mut self.branch(number, 0)).min(self.longest_life)
    }

    /// The initial place and velocity of a particle that is born at time `t` (s). `carrier` is the body that sends it out.
    #[must_use]
    pub fn begin(&self, number: u64, t: f64, carrier: Option<&Spot>) -> (DVec3, DVec3) {
        let mut random = self.branch(number, 1);
        let (place, normal) = self.origin.place(&mut random);
        let middle = self.direction.unwrap_or(normal);
        let direction = within_cone(middle, self.spread, &mut random);
        let speed = self.speed.draw(t, &mut self.branch(number, 2));
        match carrier {
            Some(spot) => {
                let (location, velocity) = spot.point(place);
                (location, velocity + speed * (spot.orientation * direction))
            }
            None => (place, speed * direction),
        }
    }

    fn branch(&self, number: u64, which: u64) -> Stream {
        self.random.branch(number.wrapping_mul(BRANCHES).wrapping_add(which))
    }
}

/// A direction within a cone about a unit vector, each of the same solid angle as likely: the cosine of the angle is uniform
/// from cos(spread) to 1 (Archimedes' hat box).
fn within_cone(middle: DVec3, spread: f64, random: &mut Stream) -> DVec3 {
    let (cosine, turn) = (random.uniform(), random.uniform());
    if spread == 0.0 {
        return middle;
    }
    let cosine = 1.0 - cosine * (1.0 - libm::cos(spread));
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (along, across) = middle.any_orthonormal_pair();
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * turn);
    cosine * middle + sine * (cos * along + sin * across)
}
