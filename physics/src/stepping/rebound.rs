//! Rebounds of bodies on joints.
//!
//! The physics engine gives bodies their rebounds after it has solved the joints, so joints would not take part in a rebound. A hammer would
//! rebound as if it had no handle. So the contacts of bodies on joints get no restitution in the engine: an impact only ends the approach.
//! In the next step, the contact gives the bodies a second impulse: the first one times the coefficient of restitution. The joints react to
//! it as to any other force. This is Poisson's hypothesis of restitution. It equals Newton's law if there is a single contact without
//! friction. Source: F. Pfeiffer and C. Glocker, *Multibody Dynamics with Unilateral Contacts*, chapter 8.

use std::collections::HashSet;

use glam::DVec3;
use rapier3d_f64::prelude::{ColliderHandle, ContactModificationContext, ContactPair};

use super::super::contact::Impact;
use super::super::motion::Twist;
use super::super::{Model, State};
use super::joint_response::{JointResponse, Need};
use super::mixing::Mixing;
use super::touch::{self, Touch};

/// The rebounds of bodies on joints.
pub(super) struct Rebounds {
    /// For each body, whether forces move it and a joint holds it.
    held: Vec<bool>,
    /// Bodies that approach more slowly than this are at rest, m/s.
    slow: f64,
    /// The number of the present step, from 1. The engine stores it in each contact in which an impact begins.
    step: u32,
    /// The rebounds of the present step.
    pub(super) due: Vec<Rebound>,
    /// The pairs of colliders of these rebounds.
    pairs: HashSet<[ColliderHandle; 2]>,
    joint_response: JointResponse,
    /// For each body, the impulse (N s) and its moment about the centre (N m s) that these rebounds give it.
    pushes: Vec<(DVec3, DVec3)>,
}

/// The second impulse of a contact, one step after an impact began there.
#[derive(Clone)]
#[cfg_attr(feature = "checkpoints", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Rebound {
    /// The pair of colliders.
    pub(super) pair: [ColliderHandle; 2],
    /// The indices of the two bodies.
    bodies: [usize; 2],
    /// The impulse on the second body, world axes, N s. The first body gets the opposite impulse.
    pub(super) impulse: DVec3,
    /// The moments of these impulses about the centres of the two bodies, world axes, N m s.
    moments: [DVec3; 2],
    /// The impact, as far as it is known after its first step.
    pub(super) impact: Option<Impact>,
}

impl Rebound {
    /// Returns the energy that each of the two bodies gets, J, with the body's index. `mean` is the mean twist of each body in the step.
    pub(super) fn work(&self, mean: &[Twist]) -> [(usize, f64); 2] {
        self.pushes().map(|(body, impulse, moment)| {
            let (velocity, turning) = mean[body];
            (body, impulse.dot(velocity) + moment.dot(turning))
        })
    }

    /// The index of each body, the impulse on it, N s, and the moment of this impulse about its centre, N m s.
    fn pushes(&self) -> [(usize, DVec3, DVec3); 2] {
        let [one, two] = self.bodies;
        [(one, -self.impulse, self.moments[0]), (two, self.impulse, self.moments[1])]
    }
}

impl Rebounds {
    /// `held` holds for each body whether a joint holds it. Bodies that approach more slowly than `slow`, m/s, are at rest.
    pub(super) fn new(model: &Model, held: &[bool], slow: f64) -> Rebounds {
        let is_held = |(held, inverse_mass): (&bool, &f64)| *held && *inverse_mass != 0.0;
        Rebounds {
            held: held.iter().zip(model.inverse_mass()).map(is_held).collect(),
            slow,
            step: 0,
            due: Vec::new(),
            pairs: HashSet::new(),
            joint_response: JointResponse::default(),
            pushes: vec![(DVec3::ZERO, DVec3::ZERO); held.len()],
        }
    }

    /// Must be called when bodies appear or disappear.
    pub(super) fn forget_bodies(&mut self) {
        self.joint_response.forget_bodies();
    }

    /// Sets the rebounds of the next step.
    pub(super) fn set_due(&mut self, due: Vec<Rebound>) {
        self.pairs = due.iter().map(|rebound| rebound.pair).collect();
        self.due = due;
    }

    /// Prepares a step. `steps` is the number of earlier steps.
    pub(super) fn begin(&mut self, steps: u64) {
        self.step = (steps % u64::from(u32::MAX)) as u32 + 1;
        self.pushes.fill((DVec3::ZERO, DVec3::ZERO));
        for rebound in &self.due {
            for (body, impulse, moment) in rebound.pushes() {
                self.pushes[body].0 += impulse;
                self.pushes[body].1 += moment;
            }
        }
    }

    /// Returns the impulse (N s) and its moment about the centre (N m s) that the rebounds of this step give a body.
    pub(super) fn push(&self, body: usize) -> (DVec3, DVec3) {
        self.pushes[body]
    }

    /// Whether a body has a rebound in this step.
    pub(super) fn is_due(&self, body: usize) -> bool {
        self.pushes[body] != (DVec3::ZERO, DVec3::ZERO)
    }

    /// Whether a joint holds one of two bodies that meet, so that their rebound comes in the next step.
    pub(super) fn is_delayed(&self, bodies: [usize; 2]) -> bool {
        bodies.into_iter().any(|body| self.held[body])
    }

    /// The mark of a contact in which an impact begins in this step.
    pub(super) fn mark(&self) -> u32 {
        self.step
    }

    /// Removes a contact from the engine for the step of its rebound. The engine would begin the step with the contact's impulse of the last
    /// step, and its sweeps would not remove all of it.
    pub(super) fn suspend(&self, context: &mut ContactModificationContext<'_>) {
        let is_due = self.pairs.contains(&[context.collider1, context.collider2]);
        if let Some(contact) = context.rigid_mut().filter(|_| is_due)
            && contact.user_data.wrapping_add(1) == self.step
        {
            contact.solver_contacts.clear();
        }
    }

    /// Returns the impact that began at a contact in this step, if its bodies approached fast. `before` is the twist of each body before
    /// the step.
    pub(super) fn onset(
        &self,
        (pair, touch): (&ContactPair, &Touch<'_>),
        before: &[Twist],
        mixing: &Mixing,
    ) -> Option<Onset> {
        if touch.mark() != self.step {
            return None;
        }
        let (bodies, normal) = (touch.bodies, touch.normal());
        let [one, two] = bodies.map(|body| before[body]);
        let point = |point: touch::Point| {
            let [a, b] = point.arms;
            let approach = (one.0 + one.1.cross(a) - two.0 - two.1.cross(b)).dot(normal);
            OnsetPoint { arms: point.arms, impulse: point.impulse, approach }
        };
        let points: Vec<OnsetPoint> = touch.points().map(point).collect();
        let is_fast = points.iter().any(|point| point.impulse > 0.0 && point.approach > self.slow);
        is_fast.then(|| Onset {
            pair: [pair.collider1, pair.collider2],
            bodies,
            normal,
            restitution: mixing.restitution(bodies),
            points,
            impact: None,
        })
    }

    /// Prepares the rebounds of the next step. `onsets` are the impacts that began in this step. `time` and `state` belong to its end.
    pub(super) fn prepare(&mut self, onsets: Vec<Onset>, (model, time, state): (&Model, f64, &State)) {
        let due = if onsets.is_empty() {
            Vec::new()
        } else {
            let needs = self.joint_response.needs(&onsets, (model, time, state));
            onsets.into_iter().zip(&needs).map(|(onset, need)| onset.rebound(need)).collect()
        };
        self.set_due(due);
    }
}

/// A contact at which an impact has begun.
pub(super) struct Onset {
    pub(super) pair: [ColliderHandle; 2],
    pub(super) bodies: [usize; 2],
    /// The unit contact normal, from the first body to the second, world axes.
    pub(super) normal: DVec3,
    restitution: f64,
    pub(super) points: Vec<OnsetPoint>,
    /// The impact, if it is to be reported, as far as it is known after this step.
    pub(super) impact: Option<Impact>,
}

/// A point of a contact at which an impact has begun.
pub(super) struct OnsetPoint {
    /// The vectors from the centres of the two bodies to the point, m. For a fixed body, the vector begins at the origin.
    pub(super) arms: [DVec3; 2],
    /// The impulse of this point in this step, N s.
    pub(super) impulse: f64,
    /// The velocity of approach before the step, m/s.
    pub(super) approach: f64,
}

impl Onset {
    /// Returns the rebound.
    fn rebound(&self, need: &Need) -> Rebound {
        let restitution = self.restitution;
        let impulse = |point: &OnsetPoint, once: f64| {
            if need.is_met { restitution * point.impulse } else { (1.0 + restitution) * once - point.impulse }
        };
        let mut rebound = Rebound {
            pair: self.pair,
            bodies: self.bodies,
            impulse: DVec3::ZERO,
            moments: [DVec3::ZERO; 2],
            impact: self.impact,
        };
        for (point, once) in self.points.iter().zip(&need.impulses) {
            let impulse = impulse(point, *once) * self.normal;
            rebound.impulse += impulse;
            rebound.moments[0] -= point.arms[0].cross(impulse);
            rebound.moments[1] += point.arms[1].cross(impulse);
        }
        rebound
    }
}
