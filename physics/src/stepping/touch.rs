//! Reads the physics engine's data on contacts between two bodies.

use glam::DVec3;
use rapier3d_f64::prelude::{
    ContactData, ContactManifold, ContactPair, PairContacts, Pose, RigidBodyHandle, SolverContact,
};

use super::super::motion::Twist;

/// The largest number of points of one contact for which the physics engine computes impulses.
const MAX_CONTACT_POINTS: usize = 4;

/// A contact of two bodies: one or more points with a common normal.
#[derive(Clone, Copy)]
pub(super) struct Touch<'a> {
    /// The indices of the two bodies in contact.
    pub(super) bodies: [usize; 2],
    manifold: &'a ContactManifold,
}

/// A point of a contact: the impulse along the normal (N s), and the vectors from the centres of the two bodies to the point (m).
pub(super) struct Point {
    pub(super) impulse: f64,
    pub(super) arms: [DVec3; 2],
}

/// The impulses of a contact on the second body within a step. The first body gets the opposite impulses.
#[derive(Default)]
pub(super) struct Push {
    /// The normal impulse, summed over all points, N s.
    pub(super) impulse: f64,
    /// The moments of the normal impulses about the centres of the two bodies, N m s.
    pub(super) moments: [DVec3; 2],
    /// The friction impulse, summed over all points, N s.
    pub(super) friction: DVec3,
    /// The moment of friction about the normal, N m s.
    pub(super) twist: f64,
    /// The vectors from the centres of the two bodies to the point where friction acts, m.
    pub(super) arms: [DVec3; 2],
}

impl<'a> Touch<'a> {
    /// Returns all contacts between two colliders.
    pub(super) fn of_pair(pair: &'a ContactPair) -> impl Iterator<Item = Touch<'a>> {
        manifolds(pair).iter().filter_map(Touch::new)
    }

    /// Makes a contact from the physics engine's contact manifold; `None` if the manifold has no points to solve.
    fn new(manifold: &'a ContactManifold) -> Option<Touch<'a>> {
        if manifold.data.solver_contacts.is_empty() {
            return None;
        }
        let number = |handle: Option<RigidBodyHandle>| Some(handle?.into_raw_parts().0 as usize);
        let bodies = [number(manifold.data.rigid_body1)?, number(manifold.data.rigid_body2)?];
        Some(Touch { bodies, manifold })
    }

    /// The unit normal of the contact, from the first body to the second, world axes.
    pub(super) fn normal(&self) -> DVec3 {
        self.manifold.data.normal
    }

    /// The number that a callback has stored in the contact.
    pub(super) fn mark(&self) -> u32 {
        self.manifold.data.user_data
    }

    /// Returns the points of the contact.
    pub(super) fn points(&self) -> impl Iterator<Item = Point> + use<'a> {
        self.data().map(|data| Point { impulse: data.impulse, arms: [data.solver_dp1, data.solver_dp2] })
    }

    /// Returns the physics engine's data on each point of the contact.
    fn data(&self) -> impl Iterator<Item = &'a ContactData> + use<'a> {
        let points = &self.manifold.points;
        let contacts = self.manifold.data.solver_contacts.iter().take(MAX_CONTACT_POINTS);
        contacts.filter_map(move |contact| {
            // The solver's contact stores the index of its point. To read that index takes time, so a contact with a single point does
            // without.
            let index = if points.len() == 1 { 0 } else { contact.contact_indices()[0] as usize };
            points.get(index).map(|point| &point.data)
        })
    }

    /// Returns the largest penetration at the points of the contact, m; negative if the bodies are apart. The closure returns the pose of
    /// a body, or `None` for a fixed body.
    pub(super) fn depth(&self, pose: impl Fn(usize) -> Option<Pose>) -> f64 {
        let poses = self.bodies.map(pose);
        let place = |side: usize, anchor: DVec3| poses[side].map_or(anchor, |pose| pose * anchor);
        let depth = |contact: &SolverContact| {
            (place(0, contact.anchor1) - place(1, contact.anchor2)).dot(self.normal())
        };
        let contacts = self.manifold.data.solver_contacts.iter().take(MAX_CONTACT_POINTS);
        contacts.map(depth).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns the energy that a contact takes from its first body and the energy that it gives to its second body, J. Each pair holds the
    /// part of the normal impulses and the part of friction. `mean` is the mean twist of each body in the step.
    pub(super) fn work(&self, push: &Push, mean: &[Twist]) -> Option<[[f64; 2]; 2]> {
        let normal = self.normal();
        let work = |side: usize| {
            let (velocity, turning) = *mean.get(self.bodies[side])?;
            let along = push.impulse * normal.dot(velocity) + push.moments[side].dot(turning);
            let at = velocity + turning.cross(push.arms[side]);
            Some([along, push.friction.dot(at) + push.twist * normal.dot(turning)])
        };
        Some([work(0)?, work(1)?])
    }

    /// Returns the impulses of the contact in the last step; `None` if the normal impulse was zero.
    pub(super) fn push(&self) -> Option<Push> {
        Some(self.push_or_nothing()).filter(|push| push.impulse != 0.0)
    }

    /// Returns the impulses of the contact in the last step, which may be zero.
    fn push_or_nothing(&self) -> Push {
        let mut points = self.data();
        let Some(first) = points.next() else { return Push::default() };
        // The physics engine stores the friction and the twist of the whole manifold with each of its points.
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
        push.arms = push.arms.map(|arm| arm / count);
        // The physics engine computes no twist for a single point, because friction there has no lever arm about the normal.
        push.twist = if count > 1.0 { first.warmstart_twist_impulse } else { 0.0 };
        push
    }
}

fn manifolds(pair: &ContactPair) -> &[ContactManifold] {
    match &pair.contacts {
        PairContacts::Rigid(contacts) => contacts.solver_manifolds(),
        PairContacts::Soft { .. } => &[],
    }
}

/// Calls `meet` with each contact, with or without an impulse. Calls `look` with each contact that has an impulse, and with its pair of
/// colliders. Contacts come in the order of `pairs`.
///
/// The physics engine's contacts are scattered over the memory. Each of the short loops follows one more pointer for many contacts at
/// once, so that the processor loads many contacts in parallel instead of one after another.
pub(super) fn visit<'a>(
    pairs: impl Iterator<Item = &'a ContactPair>,
    mut meet: impl FnMut(&Touch<'a>),
    mut look: impl FnMut(&'a ContactPair, &Touch<'a>, &Push),
) {
    /// The number of contacts in a block.
    const BLOCK_SIZE: usize = 64;
    let all: Vec<(&ContactPair, &ContactManifold)> =
        pairs.flat_map(|pair| manifolds(pair).iter().map(move |manifold| (pair, manifold))).collect();
    let mut found = Vec::with_capacity(BLOCK_SIZE);
    for block in all.chunks(BLOCK_SIZE) {
        let mut touching = [false; BLOCK_SIZE];
        for (touching, (_, manifold)) in touching.iter_mut().zip(block) {
            *touching = !manifold.data.solver_contacts.is_empty();
        }
        found.clear();
        for ((pair, manifold), _) in block.iter().zip(touching).filter(|(_, touching)| *touching) {
            found.extend(Touch::new(manifold).map(|touch| (*pair, touch)));
        }
        let mut pushing = [false; BLOCK_SIZE];
        for (pushing, (_, touch)) in pushing.iter_mut().zip(&found) {
            *pushing = touch.manifold.points.iter().any(|point| point.data.impulse != 0.0);
        }
        for ((pair, touch), pushing) in found.iter().zip(pushing) {
            meet(touch);
            if pushing && let Some(push) = touch.push() {
                look(pair, touch, &push);
            }
        }
    }
}
