//! The collider: it finds contacts between bodies, and events such as the first touch of two bodies.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::super::{BodyId, Breakdown, Constraint, LawResidual, Model, State};
use super::approach::{Approach, COORDINATE_ROUNDING, are_convex, close, places};
use super::closest_points::{ClosestPoints, nearest};
use super::crowd::Crowd;
use super::flush::{Places, at_seams, slide_past};
use super::group::Focus;
use super::impacts::Hits;
use super::lasting_contact::LastingContact;
use super::laws::LawBook;
use super::pairs::{Pairs, overlapping};
use super::path::{Path, pose};
use super::solid::{Pose, Solid};
use super::touch::{Touch, inside, touches};
use super::{ContactProperties, Contacts, Impact};

/// At an event, bodies count as touching if their gap is below this fraction of their size.
pub(super) const CONTACT_TOLERANCE: f64 = 1e-10;

/// For bodies at rest, further points count as touching if their gap is below this fraction of the bodies' size. Otherwise a body that
/// stands on three of four corners would never come to rest.
const RESTING_CONTACT_TOLERANCE: f64 = 1e-8;

/// Further points of touching bodies may overlap by this fraction of the bodies' size before an event ends the step. The event also
/// tolerates this difference between the cosine of a contact's rotation and its limit.
const EVENT_OVERLAP_TOLERANCE: f64 = 1e-12;

/// The largest overlap of a body with others when it appears, as a fraction of their size.
const MAX_INITIAL_OVERLAP: f64 = 1e-9;

/// A closing speed counts as a rounding error if it is below this fraction of the largest one so far.
pub(super) const SPEED_ROUNDING: f64 = 1e-10;

/// The colliding bodies, their contacts and impacts, and the search for them.
#[derive(Clone)]
pub(crate) struct Collider {
    pub(super) contacts: Contacts,
    pub(super) solids: Vec<Option<Solid>>,
    pub(super) pairs: Pairs,
    pub(super) paths: Vec<Path>,
    /// For each body, whether it was present when contacts were last started. Only bodies that were absent are checked for overlaps.
    is_known: Vec<bool>,
    /// The largest closing speed of two bodies so far, m/s. Much smaller speeds count as rounding errors.
    pub(super) fastest: f64,
    /// The impacts since the last call of `take_impacts`, in order of time.
    pub(super) impacts: Vec<Impact>,
    /// For each pair of bodies, the impacts in the current step.
    pub(super) hits: BTreeMap<[usize; 2], Hits>,
    /// The bodies advanced by Moreau's scheme, because they have too many events in the current step.
    pub(super) crowd: Crowd,
    /// The group of bodies that is being advanced; `None` while all bodies are advanced together.
    pub(super) focus: Option<Focus>,
    /// How well the laws that no contact can break have been kept.
    pub(super) laws: LawBook,
}

/// Two touching bodies with all their contact points.
#[derive(Clone, Debug)]
pub(super) struct Touching {
    pub(super) bodies: [usize; 2],
    pub(super) law: ContactProperties,
    pub(super) touches: Vec<Touch>,
    /// Points with gaps so small that they count as touching while the bodies do not move there.
    pub(super) snug: Vec<Touch>,
}

impl Collider {
    /// Creates a collider for bodies with these contact properties.
    pub(crate) fn new(contacts: Contacts) -> Collider {
        let (solids, pairs, paths) = (Vec::new(), Pairs::default(), Vec::new());
        let (impacts, hits, crowd) = (Vec::new(), BTreeMap::new(), Crowd::default());
        let (is_known, laws) = (Vec::new(), LawBook::default());
        let (fastest, focus) = (0.0, None);
        Collider { contacts, solids, pairs, paths, is_known, fastest, impacts, hits, crowd, focus, laws }
    }

    /// Resets the counts of impacts at the beginning of a step.
    pub(crate) fn set_out(&mut self) {
        self.hits.clear();
    }

    /// Returns the worst residual so far of each law that no contact can break.
    pub(crate) fn law_residuals(&self) -> &[LawResidual] {
        self.laws.worst()
    }

    /// Returns the largest closing speed of two bodies so far, m/s.
    pub(crate) fn fastest(&self) -> f64 {
        self.fastest
    }

    /// Returns how far a body reaches from its center, m; 0 if it does not end, or does not collide.
    pub(crate) fn reach(&self, body: usize) -> f64 {
        let solid = self.solids.get(body).and_then(Option::as_ref);
        solid.map(|solid| solid.reach() + solid.size()).filter(|reach| reach.is_finite()).unwrap_or(0.0)
    }

    /// Returns an upper bound of the surface speed that a body has from its rotation, m/s.
    pub(crate) fn spin(&self, body: usize, model: &Model, state: &State) -> f64 {
        let turning = model.angular_velocity(body, state).length();
        // The reach of a ball's core is 0, so the size of the solid is added.
        let solid = self.solids.get(body).and_then(Option::as_ref);
        let reach = solid.map_or(0.0, |solid| solid.reach() + solid.size());
        if turning == 0.0 { 0.0 } else { turning * reach }
    }

    /// Returns the bodies held at rest that a moving body touches, or that a body with a given motion pushes, by index.
    pub(crate) fn touched_at_rest(&mut self, model: &Model, state: &State) -> Vec<usize> {
        let is_unmoved = |body: &usize| model.inverse_mass()[*body] == 0.0;
        let is_held = |body: &usize| is_unmoved(body) && model.can_move(*body);
        // A body with a given motion disturbs a body at rest only if it approaches: it may stand beside it for good.
        let is_disturbed = |pair: &Touching| {
            let comes = |touch: &Touch| rate(&touch.meeting, pair.bodies, (model, state)) < 0.0;
            !pair.bodies.iter().all(is_unmoved) || pair.touches.iter().any(comes)
        };
        let touching = self.touching_all(model, state).into_iter().filter(is_disturbed);
        touching.flat_map(|pair| pair.bodies).filter(is_held).collect()
    }

    /// Returns true if any bodies are advanced by Moreau's scheme.
    pub(crate) fn is_crowded(&self) -> bool {
        !self.crowd.is_empty()
    }

    /// Discards the list of nearby pairs, and the record of which bodies were present. Must be called when bodies have changed.
    pub(crate) fn forget(&mut self) {
        self.pairs.forget();
        self.is_known.clear();
    }

    /// Discards what is known about these bodies. Must be called when they appear or disappear.
    pub(crate) fn forget_bodies(&mut self, bodies: &[usize]) {
        self.pairs.forget();
        self.crowd.lose(bodies);
        self.is_known
            .iter_mut()
            .enumerate()
            .filter(|(i, _)| bodies.contains(i))
            .for_each(|(_, is_known)| *is_known = false);
    }

    /// Returns the impacts since the last call, and forgets them.
    pub(crate) fn take_impacts(&mut self) -> Vec<Impact> {
        std::mem::take(&mut self.impacts)
    }

    /// Creates the solids of all bodies that were added since the last call.
    pub(super) fn meet_bodies(&mut self, model: &Model) {
        for i in self.solids.len()..model.len() {
            let collides = self.contacts.surfaces.get(i).is_some_and(Option::is_some);
            let solid = model.shape(i).filter(|_| collides).and_then(Solid::of);
            self.solids.push(solid);
        }
    }

    /// Records the paths of the bodies within a step, and updates the list of pairs that can touch.
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

    /// Returns the first time within a step at which two bodies touch and approach, in seconds after the beginning of the step, and these
    /// two bodies. Pairs that are already in contact do not count.
    pub(crate) fn first_touch(
        &mut self,
        model: &Model,
        (before, after): (&State, &State),
        duration: f64,
        closed: &[Arc<LastingContact>],
    ) -> Option<(f64, [usize; 2])> {
        self.follow(model, (before, after), duration);
        let Collider { solids, pairs, paths, fastest, crowd, .. } = self;
        let mut end = duration;
        let mut first = None;
        for pair in &mut pairs.list {
            let [a, b] = pair.bodies;
            let (Some(x), Some(y)) = (&solids[a], &solids[b]) else { continue };
            let scale = ContactScale::of(pair.bodies, [x, y], (model, before));
            let near_enough = scale.tolerance(CONTACT_TOLERANCE);
            if pair.free > near_enough {
                continue;
            }
            let is_closed = closed.iter().any(|contact| contact.bodies == pair.bodies);
            if is_closed
                || crowd.holds(pair.bodies, |body| crowd.has(body), model)
                || is_passive(pair.bodies, model)
            {
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
            let slight = 2.0 * SPEED_ROUNDING * fastest.max(speed);
            let approach =
                Approach { solids: [x, y], paths: [&paths[a], &paths[b]], slight, touch: scale.touch() };
            if let Some(time) = approach.first(end) {
                (end, first) = (time, Some((time, pair.bodies)));
            }
        }
        first
    }

    /// Returns the gap of two bodies, m, and its rate, m/s. The gap is 0 if the bodies touch to within rounding errors, and negative if
    /// they overlap. `None` if a body has no solid.
    pub(crate) fn gap(&self, model: &Model, state: &State, bodies: [usize; 2]) -> Option<(f64, f64)> {
        let [a, b] = bodies;
        let (Some(x), Some(y)) = (&self.solids[a], &self.solids[b]) else { return None };
        let poses = bodies.map(|i| pose(i, model, state));
        let near = nearest(x, &poses[0], y, &poses[1], f64::INFINITY)?;
        let touch = ContactScale::of(bodies, [x, y], (model, state)).touch();
        let gap = |place: &ClosestPoints| if place.gap.abs() > touch { place.gap } else { 0.0 };
        let turns = |&body: &usize| model.angular_velocity(body, state) != DVec3::ZERO;
        if are_convex([x, y]) && !bodies.iter().any(turns) {
            return Some((gap(&near), rate(&near, bodies, (model, state))));
        }
        let found = places([x, y], [&poses[0], &poses[1]], near, close([x, y])).into_iter();
        let found = found.map(|place| (gap(&place), rate(&place, bodies, (model, state))));
        let nearest = (gap(&near), rate(&near, bodies, (model, state)));
        // Of the approaching pairs of points, the one that will touch first counts.
        let coming = found.filter(|(_, rate)| *rate < 0.0);
        Some(coming.min_by(|a, b| (a.0 / -a.1).total_cmp(&(b.0 / -b.1))).unwrap_or(nearest))
    }

    /// Returns how far touching bodies are from the next change of their contact points, in units of the tolerance. At such a change, the
    /// bodies touch at a further point, or leave the edge or face on which they touch. The result is negative after the change.
    pub(crate) fn margin(&self, model: &Model, state: &State, closed: &[Arc<LastingContact>]) -> f64 {
        let mut margin = f64::INFINITY;
        let mut last = None;
        for contact in closed {
            let [a, b] = contact.bodies;
            let (Some(x), Some(y)) = (&self.solids[a], &self.solids[b]) else { continue };
            let [p, q] = [a, b].map(|i| pose(i, model, state));
            let tolerated =
                ContactScale::of(contact.bodies, [x, y], (model, state)).tolerance(EVENT_OVERLAP_TOLERANCE);
            margin = margin.min(inside(&contact.touch, x, &p, y, &q) / tolerated);
            margin = margin.min(contact.left([p, q]) / EVENT_OVERLAP_TOLERANCE);
            if last == Some(contact.bodies) {
                continue;
            }
            last = Some(contact.bodies);
            let is_closed = |touch: &Touch| {
                let same = |other: &&Arc<LastingContact>| {
                    other.bodies == contact.bodies && other.touch.patches == touch.patches
                };
                closed.iter().any(|other| same(&other))
            };
            // A point that overlaps by a rounding error but separates is ignored.
            let comes = |touch: &&Touch| {
                let velocities = velocities(&touch.meeting, contact.bodies, (model, state));
                (velocities[1] - velocities[0]).dot(touch.meeting.normal) < 0.0
                    && !slide_past([x, y], [&p, &q], &touch.meeting, velocities)
            };
            for touch in touches(x, &p, y, &q, 0.0).iter().filter(|touch| !is_closed(touch)).filter(comes) {
                margin = margin.min(touch.meeting.gap / tolerated);
            }
        }
        margin
    }

    /// Returns all contact points of touching bodies at a state, in the order of the bodies.
    pub(super) fn touching(&mut self, model: &Model, state: &State) -> Vec<Touching> {
        self.meet_bodies(model);
        let Collider { solids, crowd, pairs, .. } = self;
        let mut all = Vec::new();
        for pair in &mut pairs.list {
            let [a, b] = pair.bodies;
            let (Some(x), Some(y)) = (&solids[a], &solids[b]) else { continue };
            if crowd.holds(pair.bodies, |body| crowd.has(body), model) || is_passive(pair.bodies, model) {
                continue;
            }
            let scale = ContactScale::of(pair.bodies, [x, y], (model, state));
            let within = scale.tolerance(CONTACT_TOLERANCE);
            if pair.free > within {
                continue;
            }
            let poses: [Pose; 2] = [a, b].map(|i| pose(i, model, state));
            let Some(near) = nearest(x, &poses[0], y, &poses[1], f64::INFINITY) else { continue };
            pair.free = near.gap;
            if pair.free > within {
                continue;
            }
            let mut found = touches(x, &poses[0], y, &poses[1], scale.tolerance(RESTING_CONTACT_TOLERANCE));
            found.retain(|touch| {
                let velocities = velocities(&touch.meeting, pair.bodies, (model, state));
                !slide_past([x, y], [&poses[0], &poses[1]], &touch.meeting, velocities)
            });
            let (touches, snug) = found.into_iter().partition(|touch| touch.meeting.gap <= within);
            all.push(Touching { bodies: pair.bodies, law: pair.law, touches, snug });
        }
        let of_pair = |touching: &Touching| {
            let bodies = touching.bodies;
            let points = touching.touches.iter().chain(&touching.snug);
            points.map(move |touch| (bodies, touch.meeting)).collect::<Vec<_>>()
        };
        let places = all.iter().flat_map(of_pair).collect();
        let mut at_seams = self.at_seams(&places, model, state).into_iter();
        for touching in &mut all {
            for touches in [&mut touching.touches, &mut touching.snug] {
                touches.retain(|_| !at_seams.next().unwrap_or(false));
            }
        }
        all
    }

    /// Returns, for each of all contact points at a state, whether it lies at a seam, and stops nothing.
    pub(super) fn at_seams(&self, places: &Places, model: &Model, state: &State) -> Vec<bool> {
        let solids = |number: usize| {
            let [a, b] = places[number].0;
            let solids = [self.solids[a].as_ref()?, self.solids[b].as_ref()?];
            Some((solids, [a, b].map(|body| pose(body, model, state))))
        };
        at_seams(places, |body| model.inverse_mass()[body] != 0.0, solids)
    }

    /// Prepares the search for contacts at a state, and records which bodies are present. Returns a breakdown if a body that has just
    /// appeared overlaps another body. Allowed are overlaps by rounding errors, and by the fraction `part` of the smaller body's size.
    pub(crate) fn start(
        &mut self,
        model: &Model,
        (time, state): (f64, &State),
        closed: &[Arc<LastingContact>],
        part: f64,
    ) -> Option<Breakdown> {
        self.meet_bodies(model);
        let Collider { contacts, solids, is_known, .. } = self;
        is_known.resize(model.len(), false);
        // The overlaps are found before the list of pairs is made, which would be very long if all bodies were in one place.
        let overlap = |bodies: [usize; 2]| {
            let [a, b] = bodies;
            let (Some(x), Some(y)) = (&solids[a], &solids[b]) else { return None };
            if is_known[a] && is_known[b] || closed.iter().any(|contact| contact.bodies == bodies) {
                return None;
            }
            let poses = [a, b].map(|i| pose(i, model, state));
            let near = nearest(x, &poses[0], y, &poses[1], f64::INFINITY)?;
            let tolerated = ContactScale::of(bodies, [x, y], (model, state)).tolerance(MAX_INITIAL_OVERLAP);
            let tolerated = tolerated.max(part * x.size().min(y.size()));
            (near.gap < -tolerated).then_some(-near.gap)
        };
        let (found, _) = overlapping(contacts, solids, (model, state), overlap);
        if let Some((bodies, depth)) = found.into_iter().min_by_key(|(bodies, _)| *bodies) {
            return Some(Breakdown::Overlapping { bodies: bodies.map(BodyId::new), time, depth });
        }
        self.paths.clear();
        self.paths.extend((0..model.len()).map(|i| Path::of(i, model, state, state, 1.0)));
        self.pairs.forget();
        let Collider { contacts, solids, pairs, paths, is_known, .. } = self;
        paths.iter_mut().for_each(Path::stop);
        pairs.follow(contacts, solids, paths, (model, state));
        for (i, is_known) in is_known.iter_mut().enumerate() {
            *is_known = model.is_present(i);
        }
        None
    }

    /// Returns true if a joint acts on this body.
    pub(super) fn is_jointed(model: &Model, body: usize) -> bool {
        let concerns =
            |constraint: &Arc<dyn Constraint>| constraint.bodies().iter().any(|other| other.index() == body);
        model.constraints().iter().any(concerns)
    }
}

/// Returns true if no impact between two bodies can change the motion of either. A body held at rest yields to a body with a given motion.
pub(super) fn is_passive(bodies: [usize; 2], model: &Model) -> bool {
    let is_unmoved = |body: usize| model.inverse_mass()[body] == 0.0;
    let is_pushed = |[held, pusher]: [usize; 2]| model.can_move(held) && model.motion(pusher).is_some();
    let [a, b] = bodies;
    is_unmoved(a) && is_unmoved(b) && !is_pushed([a, b]) && !is_pushed([b, a])
}

/// Computes the rate of the gap at a pair of points of two bodies, m/s.
fn rate(meeting: &ClosestPoints, bodies: [usize; 2], at: (&Model, &State)) -> f64 {
    let [first, second] = velocities(meeting, bodies, at);
    meeting.normal.dot(second - first)
}

/// Computes the velocities of two bodies at their closest points, m/s.
pub(super) fn velocities(
    meeting: &ClosestPoints,
    bodies: [usize; 2],
    (model, state): (&Model, &State),
) -> [DVec3; 2] {
    [0, 1].map(|i| {
        let arm = meeting.on[i] - state.location[bodies[i]];
        state.velocity[bodies[i]] + model.angular_velocity(bodies[i], state).cross(arm)
    })
}

/// The lengths to which the tolerances of a contact are relative. They follow from the sizes of the bodies; the coordinates only widen a
/// tolerance to the rounding errors that they cause.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactScale {
    /// The size of the larger of the two bodies that forces can move, m. If forces move neither of them: the size of the smaller one.
    size: f64,
    /// The magnitude of the coordinates of the two bodies, m, to which rounding errors are proportional.
    coordinates: f64,
}

impl ContactScale {
    pub(super) fn of(
        bodies: [usize; 2],
        solids: [&Solid; 2],
        (model, state): (&Model, &State),
    ) -> ContactScale {
        let reach = |i: usize| solids[i].reach() + solids[i].size();
        let finite = |length: f64| if length.is_finite() { length } else { 0.0 };
        let own = |i: usize| if model.can_move(bodies[i]) { finite(reach(i)) } else { 0.0 };
        let coordinate = |i: usize| state.location[bodies[i]].abs().max_element() + finite(reach(i));
        let size = own(0).max(own(1));
        let size = if size > 0.0 { size } else { finite(reach(0).min(reach(1))) };
        ContactScale { size, coordinates: coordinate(0).max(coordinate(1)) }
    }

    /// Returns the tolerance that is this fraction of the size of the bodies, m, but at least ten times the gap at which they touch.
    pub(super) fn tolerance(self, part: f64) -> f64 {
        (part * self.size).max(10.0 * self.touch())
    }

    /// Returns the gap at which the bodies touch to within rounding errors, m.
    pub(super) fn touch(self) -> f64 {
        COORDINATE_ROUNDING * self.coordinates
    }
}

/// Returns the deepest overlap of some bodies and its depth, m, if very many of their pairs overlap by more than `allowed`, m. The bodies
/// are given by their indices. Meshes and shapes without a [`Solid`] do not count.
#[cfg(feature = "time-stepping")]
pub(crate) fn crowded(
    contacts: &Contacts,
    some: &[usize],
    allowed: f64,
    (model, state): (&Model, &State),
) -> Option<([usize; 2], f64)> {
    let mut solids = vec![None; model.len()];
    for &i in some {
        let collides = contacts.surfaces.get(i).is_some_and(Option::is_some);
        let shape = model.shape(i).filter(|shape| collides && !matches!(shape, crate::Shape::Mesh { .. }));
        solids[i] = shape.and_then(Solid::of);
    }
    let overlap = |[a, b]: [usize; 2]| {
        let (Some(x), Some(y)) = (&solids[a], &solids[b]) else { return None };
        let near = nearest(x, &pose(a, model, state), y, &pose(b, model, state), f64::INFINITY)?;
        (near.gap < -allowed).then_some(-near.gap)
    };
    let (found, is_crowded) = overlapping(contacts, &solids, (model, state), overlap);
    let deepest = |one: &&([usize; 2], f64), two: &&([usize; 2], f64)| {
        one.1.total_cmp(&two.1).then_with(|| two.0.cmp(&one.0))
    };
    found.iter().filter(|_| is_crowded).max_by(deepest).copied()
}
