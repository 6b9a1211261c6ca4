//! Random numbers that are the same on every machine.

use glam::{DQuat, DVec3};
use jabuka::physics::random::Stream;

/// Draws what random scenes are made of.
pub(crate) struct Random(Stream);

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        Random(Stream::new(seed, "families"))
    }

    /// Draws a number between two limits.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.uniform()
    }

    /// Draws a number below a limit.
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        (limit as f64 * self.0.uniform()) as usize
    }

    /// Returns true with this probability.
    pub(crate) fn chance(&mut self, probability: f64) -> bool {
        self.0.uniform() < probability
    }

    pub(crate) fn choose<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }

    /// Draws a vector whose components are between −`most` and `most`.
    pub(crate) fn vector(&mut self, most: f64) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| self.between(-most, most)))
    }

    /// Draws a unit vector.
    pub(crate) fn direction(&mut self) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| self.0.normal())).normalize_or(DVec3::X)
    }

    /// Draws a rotation.
    pub(crate) fn turn(&mut self) -> DQuat {
        let [x, y, z, w] = std::array::from_fn(|_| self.0.normal());
        let turn = DQuat::from_xyzw(x, y, z, w);
        if turn.length() > 0.0 { turn.normalize() } else { DQuat::IDENTITY }
    }
}
