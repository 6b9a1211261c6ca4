//! The particle emitters of a checked scene.

use std::sync::Arc;

use super::Color;
use crate::physics::{BodyId, ParticleSource, Surface};

/// A particle source and the look of its particles.
#[derive(Clone, Debug)]
pub struct Emitter {
    /// The name of the emitter, unique among emitters.
    pub name: Arc<str>,
    /// The birth times, initial locations and initial velocities of the particles.
    pub source: Arc<ParticleSource>,
    /// The body that the emitter moves with. `None` if the emitter is fixed in the world.
    pub carrier: Option<BodyId>,
    /// The radius of a particle, m.
    pub radius: f64,
    /// The contact properties of the particles' surfaces. `None` if particles pass through bodies.
    pub collides: Option<Surface>,
    /// The factors by which the drawn radius of a particle is multiplied, evenly spaced over its life. The first factor holds at birth,
    /// the last at death.
    pub sizes: Vec<f64>,
    /// The colors of a particle, evenly spaced over its life. The first color holds at birth, the last at death.
    pub colors: Vec<Color>,
    /// The brightness of the light that a particle emits. 0 if it emits no light, 1 if the light has exactly the particle's color.
    pub glow: f64,
    /// The time that a streak covers, s. A particle is drawn as a streak along its path during this time, or as a ball if the time is 0.
    pub streak: f64,
}

impl Emitter {
    /// Returns the color of a particle at an age from 0 (birth) to 1 (death).
    #[must_use]
    pub fn color_at(&self, age: f64) -> Color {
        Color([0, 1, 2].map(|i| at_age(&self.colors, age, |color| color.0[i])))
    }

    /// Returns the drawn radius of a particle, m, at an age from 0 (birth) to 1 (death).
    #[must_use]
    pub fn radius_at(&self, age: f64) -> f64 {
        self.radius * at_age(&self.sizes, age, |size| *size)
    }

    /// Returns an upper bound for the number of particles that are alive at the same time during a run of the given duration, s.
    #[must_use]
    pub fn most_alive(&self, duration: f64) -> f64 {
        let births = self.source.births;
        let life = self.source.longest_life.min(duration.max(0.0) - births.start.min(0.0));
        self.births_within(life)
    }

    /// Returns the largest number of births in any interval of length `time`, s.
    #[must_use]
    pub fn births_within(&self, time: f64) -> f64 {
        let births = self.source.births;
        #[allow(clippy::cast_precision_loss, reason = "counts of particles are far below 2^53")]
        let at_once = births.at_once as f64;
        at_once * ((time.min(births.end - births.start) / births.every).floor() + 1.0)
    }
}

/// Interpolates between values that are evenly spaced over a particle's life, at an age from 0 (birth) to 1 (death).
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "values are few, and an age goes from 0 to 1"
)]
fn at_age<T>(values: &[T], age: f64, number: impl Fn(&T) -> f64) -> f64 {
    let place = age * (values.len() - 1) as f64;
    let before = (place as usize).min(values.len() - 1);
    let after = (before + 1).min(values.len() - 1);
    let (from, to) = (number(&values[before]), number(&values[after]));
    from + (to - from) * (place - before as f64)
}
