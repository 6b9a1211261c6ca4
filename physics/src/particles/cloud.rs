//! The living particles of one source, and their motion.

use std::sync::Arc;

use glam::DVec3;

use super::bounce::Bouncer;
use super::stepper::{Grid, Stepper};
use super::{Field, ParticleSource, RecordedMotion, Scenery};
use crate::contact::{Ball, Surface};
use crate::{BodyId, Method};

/// The number of particles that are advanced side by side. Their data fit into the first-level cache.
const PARTICLES_PER_BATCH: usize = 128;

/// A living particle at the current time of its cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// The number of the particle in its source: the number of particles born earlier.
    pub number: u64,
    /// The location of the particle, world axes, m.
    pub location: DVec3,
    /// The velocity of the particle, world axes, m/s.
    pub velocity: DVec3,
    /// The time at which the particle was born, s.
    pub born: f64,
    /// The time at which the particle disappears, s. It may be infinite.
    pub dies: f64,
}

impl Particle {
    /// Returns the age of the particle at time `t` (s), as a fraction of its lifetime from 0 to 1; 0 for a particle that never dies.
    #[must_use]
    pub fn age(&self, t: f64) -> f64 {
        ((t - self.born) / (self.dies - self.born)).clamp(0.0, 1.0)
    }
}

/// The living particles of one source, in order of birth. Dead particles are removed.
#[derive(Clone)]
pub struct Cloud {
    source: Arc<ParticleSource>,
    /// The body that carries the source. `None` if the source is fixed in the world.
    carrier: Option<BodyId>,
    time: f64,
    /// The number of the next particle that will be born.
    next: u64,
    /// The stride n: only every n-th particle of the source is computed.
    stride: u64,
    alive: Vec<Particle>,
    wide: Stepper,
    single: Stepper,
    /// Lets obstacles stop the particles; `None` if the particles pass through all obstacles.
    bouncer: Option<Bouncer>,
}

impl Cloud {
    /// Creates the empty cloud of a source at time `from`, s. Particles born before `from` are omitted. Of each `stride` particles, only
    /// one is computed.
    #[must_use]
    pub fn new(
        source: Arc<ParticleSource>,
        carrier: Option<BodyId>,
        fields: &[Field],
        method: &Method,
        (from, stride): (f64, u64),
    ) -> Cloud {
        let kind = (source.mass, source.charge);
        let [wide, single] = [PARTICLES_PER_BATCH, 1].map(|lanes| Stepper::new(lanes, kind, fields, method));
        let next = source.births.first_from(from).next_multiple_of(stride);
        Cloud { source, carrier, time: from, next, stride, alive: Vec::new(), wide, single, bouncer: None }
    }

    /// Lets the obstacles of a [`Scenery`] stop the particles. For contacts, each particle is a ball with this radius (m) and this
    /// surface.
    #[must_use]
    pub fn colliding(mut self, radius: f64, surface: Surface) -> Cloud {
        let bouncer = |ball| Bouncer::new(ball, surface, self.single.clone());
        self.bouncer = Ball::new(radius).map(bouncer);
        self
    }

    /// The current time of the cloud, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The living particles of the cloud, in order of birth.
    #[must_use]
    pub fn particles(&self) -> &[Particle] {
        &self.alive
    }

    /// Returns the time from which a cloud must be computed to be complete at time `t`, s. The oldest particle that can still live at `t`
    /// is born at this time.
    #[must_use]
    pub fn needed_from(source: &ParticleSource, t: f64) -> f64 {
        (t - source.longest_life).max(source.births.start)
    }

    /// Advances the cloud from its current time to time `to` (s), in steps of `step` seconds. The path of each particle begins exactly at
    /// its birth. `course` returns the motion of a body in this interval, or `None` if the body is absent.
    pub fn advance(&mut self, to: f64, step: f64, course: &dyn Fn(BodyId) -> Option<RecordedMotion>) {
        self.advance_among(to, step, course, None);
    }

    /// Advances the cloud as [`advance`](Cloud::advance) does, but among obstacles. The obstacles stop the particles of a
    /// [colliding](Cloud::colliding) cloud.
    pub fn advance_among(
        &mut self,
        to: f64,
        step: f64,
        course: &dyn Fn(BodyId) -> Option<RecordedMotion>,
        scenery: Option<&Scenery>,
    ) {
        let grid = Grid { begin: self.time, end: to, step };
        self.alive.retain(|particle| particle.dies > to);
        if !(self.alive.is_empty() && self.source.births.time(self.next).is_none_or(|birth| birth > to)) {
            self.wide.follow(course);
            self.single.follow(course);
            self.bouncer.iter_mut().for_each(|bouncer| bouncer.spare().follow(course));
        }
        let obstacles = self.bouncer.as_mut().zip(scenery.filter(|scenery| !scenery.is_empty()));
        if to > self.time {
            match obstacles {
                None => {
                    for some in self.alive.chunks_mut(PARTICLES_PER_BATCH) {
                        self.wide.advance(some, self.time, &grid);
                    }
                }
                Some((bouncer, scenery)) => {
                    advance_some(&mut self.wide, bouncer, &mut self.alive, self.time, &grid, scenery);
                }
            }
        }
        self.give_birth(&grid, course, scenery);
        self.time = to;
    }

    fn give_birth(
        &mut self,
        grid: &Grid,
        course: &dyn Fn(BodyId) -> Option<RecordedMotion>,
        scenery: Option<&Scenery>,
    ) {
        let scenery = scenery.filter(|scenery| !scenery.is_empty());
        let carrier = self.carrier.map(course);
        while let Some(born) = self.source.births.time(self.next).filter(|born| *born <= grid.end) {
            let number = self.next;
            self.next += self.stride;
            let dies = born + self.source.life(number, born);
            let state = match &carrier {
                None => None,
                Some(Some(course)) => Some(course.state(born)),
                // An absent body emits no particles.
                Some(None) => continue,
            };
            if dies <= grid.end {
                continue;
            }
            let (location, velocity) = self.source.begin(number, born, state.as_ref());
            let mut particle = [Particle { number, location, velocity, born, dies }];
            match self.bouncer.as_mut().zip(scenery) {
                None => self.single.advance(&mut particle, born, grid),
                Some((bouncer, scenery)) => {
                    advance_some(&mut self.single, bouncer, &mut particle, born, grid, scenery);
                }
            }
            self.alive.extend(particle);
        }
    }
}

/// Advances particles from time `t` (s) among obstacles. Particles far from all obstacles move as without obstacles. For all other
/// particles, each step is checked for contacts.
fn advance_some(
    stepper: &mut Stepper,
    bouncer: &mut Bouncer,
    particles: &mut [Particle],
    t: f64,
    grid: &Grid,
    scenery: &Scenery,
) {
    let lanes = stepper.lanes();
    let mut near: Vec<usize> = Vec::new();
    for (chunk, some) in particles.chunks_mut(lanes).enumerate() {
        let begin: Vec<Particle> = some.to_vec();
        let mut boxes = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; some.len()];
        stepper.advance_seen(some, t, grid, &mut |lane, leap| {
            let ([low, high], [from, to]) = (boxes[lane], leap.bounds());
            boxes[lane] = [low.min(from), high.max(to)];
        });
        for (lane, bounds) in boxes.into_iter().enumerate() {
            if scenery.may_stop(&bouncer.ball, bounds, [t, grid.end]) {
                some[lane] = begin[lane];
                near.push(chunk * lanes + lane);
            }
        }
    }
    for some in near.chunks(lanes) {
        let mut moved: Vec<Particle> = some.iter().map(|&number| particles[number]).collect();
        stepper.advance_changed(&mut moved, t, grid, &mut |leap| bouncer.step(leap, scenery));
        some.iter().zip(moved).for_each(|(&number, moved)| particles[number] = moved);
    }
}
