//! Finds the impacts: contacts at which two bodies begin to push each other while they approach fast.

use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};

use glam::DVec3;
use rapier3d_f64::prelude::{
    ColliderHandle, ColliderSet, CollisionEvent, ContactPair, EventHandler, PhysicsWorld, RigidBodySet,
    SoftBodySet, SoftBodyTearEvent,
};

use super::super::contact::Impact;
use super::super::motion::Twist;
use super::rebound::{Onset, Rebounds};
use super::touch::Touch;

/// A new contact counts as an impact only if the bodies approach faster than this many thicknesses of the thinnest moving body per second.
const MIN_IMPACT_SPEED: f64 = 0.03;

/// The impacts of a run, and the pairs of bodies that may soon collide.
pub(super) struct Impacts {
    /// The impacts that [`Impacts::take`] has not returned yet.
    found: Vec<Impact>,
    /// Pairs of colliders that are near each other, and between which no contact force has acted yet.
    pub(super) near: Vec<[ColliderHandle; 2]>,
    pub(super) events: Events,
    /// A new contact is an impact only if the bodies approach faster than this, m/s.
    slow: f64,
}

/// The motion of all bodies in one step.
pub(super) struct StepMotion<'a> {
    /// The twist of each body before the step, and its mean during the step.
    pub(super) before: &'a [Twist],
    pub(super) mean: &'a [Twist],
    /// The position of each body's centre of mass before the step, m.
    pub(super) places: &'a [DVec3],
}

/// Collects the physics engine's collision events: two colliders come near each other, or separate.
#[derive(Default)]
pub(super) struct Events(Mutex<Vec<CollisionEvent>>);

impl EventHandler for Events {
    fn handle_collision_event(
        &self,
        _: &RigidBodySet,
        _: &ColliderSet,
        event: CollisionEvent,
        _: Option<&ContactPair>,
    ) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(event);
    }

    fn handle_contact_force_event(&self, _: f64, _: &RigidBodySet, _: &ColliderSet, _: &ContactPair, _: f64) {
    }

    fn handle_soft_body_tear_event(&self, _: &SoftBodySet, _: &SoftBodyTearEvent) {}
}

/// The pairs of colliders with a first contact impulse in a step. They were near each other before, without a contact force.
pub(super) struct Pushing {
    /// For each collider, whether it belongs to a near pair. Most colliders do not, so most pairs need no look-up in the set.
    is_near: Vec<bool>,
    pairs: HashSet<[ColliderHandle; 2]>,
}

impl Pushing {
    /// Creates an empty set that accepts only the colliders of the given near pairs.
    fn among(near: &[[ColliderHandle; 2]]) -> Pushing {
        let mut pushing = Pushing { is_near: Vec::new(), pairs: HashSet::new() };
        for collider in near.as_flattened() {
            let number = number(*collider);
            if pushing.is_near.len() <= number {
                pushing.is_near.resize(number + 1, false);
            }
            pushing.is_near[number] = true;
        }
        pushing
    }

    /// Adds a pair with a contact impulse, if both colliders belong to near pairs.
    pub(super) fn see(&mut self, pair: &ContactPair) {
        let pair = [pair.collider1, pair.collider2];
        if pair.iter().all(|collider| self.is_near.get(number(*collider)) == Some(&true)) {
            self.pairs.insert(pair);
        }
    }

    /// Returns whether the set contains a pair of colliders, in either order.
    fn has(&self, [one, two]: [ColliderHandle; 2]) -> bool {
        self.pairs.contains(&[one, two]) || self.pairs.contains(&[two, one])
    }
}

/// Returns the index of a collider in the physics engine.
fn number(collider: ColliderHandle) -> usize {
    collider.into_raw_parts().0 as usize
}

impl Impacts {
    /// `length` is the thickness of the thinnest moving body, m.
    pub(super) fn new(length: f64) -> Impacts {
        Impacts {
            found: Vec::new(),
            near: Vec::new(),
            events: Events::default(),
            slow: MIN_IMPACT_SPEED * length,
        }
    }

    /// Returns whether there are impacts that [`take`](Self::take) has not returned yet.
    #[cfg(feature = "checkpoints")]
    pub(super) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// Returns the impacts since the last call.
    pub(super) fn take(&mut self) -> Vec<Impact> {
        std::mem::take(&mut self.found)
    }

    /// Reads the collision events of the last step. Returns an empty set for the pairs with a first contact impulse.
    pub(super) fn begin(&mut self) -> Pushing {
        self.note_near();
        Pushing::among(&self.near)
    }

    /// Updates the list of near pairs from the physics engine's collision events of the last step.
    fn note_near(&mut self) {
        let events = std::mem::take(&mut *self.events.0.lock().unwrap_or_else(PoisonError::into_inner));
        for event in events {
            match event {
                CollisionEvent::Started(one, two, _) => self.near.push([one, two]),
                CollisionEvent::Stopped(one, two, _) => {
                    self.near.retain(|pair| *pair != [one, two] && *pair != [two, one]);
                }
            }
        }
    }

    /// Completes the impacts whose rebounds came in this step.
    pub(super) fn complete(&mut self, rebounds: &Rebounds, motion: &StepMotion<'_>) {
        let mut impacts: Vec<([ColliderHandle; 2], Impact)> = Vec::new();
        for rebound in &rebounds.due {
            impacts.extend(rebound.impact.map(|impact| (rebound.pair, impact)));
            if let Some((_, impact)) = impacts.iter_mut().find(|(pair, _)| *pair == rebound.pair) {
                let [(one, work), (two, other_work)] = rebound.work(motion.mean);
                impact.impulse += if one < two { rebound.impulse } else { -rebound.impulse };
                impact.energy = (impact.energy - work - other_work).max(0.0);
            }
        }
        self.found.extend(impacts.into_iter().map(|(_, impact)| impact));
    }

    /// Finds the impacts of the last step: first contact impulses of near pairs. Removes these pairs from the list of near pairs. Impacts at
    /// one of `onsets` are noted there, since they are complete after the next step only.
    pub(super) fn find(
        &mut self,
        engine: &PhysicsWorld,
        pushing: &Pushing,
        (time, motion): (f64, &StepMotion<'_>),
        onsets: &mut [Onset],
    ) {
        let mut near = std::mem::take(&mut self.near);
        near.retain(|pair| {
            if !pushing.has(*pair) {
                return true;
            }
            let Some(pair) = engine.narrow_phase.contact_pair(pair[0], pair[1]) else { return true };
            let (impact, is_pushing) = self.impact(pair, (time, motion));
            match onsets.iter_mut().find(|onset| onset.pair == [pair.collider1, pair.collider2]) {
                Some(onset) => onset.impact = impact,
                None => self.found.extend(impact),
            }
            !is_pushing
        });
        self.near = near;
    }

    /// Returns the impact of a pair if its bodies approached fast enough, and whether the pair had any normal impulse.
    fn impact(&self, pair: &ContactPair, (time, motion): (f64, &StepMotion<'_>)) -> (Option<Impact>, bool) {
        let (mut hardest, mut fastest) = (0.0, 0.0_f64);
        let (mut impulse, mut energy) = (DVec3::ZERO, 0.0);
        let mut found = None;
        for touch in Touch::of_pair(pair) {
            let [one, two] = touch.bodies;
            let [Some(&(v1, w1)), Some(&(v2, w2))] = [motion.before.get(one), motion.before.get(two)] else {
                continue;
            };
            let normal = touch.normal();
            for point in touch.points().filter(|point| point.impulse > 0.0) {
                let [a, b] = point.arms;
                fastest = fastest.max((v1 + w1.cross(a) - v2 - w2.cross(b)).dot(normal));
                impulse += point.impulse * normal;
                if point.impulse > hardest {
                    hardest = point.impulse;
                    found = Some((touch.bodies, normal, a));
                }
            }
            let Some(push) = touch.push() else { continue };
            impulse += push.friction;
            let work = touch.work(&push, motion.mean);
            energy += work.map_or(0.0, |[one, two]| one[0] + one[1] - two[0] - two[1]);
        }
        let Some((bodies, normal, arm)) = found else { return (None, false) };
        let sign = if bodies[0] < bodies[1] { 1.0 } else { -1.0 };
        let impact = Impact {
            time,
            bodies: [bodies[0].min(bodies[1]), bodies[0].max(bodies[1])],
            place: motion.places[bodies[0]] + arm,
            normal: sign * normal,
            impulse: sign * impulse,
            energy: energy.max(0.0),
        };
        (Some(impact).filter(|_| fastest > self.slow), true)
    }
}
