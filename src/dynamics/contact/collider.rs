//! Finds contacts between bodies and handles them.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::super::{BodyId, Breakdown, Constraint, Model, State};
use super::approach::{Approach, TOUCH, are_convex, close, places};
use super::closed::Closed;
use super::crowd::Crowd;
use super::group::Focus;
use super::nearest::{Nearest, nearest};
use super::pairs::Pairs;
use super::path::{Path, pose};
use super::solid::{Pose, Solid};
use super::touch::{Touch, inside, touches};
use super::{Contacts, Impact, Meeting};

/// At an event, bodies touch if their gap is below this part of the coordinates.
pub(super) const NEAR: f64 = 1e-10;

/// For bodies at rest, further places touch if their gap is below this part of the coordinates. Otherwise a body that
/// stands on three of four corners would never come to rest.
const SNUG: f64 = 1e-8;

/// Further places of touching bodies may overlap by this part of the coordinates.
const PASSED: f64 = 1e-12;

/// Bodies may overlap by this part of the coordinates when contacts begin.
const OVERLAP: f64 = 1e-9;

/// Approaches below this part of the fastest one are rounding.
pub(super) const SLIGHT: f64 = 1e-10;

/// The colliding bodies and their contacts.
#[derive(Clone)]
pub(in crate::dynamics) struct Collider {
    pub(super) contacts: Contacts,
    pub(super) solids: Vec<Option<Solid>>,
    pub(super) pairs: Pairs,
    pub(super) paths: Vec<Path>,
    /// Whether each body was present when contacts were last begun.
    is_known: Vec<bool>,
    /// The fastest approach so far, m/s. Much slower ones are rounding.
    pub(super) fastest: f64,
    /// The impacts since the last call of `take_impacts`.
    pub(super) impacts: Vec<Impact>,
    /// The number of impacts of each pair of bodies in the current step.
    pub(super) hits: BTreeMap<[usize; 2], u32>,
    /// The bodies with too many events in the current step to follow one by one.
    pub(super) crowd: Crowd,
    /// The group being advanced, if not all bodies are.
    pub(super) focus: Option<Focus>,
}

/// All places at which two bodies touch.
#[derive(Clone, Debug)]
pub(super) struct Touching {
    pub(super) bodies: [usize; 2],
    pub(super) law: Meeting,
    pub(super) touches: Vec<Touch>,
    /// Further places so near that they count as touching while the bodies do not move there.
    pub(super) snug: Vec<Touch>,
}

impl Collider {
    /// A collider for given contacts.
    pub(in crate::dynamics) fn new(contacts: Contacts) -> Collider {
        let (solids, pairs, paths) = (Vec::new(), Pairs::default(), Vec::new());
        let (impacts, hits, crowd) = (Vec::new(), BTreeMap::new(), Crowd::default());
        let is_known = Vec::new();
        Collider { contacts, solids, pairs, paths, is_known, fastest: 0.0, impacts, hits, crowd, focus: None }
    }

    /// Called at the beginning of a step.
    pub(in crate::dynamics) fn set_out(&mut self) {
        self.hits.clear();
    }

    /// The fastest approach so far, m/s.
    pub(in crate::dynamics) fn fastest(&self) -> f64 {
        self.fastest
    }

    /// The largest surface speed of a body from its rotation, m/s.
    pub(in crate::dynamics) fn spin(&self, body: usize, model: &Model, state: &State) -> f64 {
        let turning = model.angular_velocity(body, state).length();
        // The whole solid counts, since the reach of a ball's core is 0.
        let solid = self.solids.get(body).and_then(Option::as_ref);
        let reach = solid.map_or(0.0, |solid| solid.reach() + solid.size());
        if turning == 0.0 { 0.0 } else { turning * reach }
    }

    /// The bodies held at rest that a moving body touches.
    pub(in crate::dynamics) fn touched_at_rest(&mut self, model: &Model, state: &State) -> Vec<usize> {
        let is_held = |body: &usize| model.inverse_mass()[*body] == 0.0 && model.can_move(*body);
        let touching = self.touching_all(model, state);
        touching.iter().flat_map(|pair| pair.bodies).filter(is_held).collect()
    }

    /// Whether some bodies are advanced by time-stepping.
    pub(in crate::dynamics) fn is_crowded(&self) -> bool {
        !self.crowd.is_empty()
    }

    /// Called when bodies have changed.
    pub(in crate::dynamics) fn forget(&mut self) {
        self.pairs.forget();
        self.is_known.clear();
    }

    /// Called when some bodies appear or disappear.
    pub(in crate::dynamics) fn forget_bodies(&mut self, bodies: &[usize]) {
        self.pairs.forget();
        self.crowd.lose(bodies);
        self.is_known
            .iter_mut()
            .enumerate()
            .filter(|(i, _)| bodies.contains(i))
            .for_each(|(_, is_known)| *is_known = false);
    }

    /// The impacts since the last call.
    pub(in crate::dynamics) fn take_impacts(&mut self) -> Vec<Impact> {
        std::mem::take(&mut self.impacts)
    }

    /// Makes the solids of bodies added since the last call.
    fn meet_bodies(&mut self, model: &Model) {
        for i in self.solids.len()..model.len() {
            let collides = self.contacts.surfaces.get(i).is_some_and(Option::is_some);
            let solid = model.shape(i).filter(|_| collides).and_then(Solid::of);
            self.solids.push(solid);
        }
    }

    /// Records the paths of the bodies within a step, and the pairs that can meet.
    pub(super) fn follow(&mut self, model: &Model, (before, after): (&State, &State), duration: f64) {
        self.meet_bodies(model);
        let Collider { contacts, solids, pairs, paths, focus, .. } = self;
        let path = |i: usize| Path::of(i, model, before, after, duration);
        if let Some(focus) = focus {
            focus.bodies.iter().for_each(|&i| paths[i] = path(i));
            pairs.take_ways_off(solids, paths);
        } else {
            paths.clear();
            paths.extend((0..model.len()).map(path));
            pairs.follow(contacts, solids, paths, (model, before));
        }
    }

    /// The first time within a step at which bodies touch and approach, s after its beginning.
    pub(in crate::dynamics) fn first_touch(
        &mut self,
        model: &Model,
        (before, after): (&State, &State),
        duration: f64,
        closed: &[Arc<Closed>],
    ) -> Option<(f64, [usize; 2])> {
        self.follow(model, (before, after), duration);
        let Collider { solids, pairs, paths, fastest, crowd, .. } = self;
        let mut end = duration;
        let mut first = None;
        for pair in &mut pairs.list {
            let [a, b] = pair.bodies;
            let (Some(x), Some(y)) = (&solids[a], &solids[b]) else { continue };
            let scale = scale(pair.bodies, [x, y], before);
            let near_enough = NEAR * scale;
            if pair.free > near_enough {
                continue;
            }
            let is_closed = closed.iter().any(|contact| contact.bodies == pair.bodies);
            if is_closed || crowd.holds(pair.bodies, model) || is_passive(pair.bodies, model) {
                continue;
            }
            let ways = super::pairs::way(Some(x), &paths[a]) + super::pairs::way(Some(y), &paths[b]);
            let poses = [a, b].map(|i| pose(i, model, before));
            let Some(near) = nearest(x, &poses[0], y, &poses[1], f64::INFINITY) else { continue };
            pair.free = near.gap - ways;
            if pair.free > near_enough {
                continue;
            }
            let speed = (before.velocity[b] - before.velocity[a]).length();
            let slight = 2.0 * SLIGHT * fastest.max(speed);
            let approach =
                Approach { solids: [x, y], paths: [&paths[a], &paths[b]], slight, touch: TOUCH * scale };
            if let Some(time) = approach.first(end) {
                (end, first) = (time, Some((time, pair.bodies)));
            }
        }
        first
    }

    /// The gap of two bodies, m, and its rate, m/s. The gap is 0 if they touch to within rounding, and negative if they
    /// overlap.
    pub(in crate::dynamics) fn gap(
        &self,
        model: &Model,
        state: &State,
        bodies: [usize; 2],
    ) -> Option<(f64, f64)> {
        let [a, b] = bodies;
        let (Some(x), Some(y)) = (&self.solids[a], &self.solids[b]) else { return None };
        let poses = bodies.map(|i| pose(i, model, state));
        let near = nearest(x, &poses[0], y, &poses[1], f64::INFINITY)?;
        let touch = TOUCH * scale(bodies, [x, y], state);
        let gap = |place: &Nearest| if place.gap.abs() > touch { place.gap } else { 0.0 };
        let turns = |&body: &usize| model.angular_velocity(body, state) != DVec3::ZERO;
        if are_convex([x, y]) && !bodies.iter().any(turns) {
            return Some((gap(&near), rate(&near, bodies, (model, state))));
        }
        let found = places([x, y], [&poses[0], &poses[1]], near, close([x, y])).into_iter();
        let found = found.map(|place| (gap(&place), rate(&place, bodies, (model, state))));
        let nearest = (gap(&near), rate(&near, bodies, (model, state)));
        // Of the approaching places, the first to touch.
        let coming = found.filter(|(_, rate)| *rate < 0.0);
        Some(coming.min_by(|a, b| (a.0 / -a.1).total_cmp(&(b.0 / -b.1))).unwrap_or(nearest))
    }

    /// How far touching bodies are from touching at further places or leaving the edge or face on which they touch, in
    /// units of the tolerance. Negative once either has happened.
    pub(in crate::dynamics) fn margin(&self, model: &Model, state: &State, closed: &[Arc<Closed>]) -> f64 {
        let mut margin = f64::INFINITY;
        let mut last = None;
        for contact in closed {
            let [a, b] = contact.bodies;
            let (Some(x), Some(y)) = (&self.solids[a], &self.solids[b]) else { continue };
            let [p, q] = [a, b].map(|i| pose(i, model, state));
            let tolerated = PASSED * scale(contact.bodies, [x, y], state);
            margin = margin.min(inside(&contact.touch, x, &p, y, &q) / tolerated);
            margin = margin.min(contact.left([p, q]) / PASSED);
            if last == Some(contact.bodies) {
                continue;
            }
            last = Some(contact.bodies);
            let is_closed = |touch: &Touch| {
                let same = |other: &&Arc<Closed>| {
                    other.bodies == contact.bodies && other.touch.patches == touch.patches
                };
                closed.iter().any(|other| same(&other))
            };
            // An overlap by rounding that opens again is ignored.
            let comes = |touch: &&Touch| rate(&touch.meeting, contact.bodies, (model, state)) < 0.0;
            for touch in touches(x, &p, y, &q, 0.0).iter().filter(|touch| !is_closed(touch)).filter(comes) {
                margin = margin.min(touch.meeting.gap / tolerated);
            }
        }
        margin
    }

    /// All places at which bodies touch, in the order of the bodies.
    pub(super) fn touching(&mut self, model: &Model, state: &State) -> Vec<Touching> {
        self.meet_bodies(model);
        let Collider { solids, crowd, pairs, .. } = self;
        let mut all = Vec::new();
        for pair in &mut pairs.list {
            let [a, b] = pair.bodies;
            let (Some(x), Some(y)) = (&solids[a], &solids[b]) else { continue };
            if crowd.holds(pair.bodies, model) || is_passive(pair.bodies, model) {
                continue;
            }
            let within = NEAR * scale(pair.bodies, [x, y], state);
            if pair.free > within {
                continue;
            }
            let poses: [Pose; 2] = [a, b].map(|i| pose(i, model, state));
            let Some(near) = nearest(x, &poses[0], y, &poses[1], f64::INFINITY) else { continue };
            pair.free = near.gap;
            if pair.free > within {
                continue;
            }
            let found = touches(x, &poses[0], y, &poses[1], SNUG / NEAR * within).into_iter();
            let (touches, snug) = found.partition(|touch| touch.meeting.gap <= within);
            all.push(Touching { bodies: pair.bodies, law: pair.law, touches, snug });
        }
        all
    }

    /// Finds the pairs where contacts begin, and the first two bodies that overlap, if one has just appeared.
    pub(in crate::dynamics) fn start(
        &mut self,
        model: &Model,
        time: f64,
        state: &State,
        closed: &[Arc<Closed>],
    ) -> Option<Breakdown> {
        self.meet_bodies(model);
        self.paths.clear();
        self.paths.extend((0..model.len()).map(|i| Path::of(i, model, state, state, 1.0)));
        self.pairs.forget();
        let Collider { contacts, solids, pairs, paths, is_known, .. } = self;
        is_known.resize(model.len(), false);
        paths.iter_mut().for_each(Path::stop);
        pairs.follow(contacts, solids, paths, (model, state));
        for pair in &pairs.list {
            let [a, b] = pair.bodies;
            let (Some(x), Some(y)) = (&solids[a], &solids[b]) else { continue };
            if is_known[a] && is_known[b] || closed.iter().any(|contact| contact.bodies == pair.bodies) {
                continue;
            }
            let poses = [a, b].map(|i| pose(i, model, state));
            let Some(near) = nearest(x, &poses[0], y, &poses[1], f64::INFINITY) else { continue };
            if near.gap < -OVERLAP * scale(pair.bodies, [x, y], state) {
                let bodies = pair.bodies.map(BodyId::new);
                return Some(Breakdown::Overlapping { bodies, time, depth: -near.gap });
            }
        }
        for (i, is_known) in is_known.iter_mut().enumerate() {
            *is_known = model.is_present(i);
        }
        None
    }

    /// Whether joints hold a body.
    pub(super) fn is_jointed(model: &Model, body: usize) -> bool {
        let concerns =
            |constraint: &Arc<dyn Constraint>| constraint.bodies().iter().any(|other| other.index() == body);
        model.constraints().iter().any(concerns)
    }
}

/// Whether no load moves either of two bodies.
pub(super) fn is_passive(bodies: [usize; 2], model: &Model) -> bool {
    bodies.iter().all(|&body| model.inverse_mass()[body] == 0.0)
}

/// The rate of the gap of two bodies, m/s.
fn rate(meeting: &Nearest, bodies: [usize; 2], (model, state): (&Model, &State)) -> f64 {
    let at = |i: usize| {
        let arm = meeting.on[i] - state.location[bodies[i]];
        state.velocity[bodies[i]] + model.angular_velocity(bodies[i], state).cross(arm)
    };
    meeting.normal.dot(at(1) - at(0))
}

/// The size of the coordinates of two bodies, m.
pub(super) fn scale(bodies: [usize; 2], solids: [&Solid; 2], state: &State) -> f64 {
    let size = |i: usize| {
        let reach = solids[i].reach() + solids[i].size();
        if reach.is_finite() { state.location[bodies[i]].abs().max_element() + reach } else { 0.0 }
    };
    size(0).max(size(1))
}
