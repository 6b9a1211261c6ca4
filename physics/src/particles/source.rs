//! The sources of particles, which set the initial values of the particles.

use std::fmt::Debug;
use std::sync::Arc;

use glam::DVec3;

use super::{Births, BodyState, Origin};
use crate::random::Stream;

/// A quantity that has its own, possibly random value for each particle.
pub trait Draw: Debug + Send + Sync {
    /// Returns the value for a particle that is born at time `t`, s. `random` is the particle's own stream of random numbers.
    fn draw(&self, t: f64, random: &mut Stream) -> f64;
}

/// A constant: all particles get the same value.
impl Draw for f64 {
    fn draw(&self, _: f64, _: &mut Stream) -> f64 {
        *self
    }
}

/// A source that emits particles.
#[derive(Clone, Debug)]
pub struct ParticleSource {
    /// The birth times of the particles.
    pub births: Births,
    /// The lifetime of a particle, s.
    pub lifetime: Arc<dyn Draw>,
    /// The largest lifetime that a particle can have, s. It may be infinite.
    pub longest_life: f64,
    /// The region in which the particles are born.
    pub origin: Origin,
    /// The mean direction in which particles leave the source: a unit vector in the axes of the body that carries the source, or in world
    /// axes without such a body. `None` stands for the normal of the surface at which the particle is born.
    pub direction: Option<DVec3>,
    /// The half angle of the cone of directions in which particles leave the source, rad. Directions are distributed uniformly over the
    /// cone.
    pub spread: f64,
    /// The initial speed of a particle relative to the source, m/s.
    pub speed: Arc<dyn Draw>,
    /// The mass of a particle, kg.
    pub mass: f64,
    /// The charge of a particle, C.
    pub charge: f64,
    /// The random numbers of the source. Each particle derives its own independent streams from this stream.
    pub random: Stream,
}

/// The number of independent streams of random numbers that are reserved for each particle.
const STREAMS_PER_PARTICLE: u64 = 4;

impl ParticleSource {
    /// Returns the lifetime of a particle that is born at time `t` (s), s.
    #[must_use]
    pub fn life(&self, number: u64, t: f64) -> f64 {
        self.lifetime.draw(t, &mut self.substream(number, 0)).min(self.longest_life)
    }

    /// Returns the initial position (m) and velocity (m/s), world axes, of a particle that is born at time `t`, s. `carrier` is the pose
    /// and motion of the body that carries the source.
    #[must_use]
    pub fn begin(&self, number: u64, t: f64, carrier: Option<&BodyState>) -> (DVec3, DVec3) {
        let mut random = self.substream(number, 1);
        let (place, normal) = self.origin.place(&mut random);
        let middle = self.direction.unwrap_or(normal);
        let direction = within_cone(middle, self.spread, &mut random);
        let speed = self.speed.draw(t, &mut self.substream(number, 2));
        match carrier {
            Some(state) => {
                let (location, velocity) = state.point(place);
                (location, velocity + speed * (state.orientation * direction))
            }
            None => (place, speed * direction),
        }
    }

    fn substream(&self, number: u64, which: u64) -> Stream {
        self.random.substream(number.wrapping_mul(STREAMS_PER_PARTICLE).wrapping_add(which))
    }
}

/// Draws a random direction in a cone about a unit vector, with uniform distribution over the solid angle: the cosine of the angle is
/// uniform from cos(spread) to 1 (Archimedes' hat-box theorem).
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
