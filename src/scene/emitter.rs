//! The emitters of particles of a checked scene.

use std::sync::Arc;

use super::Color;
use crate::dynamics::{BodyId, ParticleSource, Surface};

/// A source of particles, with their look.
#[derive(Clone, Debug)]
pub struct Emitter {
    /// Its name, unique among emitters.
    pub name: Arc<str>,
    /// When, where and how its particles begin.
    pub source: Arc<ParticleSource>,
    /// The body that sends them out, and moves on.
    pub carrier: Option<BodyId>,
    /// The radius of a particle, m.
    pub radius: f64,
    /// The surface of a particle; none: it passes through bodies.
    pub collides: Option<Surface>,
    /// How many times larger it is drawn over its life: the first at its birth, the last at its death, evenly between.
    pub sizes: Vec<f64>,
    /// Its color over its life, in the same way.
    pub colors: Vec<Color>,
    /// How brightly it shines by itself; 0 if it does not.
    pub glow: f64,
    /// It is drawn as a streak that is as long as its way in this time, s; 0: as a ball.
    pub streak: f64,
}

impl Emitter {
    /// The color of a particle at an age from 0 (birth) to 1 (death).
    #[must_use]
    pub fn color_at(&self, age: f64) -> Color {
        Color([0, 1, 2].map(|i| at_age(&self.colors, age, |color| color.0[i])))
    }

    /// The radius with which a particle is drawn at an age from 0 (birth) to 1 (death), m.
    #[must_use]
    pub fn radius_at(&self, age: f64) -> f64 {
        self.radius * at_age(&self.sizes, age, |size| *size)
    }

    /// The most particles that can be alive at once, as far as that is known before the run.
    #[must_use]
    pub fn most_alive(&self, duration: f64) -> f64 {
        let births = self.source.births;
        let life = self.source.longest_life.min(duration.max(0.0) - births.start.min(0.0));
        self.births_within(life)
    }

    /// The most births within so long a time, s.
    #[must_use]
    pub fn births_within(&self, time: f64) -> f64 {
        let births = self.source.births;
        #[allow(clippy::cast_precision_loss, reason = "counts of particles are far below 2^53")]
        let at_once = births.at_once as f64;
        at_once * ((time.min(births.end - births.start) / births.every).floor() + 1.0)
    }
}

/// Interpolates values spaced evenly from birth to death, at an age from 0 to 1.
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
