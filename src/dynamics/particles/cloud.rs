//! The particles of one source that are alive.

use std::sync::Arc;

use glam::DVec3;

use super::stepper::{Grid, Stepper};
use super::{Course, Field, ParticleSource};
use crate::dynamics::{BodyId, Method};

/// So many particles are advanced side by side: what is known of them fits into the first-level cache.
const LANES: usize = 128;

/// A particle that is alive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Its number: how many were born before it.
    pub number: u64,
    /// Where it is, m.
    pub location: DVec3,
    /// Its velocity, m/s.
    pub velocity: DVec3,
    /// When it was born, s.
    pub born: f64,
    /// When it dies, s: it is there no more then. It may be infinite.
    pub dies: f64,
}

impl Particle {
    /// Which part of its life is over at time `t` (s): from 0 to 1; 0 for one that lives for ever.
    #[must_use]
    pub fn age(&self, t: f64) -> f64 {
        ((t - self.born) / (self.dies - self.born)).clamp(0.0, 1.0)
    }
}

/// The particles of one source that are alive, in the order of their births. Those that are dead take no memory.
#[derive(Clone)]
pub struct Cloud {
    source: Arc<ParticleSource>,
    /// The body that sends them out.
    carrier: Option<BodyId>,
    time: f64,
    /// The number of the particle that is born next.
    next: u64,
    /// Only every n-th particle is computed.
    stride: u64,
    alive: Vec<Particle>,
    wide: Stepper,
    single: Stepper,
}

impl Cloud {
    /// The cloud of a source at time `from` (s), where nothing is born yet; those born earlier are left out. Of each `stride`
    /// particles, one is computed.
    #[must_use]
    pub fn new(
        source: Arc<ParticleSource>,
        carrier: Option<BodyId>,
        fields: &[Field],
        method: &Method,
        (from, stride): (f64, u64),
    ) -> Cloud {
        let kind = (source.mass, source.charge);
        let [wide, single] = [LANES, 1].map(|lanes| Stepper::new(lanes, kind, fields, method));
        let next = source.births.first_from(from).next_multiple_of(stride);
        Cloud { source, carrier, time: from, next, stride, alive: Vec::new(), wide, single }
    }

    /// The time that is reached, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Those that are alive.
    #[must_use]
    pub fn particles(&self) -> &[Particle] {
        &self.alive
    }

    /// From when on a cloud has to be computed to be whole at time `t`, s: the birth of the oldest that can be alive then.
    #[must_use]
    pub fn needed_from(source: &ParticleSource, t: f64) -> f64 {
        (t - source.longest_life).max(source.births.start)
    }

    /// Advances to time `to` (s) by steps of `step` seconds from the present time on. Each particle begins at the very time of its
    /// birth. `course` says how a body moves meanwhile; none while it is not there.
    pub fn advance(&mut self, to: f64, step: f64, course: &dyn Fn(BodyId) -> Option<Course>) {
        let grid = Grid { begin: self.time, end: to, step };
        self.alive.retain(|particle| particle.dies > to);
        if !(self.alive.is_empty() && self.source.births.time(self.next).is_none_or(|birth| birth > to)) {
            self.wide.follow(course);
            self.single.follow(course);
        }
        if to > self.time {
            for some in self.alive.chunks_mut(LANES) {
                self.wide.advance(some, self.time, &grid);
            }
        }
        self.give_birth(&grid, course);
        self.time = to;
    }

    fn give_birth(&mut self, grid: &Grid, course: &dyn Fn(BodyId) -> Option<Course>) {
        let carrier = self.carrier.map(course);
        while let Some(born) = self.source.births.time(self.next).filter(|born| *born <= grid.end) {
            let number = self.next;
            self.next += self.stride;
            let dies = born + self.source.life(number, born);
            let spot = match &carrier {
                None => None,
                Some(Some(course)) => Some(course.spot(born)),
                // What is not there sends out nothing.
                Some(None) => continue,
            };
            if dies <= grid.end {
                continue;
            }
            let (location, velocity) = self.source.begin(number, born, spot.as_ref());
            let mut particle = [Particle { number, location, velocity, born, dies }];
            self.single.advance(&mut particle, born, grid);
            self.alive.extend(particle);
        }
    }
}
