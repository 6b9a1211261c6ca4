//! The engine's data on two bodies that touch.

use glam::DVec3;
use rapier3d_f64::prelude::{
    ContactData, ContactManifold, ContactPair, PairContacts, Pose, RigidBodyHandle, SolverContact,
};

/// The largest number of points of a touch for which the engine solves.
const MOST_POINTS: usize = 4;

/// The contact of two bodies, on a common normal.
#[derive(Clone, Copy)]
pub(super) struct Touch<'a> {
    /// The indices of the bodies.
    pub(super) bodies: [usize; 2],
    manifold: &'a ContactManifold,
}

/// A point of a touch: the impulse along the normal, and the vectors to it from the centres of the bodies.
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
    pub(super) moments: [DVec3; 2],
    /// The impulse of friction, N s.
    pub(super) friction: DVec3,
    /// The moment of friction about the normal, N m s.
    pub(super) twist: f64,
    /// The vectors from the centres of the bodies to the point where friction acts, m.
    pub(super) arms: [DVec3; 2],
}

impl<'a> Touch<'a> {
    /// All touches of a pair.
    pub(super) fn of_pair(pair: &'a ContactPair) -> impl Iterator<Item = Touch<'a>> {
        manifolds(pair).iter().filter_map(Touch::new)
    }

    /// The touch of a manifold. `None` if it is empty.
    fn new(manifold: &'a ContactManifold) -> Option<Touch<'a>> {
        if manifold.data.solver_contacts.is_empty() {
            return None;
        }
        let number = |handle: Option<RigidBodyHandle>| Some(handle?.into_raw_parts().0 as usize);
        let bodies = [number(manifold.data.rigid_body1)?, number(manifold.data.rigid_body2)?];
        Some(Touch { bodies, manifold })
    }

    /// The unit normal from the first body to the second.
    pub(super) fn normal(&self) -> DVec3 {
        self.manifold.data.normal
    }

    /// Its points.
    pub(super) fn points(&self) -> impl Iterator<Item = Point> + use<'a> {
        self.data().map(|data| Point { impulse: data.impulse, arms: [data.solver_dp1, data.solver_dp2] })
    }

    /// The engine's data on the points.
    fn data(&self) -> impl Iterator<Item = &'a ContactData> + use<'a> {
        let points = &self.manifold.points;
        let contacts = self.manifold.data.solver_contacts.iter().take(MOST_POINTS);
        contacts.filter_map(move |contact| {
            // The contact knows the index of its point. Reading it takes time, and a single point needs no index.
            let index = if points.len() == 1 { 0 } else { contact.contact_indices()[0] as usize };
            points.get(index).map(|point| &point.data)
        })
    }

    /// The penetration of the bodies, m; negative if they are apart. The closure returns the pose of a body, or `None` if the body is
    /// fixed.
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
        Some(self.push_or_nothing()).filter(|push| push.impulse != 0.0)
    }

    /// The impulse in the last step, which may be zero.
    fn push_or_nothing(&self) -> Push {
        let mut points = self.data();
        let Some(first) = points.next() else { return Push::default() };
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
        push.arms = push.arms.map(|arm| arm / count);
        // A single point has no arm for a twist.
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

/// Calls `look` with each touch that has pushed, and with its pair, in the order of `pairs`. Calls `meet` with each touch, pushing or
/// not.
///
/// The engine's contacts are scattered over the memory. Each of the short loops follows one more pointer for many contacts at once, so
/// that the processor need not wait for each in turn.
pub(super) fn visit<'a>(
    pairs: impl Iterator<Item = &'a ContactPair>,
    mut meet: impl FnMut(&Touch<'a>),
    mut look: impl FnMut(&'a ContactPair, &Touch<'a>, &Push),
) {
    const AT_ONCE: usize = 64;
    let all: Vec<(&ContactPair, &ContactManifold)> =
        pairs.flat_map(|pair| manifolds(pair).iter().map(move |manifold| (pair, manifold))).collect();
    let mut found = Vec::with_capacity(AT_ONCE);
    for block in all.chunks(AT_ONCE) {
        let mut touching = [false; AT_ONCE];
        for (touching, (_, manifold)) in touching.iter_mut().zip(block) {
            *touching = !manifold.data.solver_contacts.is_empty();
        }
        found.clear();
        for ((pair, manifold), _) in block.iter().zip(touching).filter(|(_, touching)| *touching) {
            let touch = Touch::new(manifold);
            found.extend(touch.map(|touch| (*pair, touch, touch.push_or_nothing())));
        }
        for (pair, touch, push) in &found {
            meet(touch);
            if push.impulse != 0.0 {
                look(pair, touch, push);
            }
        }
    }
}
