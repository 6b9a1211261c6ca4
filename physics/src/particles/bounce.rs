//! Collisions of a particle with obstacles: impacts, friction and lasting contact.
//!
//! A particle is a small ball without rotation. If its path during a step leads into an obstacle, conservative advancement finds the first
//! time of contact (B. V. Mirtich, *Impulse-based dynamic simulation of rigid body systems* (1996), chapter 2). At that time, the particle
//! gets an impulse by Newton's law of impact and Coulomb's law of friction. The remaining part of the step starts at that time. If the
//! rebound would last for less than a fraction of a step, the particle stays in contact: it slides or sticks.

use glam::DVec3;

use super::hold;
use super::obstacles::{Near, Scenery, Target};
use super::particle_step::{ParticlePath, ParticleStep};
use super::stepper::Stepper;
use crate::contact::{Ball, ContactProperties, Surface};

/// A particle touches an obstacle if the gap is at most this fraction of its radius, or at most [`COORDINATE_ROUNDING`]
/// times its largest coordinate.
const CONTACT_TOLERANCE: f64 = 1e-11;
/// A gap counts as a rounding error if it is at most this fraction of the particle's largest coordinate.
const COORDINATE_ROUNDING: f64 = 2e-15;
/// At the beginning of a step, a gap counts as contact if it is at most this fraction of the particle's radius.
const INITIAL_CONTACT_TOLERANCE: f64 = 1e-6;
/// A closing speed counts as a rounding error if it is below this fraction of the speeds of particle and obstacle.
const SPEED_ROUNDING: f64 = 1e-10;
/// The shortest time of a rebound, as a fraction of a step. A shorter rebound is ignored: the particle stays in contact.
const MIN_REBOUND_TIME: f64 = 0.25;
/// The largest number of impacts and new contacts in one step of a particle.
const MAX_IMPACTS_PER_STEP: usize = 12;
/// The largest number of iterations of conservative advancement towards a contact. After them, each iteration covers at least the
/// fraction [`MIN_STEP_FRACTION`] of the step.
const MAX_SAFE_STEPS: usize = 60;
/// The shortest advance in time where conservative advancement cannot go on by itself, as a fraction of the step.
const MIN_STEP_FRACTION: f64 = 1.0 / 64.0;
/// The largest number of iterations for the impulses of simultaneous contacts.
const MAX_IMPULSE_ITERATIONS: usize = 50;

/// Moves the particles of one source among obstacles.
#[derive(Clone)]
pub(super) struct Bouncer {
    pub(super) ball: Ball,
    surface: Surface,
    /// A stepper for single particles. After an impact, it computes the remaining part of the step.
    spare: Stepper,
    targets: Vec<Target>,
    seen: Vec<Contact>,
}

/// A part of an obstacle that the particle may touch, with its distance and relative motion at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub(super) target: Target,
    pub(super) near: Near,
    pub(super) law: ContactProperties,
    /// The rate of change of the gap between particle and part, m/s; negative if they approach each other.
    rate: f64,
    /// The speed of approach up to which an approach is taken for a rounding error, m/s.
    slight: f64,
    /// The speed up to which an approach or a rebound is too slow for an impact, m/s. The particle then stays in contact.
    slow: f64,
    /// Whether a force presses the particle against the part.
    is_pressed: bool,
}

impl Contact {
    /// Returns whether the particle touches the part: the gap is at most `snug`, m.
    fn touches(&self, snug: f64) -> bool {
        !self.near.is_hidden && self.near.gap <= snug
    }
}

impl Bouncer {
    pub(super) fn new(ball: Ball, surface: Surface, spare: Stepper) -> Bouncer {
        Bouncer { ball, surface, spare, targets: Vec::new(), seen: Vec::new() }
    }

    pub(super) fn spare(&mut self) -> &mut Stepper {
        &mut self.spare
    }

    /// Returns the position (m) and the velocity (m/s) of a particle at the end of a step among obstacles. `leap` is the same step without
    /// obstacles.
    pub(super) fn step(&mut self, leap: &ParticleStep, scenery: &Scenery) -> (DVec3, DVec3) {
        let whole = leap.span();
        let mut leap = *leap;
        for _ in 0..MAX_IMPACTS_PER_STEP {
            self.look(&leap, whole, scenery);
            if self.seen.is_empty() {
                return (leap.places[1], leap.velocities[1]);
            }
            let snug = INITIAL_CONTACT_TOLERANCE * self.ball.radius();
            if self.seen.iter().any(|it| it.touches(snug) && it.rate < -it.slow) {
                leap.velocities[0] = self.strike(leap.velocities[0], snug);
                self.again(&mut leap);
                continue;
            }
            let is_held = |it: &Contact| it.is_pressed && it.touches(snug) && it.rate <= it.slow;
            self.seen.sort_by_key(|it| (!is_held(it), scenery.is_still(&it.target)));
            let held = self.seen.iter().take_while(|it| is_held(it)).count();
            let (held, others) = self.seen.split_at(held);
            let (end, velocity) = match held {
                [] => (leap.places[1], leap.velocities[1]),
                _ => hold::hold(&self.ball, &leap, held, scenery),
            };
            let moved = ParticleStep {
                places: [leap.places[0], end],
                velocities: [leap.velocities[0], velocity],
                ..leap
            };
            let way = moved.way();
            let stays = end == leap.places[0] && velocity == DVec3::ZERO;
            let may_hit = |it: &&Contact| !(stays && scenery.is_still(&it.target));
            let hits = others.iter().filter(may_hit).filter_map(|it| self.touch(&way, it, &leap, scenery));
            let Some(hit) = hits.min_by(f64::total_cmp) else { return (end, velocity) };
            leap.times[0] += hit;
            if leap.times[0] >= leap.times[1] {
                return (way.place(hit), way.velocity(hit));
            }
            (leap.places[0], leap.velocities[0]) = (way.place(hit), way.velocity(hit));
            self.again(&mut leap);
        }
        // After too many impacts, the particle moves with the nearest obstacle until the end of the step.
        let last = self.seen.iter().min_by(|a, b| a.near.gap.total_cmp(&b.near.gap));
        let velocity = last.map_or(DVec3::ZERO, |it| it.near.velocity);
        (leap.places[0] + leap.span() * velocity, velocity)
    }

    /// Computes the end of a step again without obstacles, after the time, the position or the velocity at its beginning has changed.
    fn again(&mut self, leap: &mut ParticleStep) {
        (leap.places[1], leap.velocities[1]) =
            self.spare.leap((leap.places[0], leap.velocities[0]), leap.times);
    }

    /// Finds all parts of obstacles that the particle may touch within a step, and their gaps at the beginning of the step. `whole` is the
    /// length of the full step, s.
    fn look(&mut self, leap: &ParticleStep, whole: f64, scenery: &Scenery) {
        let Bouncer { ball, surface, targets, seen, .. } = self;
        seen.clear();
        // The margin bounds how far a particle in contact can deviate from its path without obstacles.
        let radius = ball.radius();
        let margin = leap.span() * (leap.span() * leap.acceleration().length() + scenery.fastest());
        scenery.near(leap.bounds(), (1.0 + INITIAL_CONTACT_TOLERANCE) * radius + margin, leap.times, targets);
        let ([place, _], [velocity, _]) = (leap.places, leap.velocities);
        let acceleration = leap.acceleration();
        for target in &*targets {
            let near = scenery.seen(ball, target, place, leap.times[0]);
            // A particle that begins inside an obstacle passes through this obstacle.
            if near.gap < -radius || !near.gap.is_finite() {
                continue;
            }
            let rate = near.normal.dot(velocity - near.velocity);
            let against = acceleration - scenery.acceleration(target, place, leap.times[0]);
            let press = -near.normal.dot(against);
            let slight =
                SPEED_ROUNDING * (velocity.length() + near.velocity.length() + whole * acceleration.length());
            let slow = (0.5 * MIN_REBOUND_TIME * whole * press).max(slight);
            let law = surface.meet(scenery.surface(target));
            let is_pressed = press > 0.0;
            seen.push(Contact { target: *target, near, law, rate, slight, slow, is_pressed });
        }
    }

    /// Returns the velocity after simultaneous impacts at all touched parts. `before` is the velocity before the impacts.
    fn strike(&self, before: DVec3, snug: f64) -> DVec3 {
        let struck = self.seen.iter().filter(|it| it.touches(snug));
        let mut struck: Vec<(&Contact, f64, DVec3)> = struck.map(|it| (it, 0.0, DVec3::ZERO)).collect();
        let mut velocity = before;
        for _ in 0..MAX_IMPULSE_ITERATIONS {
            let last = velocity;
            for (it, pushed, rubbed) in &mut struck {
                let (normal, law) = (it.near.normal, it.law);
                let rebound = -law.restitution * it.rate;
                let rebound = if rebound > it.slow { rebound } else { 0.0 };
                let relative = velocity - it.near.velocity;
                let push = (*pushed + rebound - normal.dot(relative)).max(0.0);
                let rub = *rubbed - relative.reject_from_normalized(normal);
                let rub = rub.clamp_length_max(law.friction * push);
                velocity += (push - *pushed) * normal + (rub - *rubbed);
                (*pushed, *rubbed) = (push, rub);
            }
            if struck.len() == 1
                || (velocity - last).length() <= SPEED_ROUNDING * SPEED_ROUNDING.sqrt() * before.length()
            {
                break;
            }
        }
        velocity
    }

    /// Returns the time of the first contact with a part, in seconds after the beginning of the path; `None` if the particle does not reach
    /// the part.
    fn touch(
        &self,
        way: &ParticlePath,
        contact: &Contact,
        leap: &ParticleStep,
        scenery: &Scenery,
    ) -> Option<f64> {
        let span = leap.span();
        let touch = (CONTACT_TOLERANCE * self.ball.radius())
            .max(COORDINATE_ROUNDING * leap.places[0].abs().max_element());
        let mut near = contact.near;
        let mut time = 0.0;
        for advance in 0.. {
            let velocity = way.rate(time);
            let bend = way.bend + near.bend;
            let mut safe = if near.is_hidden && near.gap <= touch {
                // The particle touches a neighbouring triangle, but may reach this triangle later.
                MIN_STEP_FRACTION * span
            } else if near.gap <= touch {
                let rate = near.normal.dot(velocity - near.velocity);
                if rate < -contact.slight {
                    return Some(time);
                }
                // The particle touches the part without approaching it. The gap stays open until the curvature of the paths can close it.
                let safe = if bend > 0.0 { 2.0 * rate.max(0.0) / bend } else { f64::INFINITY };
                safe.max(MIN_STEP_FRACTION * span)
            } else {
                let shrink = near.coming - near.normal.dot(velocity);
                let root = (shrink * shrink + 2.0 * bend * near.gap).sqrt();
                // This is the smallest positive root of gap − shrink t − ½ bend t², in a form without cancellation.
                if shrink > 0.0 {
                    2.0 * near.gap / (shrink + root)
                } else if bend > 0.0 {
                    (root - shrink) / bend
                } else {
                    f64::INFINITY
                }
            };
            if advance > MAX_SAFE_STEPS {
                safe = safe.max(MIN_STEP_FRACTION * span);
            }
            time += safe;
            if time >= span || time.is_nan() {
                return None;
            }
            near = scenery.seen(&self.ball, &contact.target, way.place(time), leap.times[0] + time);
        }
        None
    }
}
