//! Books the energy that contacts and joints take or give in each step, and finds the impacts.

use std::collections::{HashMap, HashSet};
use std::sync::{Mutex, PoisonError};

use glam::DVec3;
use rapier3d_f64::prelude::{
    ColliderHandle, ColliderSet, CollisionEvent, ContactPair, EventHandler, PhysicsWorld, RigidBodySet,
    SoftBodySet, SoftBodyTearEvent,
};

use super::super::contact::Impact;
use super::super::motion::Twist;
use super::super::{Accounts, Loads, Model, State};
use super::joint::{Joints, MotorPush};
use super::mixing::Mixing;
use super::non_potential_work::NonPotentialWork;
use super::rebound::{Onset, Rebounds};
use super::touch::{self, Push, Touch};

/// A new contact counts as an impact only if the bodies approach faster than this many thicknesses of the thinnest moving body per second.
const SLOW: f64 = 0.03;

/// The bookkeeping of contacts and joints: data of the last step from which their work and the impacts follow.
pub(super) struct Bookkeeping {
    /// The twist of each body before the last step, and its mean during that step.
    pub(super) before: Vec<Twist>,
    pub(super) mean: Vec<Twist>,
    /// The position of each body's centre of mass before the last step, m.
    pub(super) places: Vec<DVec3>,
    /// For each body, whether it touched another body, or came near one, in the last step.
    touched: Vec<bool>,
    /// For each body, whether a joint holds it.
    held: Vec<bool>,
    /// The change of each body's angular momentum by contacts and joints in the last step, world axes, N m s. Zero for bodies that forces
    /// do not move.
    pub(super) turned: Vec<DVec3>,
    /// The impulses of the joints' motors in the last step.
    pub(super) motors: Vec<MotorPush>,
    impacts: Vec<Impact>,
    /// Pairs of colliders that are near each other, and between which no contact force has acted yet.
    pub(super) near: Vec<[ColliderHandle; 2]>,
    pub(super) events: Events,
    slow: f64,
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
struct Pushing {
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
    fn see(&mut self, pair: &ContactPair) {
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

impl Bookkeeping {
    pub(super) fn new(bodies: usize, length: f64, held: Vec<bool>) -> Bookkeeping {
        let still = vec![(DVec3::ZERO, DVec3::ZERO); bodies];
        Bookkeeping {
            held,
            turned: vec![DVec3::ZERO; bodies],
            motors: Vec::new(),
            before: still.clone(),
            places: vec![DVec3::ZERO; bodies],
            touched: vec![false; bodies],
            mean: still,
            impacts: Vec::new(),
            near: Vec::new(),
            events: Events::default(),
            slow: SLOW * length,
        }
    }

    /// Returns whether there are impacts that [`take_impacts`](Self::take_impacts) has not returned yet.
    pub(super) fn has_impacts(&self) -> bool {
        !self.impacts.is_empty()
    }

    pub(super) fn take_impacts(&mut self) -> Vec<Impact> {
        std::mem::take(&mut self.impacts)
    }

    /// Adds the work of contacts and joints in the last step to the accounts, and finds the impacts of the step. `time` is the end of the
    /// step, s. Also prepares the rebounds of the next step.
    ///
    /// An impulse changes the kinetic energy of a body by its product with the mean of the velocities before and after it, also if other
    /// impulses act at the same time. The sum over both bodies of a contact is the energy loss. The contribution of a guided body is work.
    ///
    /// The physics engine also shifts overlapping bodies apart, or lets them sink in, without a lasting velocity. Forces with a potential
    /// do work during that displacement. Contacts absorb or release the same energy.
    pub(super) fn close(
        &mut self,
        engine: &PhysicsWorld,
        (model, joints): (&Model, &Joints),
        (state, loads, driven): (&mut State, &Loads, &NonPotentialWork),
        (rebounds, mixing): (&mut Rebounds, &Mixing),
        time: f64,
    ) {
        self.note_near();
        let mut pushing = Pushing::among(&self.near);
        let mut touched = std::mem::take(&mut self.touched);
        touched.fill(false);
        let mut accounts = Accounts::default();
        // The energy that contacts give to the bodies held by joints in this step, J.
        let mut pressed = 0.0;
        let mut onsets = Vec::new();
        let mut received = self.receive(rebounds, model, &mut accounts, &mut pressed);
        let meet = |touch: &Touch<'_>| touch.bodies.into_iter().for_each(|body| touched[body] = true);
        touch::visit(engine.narrow_phase.contact_pairs(), meet, |pair, touch, push| {
            pushing.see(pair);
            onsets.extend(rebounds.onset((pair, touch), &self.before, mixing));
            let Some([one, two]) = self.rates(touch, push) else { return };
            accounts.impacts += two[0] - one[0];
            accounts.friction += two[1] - one[1];
            for (body, work) in touch.bodies.into_iter().zip([one[0] + one[1], -(two[0] + two[1])]) {
                if model.is_guided(body) {
                    accounts.work += work;
                }
                if self.held[body] && model.inverse_mass()[body] != 0.0 {
                    pressed -= work;
                }
            }
        });
        self.touched = touched;
        let dt = engine.integration_parameters.dt;
        accounts.add(1.0, driven.work(dt, &self.mean));
        let mut pulled = 0.0;
        for i in (0..self.touched.len()).filter(|&i| self.touched[i] || self.held[i]) {
            let shift = state.location[i] - self.places[i] - dt * state.velocity[i];
            let account = if self.touched[i] { &mut accounts.impacts } else { &mut pulled };
            *account -= (loads.force[i] - driven.on(i)).dot(shift);
            if self.held[i] && model.inverse_mass()[i] != 0.0 {
                // Contacts and joints cause the part of the velocity change that does not follow from the body's force.
                let change = model.mass()[i] * (state.velocity[i] - self.before[i].0) - dt * loads.force[i];
                pulled += change.dot(self.mean[i].0) + self.turned[i].dot(self.mean[i].1);
            }
        }
        let motors: f64 = self.motors.iter().map(|push| push.work(|body| self.mean[body])).sum();
        accounts.motors += motors;
        // The remaining energy comes from joints: they yield and hit limits, and guided bodies do work through them.
        let others = pulled - pressed - motors;
        if joints.has_guide {
            accounts.work += others;
        } else {
            accounts.limits += others;
        }
        state.accounts.add(1.0, accounts);
        self.impacts.append(&mut received);
        let unfinished = self.find_impacts(engine, &pushing, time, &onsets);
        rebounds.prepare(&onsets, unfinished, (model, time, state));
    }

    /// Books the work of the rebounds of the last step. Returns the impacts that are complete with them. Adds the energy that they give to the
    /// bodies held by joints to `pressed`, J.
    fn receive(
        &self,
        rebounds: &Rebounds,
        model: &Model,
        accounts: &mut Accounts,
        pressed: &mut f64,
    ) -> Vec<Impact> {
        let mut impacts: Vec<([ColliderHandle; 2], Impact)> = Vec::new();
        for rebound in &rebounds.due {
            let works = rebound.work(&self.mean);
            for (body, work) in works {
                accounts.impacts += work;
                if model.is_guided(body) {
                    accounts.work -= work;
                }
                if self.held[body] && model.inverse_mass()[body] != 0.0 {
                    *pressed += work;
                }
            }
            impacts.extend(rebound.impact.map(|impact| (rebound.pair, impact)));
            if let Some((_, impact)) = impacts.iter_mut().find(|(pair, _)| *pair == rebound.pair) {
                let [(one, work), (two, other_work)] = works;
                impact.impulse += if one < two { rebound.impulse } else { -rebound.impulse };
                impact.energy = (impact.energy - work - other_work).max(0.0);
            }
        }
        impacts.into_iter().map(|(_, impact)| impact).collect()
    }

    /// Returns the energy that a contact takes from its first body and the energy that it gives to its second body, J. Each pair holds the
    /// part of the normal impulses and the part of friction.
    fn rates(&self, touch: &Touch<'_>, push: &Push) -> Option<[[f64; 2]; 2]> {
        let normal = touch.normal();
        let rate = |side: usize| {
            let (velocity, turning) = *self.mean.get(touch.bodies[side])?;
            let along = push.impulse * normal.dot(velocity) + push.moments[side].dot(turning);
            let at = velocity + turning.cross(push.arms[side]);
            Some([along, push.friction.dot(at) + push.twist * normal.dot(turning)])
        };
        Some([rate(0)?, rate(1)?])
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

    /// Finds the impacts of the last step: first contact impulses of near pairs. Removes these pairs from the list of near pairs. Returns
    /// the impacts at `onsets`, which are complete after the next step only.
    fn find_impacts(
        &mut self,
        engine: &PhysicsWorld,
        pushing: &Pushing,
        time: f64,
        onsets: &[Onset],
    ) -> HashMap<[ColliderHandle; 2], Impact> {
        let mut unfinished = HashMap::new();
        let mut near = std::mem::take(&mut self.near);
        near.retain(|pair| {
            if !pushing.has(*pair) {
                return true;
            }
            let Some(pair) = engine.narrow_phase.contact_pair(pair[0], pair[1]) else { return true };
            let colliders = [pair.collider1, pair.collider2];
            let (impact, is_pushing) = self.impact(pair, time);
            if onsets.iter().any(|onset| onset.pair == colliders) {
                unfinished.extend(impact.map(|impact| (colliders, impact)));
            } else {
                self.impacts.extend(impact);
            }
            !is_pushing
        });
        self.near = near;
        unfinished
    }

    /// Returns the impact of a pair if its bodies approached fast enough, and whether the pair had any normal impulse.
    fn impact(&self, pair: &ContactPair, time: f64) -> (Option<Impact>, bool) {
        let (mut hardest, mut fastest) = (0.0, 0.0_f64);
        let (mut impulse, mut energy) = (DVec3::ZERO, 0.0);
        let mut found = None;
        for touch in Touch::of_pair(pair) {
            let [one, two] = touch.bodies;
            let [Some(&(v1, w1)), Some(&(v2, w2))] = [self.before.get(one), self.before.get(two)] else {
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
            energy += self.rates(&touch, &push).map_or(0.0, |[one, two]| one[0] + one[1] - two[0] - two[1]);
        }
        let Some((bodies, normal, arm)) = found else { return (None, false) };
        let sign = if bodies[0] < bodies[1] { 1.0 } else { -1.0 };
        let impact = Impact {
            time,
            bodies: [bodies[0].min(bodies[1]), bodies[0].max(bodies[1])],
            place: self.places[bodies[0]] + arm,
            normal: sign * normal,
            impulse: sign * impulse,
            energy: energy.max(0.0),
        };
        (Some(impact).filter(|_| fastest > self.slow), true)
    }
}
