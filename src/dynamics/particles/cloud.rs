//! The particles of one source that are alive.

use std::sync::Arc;

use glam::DVec3;

use super::bounce::Bouncer;
use super::stepper::{Grid, Stepper};
use super::{Course, Field, ParticleSource, Scenery};
use crate::dynamics::contact::{Ball, Surface};
use crate::dynamics::{BodyId, Method};

/// The number of particles that are advanced side by side. Their data fit into the first-level cache.
const LANES: usize = 128;

/// A particle that is alive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Its number: how many were born before it.
    pub number: u64,
    /// The place of the particle, m.
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
    /// Moves the particles among obstacles, if obstacles stop them.
    bouncer: Option<Bouncer>,
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
        Cloud { source, carrier, time: from, next, stride, alive: Vec::new(), wide, single, bouncer: None }
    }

    /// The same, but what a [`Scenery`] holds stops its particles, which are balls of a radius, m, with a surface.
    #[must_use]
    pub fn colliding(mut self, radius: f64, surface: Surface) -> Cloud {
        let bouncer = |ball| Bouncer::new(ball, surface, self.single.clone());
        self.bouncer = Ball::new(radius).map(bouncer);
        self
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
        self.advance_among(to, step, course, None);
    }

    /// The same among obstacles, which stop the particles of a cloud that is [colliding](Cloud::colliding).
    pub fn advance_among(
        &mut self,
        to: f64,
        step: f64,
        course: &dyn Fn(BodyId) -> Option<Course>,
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
                    for some in self.alive.chunks_mut(LANES) {
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
        course: &dyn Fn(BodyId) -> Option<Course>,
        scenery: Option<&Scenery>,
    ) {
        let scenery = scenery.filter(|scenery| !scenery.is_empty());
        let carrier = self.carrier.map(course);
        while let Some(born) = self.source.births.time(self.next).filter(|born| *born <= grid.end) {
            let number = self.next;
            self.next += self.stride;
            let dies = born + self.source.life(number, born);
            let spot = match &carrier {
                None => None,
                Some(Some(course)) => Some(course.spot(born)),
                // An absent body sends out nothing.
                Some(None) => continue,
            };
            if dies <= grid.end {
                continue;
            }
            let (location, velocity) = self.source.begin(number, born, spot.as_ref());
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

/// Advances particles among obstacles. Those that come near none of them move as they would without any; for the others, each step is
/// looked at.
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
