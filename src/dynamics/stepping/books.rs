//! Accounts of contacts and joints: energies for the balance, and impacts.

use std::sync::{Mutex, PoisonError};

use glam::DVec3;
use rapier3d_f64::prelude::{
    ColliderHandle, ColliderSet, CollisionEvent, ContactManifold, ContactPair, EventHandler, PairContacts,
    PhysicsWorld, Pose, RigidBodyHandle, RigidBodySet, SoftBodySet, SoftBodyTearEvent, SolverContact,
};

use super::super::contact::Impact;
use super::super::{Accounts, Loads, Model, State};
use super::driven::Driven;
use super::joint::{Joints, MotorPush};

/// Bodies that approach by less than this many of their thicknesses in a second have no impact.
const SLOW: f64 = 0.03;

/// The engine solves for no more points of a touch than these.
const MOST_POINTS: usize = 4;

/// The motion of a body: its velocity, m/s, and its angular velocity, rad/s.
pub(super) type Motion = (DVec3, DVec3);

/// The books of contacts.
pub(super) struct Books {
    /// The motion of each body: before the step, and its mean within the step.
    pub(super) before: Vec<Motion>,
    pub(super) mean: Vec<Motion>,
    /// The place of each body before the step, m.
    pub(super) places: Vec<DVec3>,
    /// The bodies that touched something, or came near it, in the step that was made last.
    touched: Vec<bool>,
    /// The bodies that joints hold.
    held: Vec<bool>,
    /// The change of angular momentum of each constrained body by contacts and joints in the last step, N m s.
    pub(super) turned: Vec<DVec3>,
    /// The impulses of motors in the last step.
    pub(super) motors: Vec<MotorPush>,
    impacts: Vec<Impact>,
    /// Colliders that have come near each other, and have not pushed yet.
    pub(super) near: Vec<[ColliderHandle; 2]>,
    pub(super) events: Events,
    slow: f64,
}

/// The engine's events: pairs that come near each other or part.
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

/// The contact of two bodies, on a common normal.
#[derive(Clone, Copy)]
pub(super) struct Touch<'a> {
    /// The numbers of the bodies.
    pub(super) bodies: [usize; 2],
    manifold: &'a ContactManifold,
}

/// A point of a touch: the impulse along the normal, and the ways to it from the centres of the bodies.
pub(super) struct Point {
    pub(super) impulse: f64,
    pub(super) arms: [DVec3; 2],
}

/// The effect of a contact on the second body within a step; the first gets the opposite.
#[derive(Default)]
pub(super) struct Push {
    /// The impulse along the normal, N s.
    pub(super) impulse: f64,
    /// Its moments about the centres of the bodies, N m s.
    moments: [DVec3; 2],
    /// The impulse of friction, N s.
    pub(super) friction: DVec3,
    /// The moment of friction about the normal, N m s.
    twist: f64,
    /// The ways from the centres of the bodies to where friction acts, m.
    arms: [DVec3; 2],
}

impl<'a> Touch<'a> {
    /// All of a pair.
    pub(super) fn of_pair(pair: &'a ContactPair) -> impl Iterator<Item = Touch<'a>> {
        let manifolds = match &pair.contacts {
            PairContacts::Rigid(contacts) => contacts.solver_manifolds(),
            PairContacts::Soft { .. } => &[],
        };
        manifolds.iter().filter(|manifold| !manifold.data.solver_contacts.is_empty()).filter_map(|manifold| {
            let number = |handle: Option<RigidBodyHandle>| Some(handle?.into_raw_parts().0 as usize);
            let bodies = [number(manifold.data.rigid_body1)?, number(manifold.data.rigid_body2)?];
            Some(Touch { bodies, manifold })
        })
    }

    /// The unit normal from the first body to the second.
    pub(super) fn normal(&self) -> DVec3 {
        self.manifold.data.normal
    }

    /// Its points.
    pub(super) fn points(&self) -> impl Iterator<Item = Point> + use<'a> {
        let manifold = self.manifold;
        manifold.data.solver_contacts.iter().take(MOST_POINTS).filter_map(move |contact| {
            let [index] = contact.contact_indices();
            let data = &manifold.points.get(index as usize)?.data;
            Some(Point { impulse: data.impulse, arms: [data.solver_dp1, data.solver_dp2] })
        })
    }

    /// The penetration of the bodies, m; negative if they are apart. The closure gives the pose of a body, or `None` if the body
    /// is fixed.
    pub(super) fn depth(&self, pose: impl Fn(usize) -> Option<Pose>) -> f64 {
        let poses = self.bodies.map(pose);
        let place = |side: usize, anchor: DVec3| poses[side].map_or(anchor, |pose| pose * anchor);
        let depth = |contact: &SolverContact| {
            (place(0, contact.anchor1) - place(1, contact.anchor2)).dot(self.normal())
        };
        let contacts = self.manifold.data.solver_contacts.iter().take(MOST_POINTS);
        contacts.map(depth).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The impulse in the last step. `None` if there was none.
    pub(super) fn push(&self) -> Option<Push> {
        let manifold = self.manifold;
        let contacts = manifold.data.solver_contacts.iter().take(MOST_POINTS);
        let mut points = contacts.filter_map(|contact| {
            let [index] = contact.contact_indices();
            manifold.points.get(index as usize).map(|point| &point.data)
        });
        let first = points.next()?;
        // Values of the whole manifold are stored with each of its points.
        let mut push = Push { friction: -first.warmstart_tangent_world, ..Push::default() };
        let mut count = 0.0;
        for point in std::iter::once(first).chain(points) {
            let arms = [point.solver_dp1, point.solver_dp2];
            count += 1.0;
            push.impulse += point.impulse;
            for (side, arm) in arms.into_iter().enumerate() {
                push.arms[side] += arm;
                push.moments[side] += point.impulse * arm.cross(self.normal());
            }
        }
        if push.impulse == 0.0 {
            return None;
        }
        push.arms = push.arms.map(|arm| arm / count);
        // A single point has no arm to twist with.
        push.twist = if count > 1.0 { first.warmstart_twist_impulse } else { 0.0 };
        Some(push)
    }
}

impl Books {
    pub(super) fn new(bodies: usize, length: f64, held: Vec<bool>) -> Books {
        let still = vec![(DVec3::ZERO, DVec3::ZERO); bodies];
        Books {
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

    /// Whether there are impacts that nobody has taken.
    pub(super) fn has_impacts(&self) -> bool {
        !self.impacts.is_empty()
    }

    pub(super) fn take_impacts(&mut self) -> Vec<Impact> {
        std::mem::take(&mut self.impacts)
    }

    /// Books what contacts and joints have done in the step that was made last, and the impacts in it. `time` is that of its end, s.
    ///
    /// An impulse changes the kinetic energy of a body by its product with the mean of the velocities before and after it, whatever
    /// else acts at the same time. What is left over between two bodies is lost; what a guided body puts in is work.
    ///
    /// The engine also moves bodies out of each other, or lets them sink in, without a velocity that would stay. Forces with a potential do work
    /// on that way, which contacts take or give as well.
    pub(super) fn close(
        &mut self,
        engine: &PhysicsWorld,
        (model, joints): (&Model, &Joints),
        (state, loads, driven): (&mut State, &Loads, &Driven),
        time: f64,
    ) {
        self.touched.fill(false);
        let mut accounts = Accounts::default();
        // The energy that contacts give to bodies held by joints, J.
        let mut pressed = 0.0;
        for touch in engine.narrow_phase.contact_pairs().flat_map(Touch::of_pair) {
            touch.bodies.into_iter().for_each(|body| self.touched[body] = true);
            let Some([one, two]) = self.rates(&touch) else { continue };
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
        }
        let dt = engine.integration_parameters.dt;
        accounts.add(1.0, driven.work(dt, &self.mean));
        let mut pulled = 0.0;
        for i in (0..self.touched.len()).filter(|&i| self.touched[i] || self.held[i]) {
            let shift = state.location[i] - self.places[i] - dt * state.velocity[i];
            let account = if self.touched[i] { &mut accounts.impacts } else { &mut pulled };
            *account -= (loads.force[i] - driven.on(i)).dot(shift);
            if self.held[i] && model.inverse_mass()[i] != 0.0 {
                // All that is no force on it comes from contacts and joints.
                let change = model.mass()[i] * (state.velocity[i] - self.before[i].0) - dt * loads.force[i];
                pulled += change.dot(self.mean[i].0) + self.turned[i].dot(self.mean[i].1);
            }
        }
        let motors: f64 = self.motors.iter().map(|push| push.work(|body| self.mean[body])).sum();
        accounts.motors += motors;
        // The remainder is that of joints: they yield and hit limits, and guides at their ends do work through them.
        let others = pulled - pressed - motors;
        if joints.has_guide {
            accounts.work += others;
        } else {
            accounts.limits += others;
        }
        state.accounts.add(1.0, accounts);
        self.find_impacts(engine, time);
    }

    /// The energy that a touch takes from its first body and gives to its second, each by the normal impulses and by friction, J; none
    /// where it does not push.
    fn rates(&self, touch: &Touch<'_>) -> Option<[[f64; 2]; 2]> {
        let push = touch.push()?;
        let normal = touch.normal();
        let rate = |side: usize| {
            let (velocity, turning) = *self.mean.get(touch.bodies[side])?;
            let along = push.impulse * normal.dot(velocity) + push.moments[side].dot(turning);
            let at = velocity + turning.cross(push.arms[side]);
            Some([along, push.friction.dot(at) + push.twist * normal.dot(turning)])
        };
        Some([rate(0)?, rate(1)?])
    }

    /// Finds the impacts of pairs that have come near each other.
    fn find_impacts(&mut self, engine: &PhysicsWorld, time: f64) {
        let events = std::mem::take(&mut *self.events.0.lock().unwrap_or_else(PoisonError::into_inner));
        for event in events {
            match event {
                CollisionEvent::Started(one, two, _) => self.near.push([one, two]),
                CollisionEvent::Stopped(one, two, _) => {
                    self.near.retain(|pair| *pair != [one, two] && *pair != [two, one]);
                }
            }
        }
        let mut near = std::mem::take(&mut self.near);
        near.retain(|&[one, two]| {
            let Some(pair) = engine.narrow_phase.contact_pair(one, two) else { return true };
            !self.note_impact(pair, time)
        });
        self.near = near;
    }

    /// Notes the impact of a pair, if it has pushed at last; whether it has.
    fn note_impact(&mut self, pair: &ContactPair, time: f64) -> bool {
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
            impulse += touch.push().map_or(DVec3::ZERO, |push| push.friction);
            energy += self.rates(&touch).map_or(0.0, |[one, two]| one[0] + one[1] - two[0] - two[1]);
        }
        let Some((bodies, normal, arm)) = found else { return false };
        if fastest > self.slow {
            let sign = if bodies[0] < bodies[1] { 1.0 } else { -1.0 };
            self.impacts.push(Impact {
                time,
                bodies: [bodies[0].min(bodies[1]), bodies[0].max(bodies[1])],
                place: self.places[bodies[0]] + arm,
                normal: sign * normal,
                impulse: sign * impulse,
                energy: energy.max(0.0),
            });
        }
        true
    }
}
