//! The motion of the crowd through a step, by Moreau's scheme.
//!
//! A step is divided into a few equal substeps. In each, impulses stop or reverse approaching bodies; then the forces, the contacts and the
//! friction act with the velocities in the middle of the substep. The energy that contacts and friction take from the bodies is booked. The
//! order of the method is 1. Sources: J. J. Moreau, *Unilateral contact and dry friction in finite freedom dynamics* (1988); M. Jean,
//! Comput. Methods Appl. Mech. Eng. 177 (1999) 235.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::super::super::{BodyId, Breakdown, Impact, Loads, Model, State};
use super::super::approach::close;
use super::super::closest_points::nearest;
use super::super::collider::{Collider, ContactScale, velocities};
use super::super::flush::slide_past;
use super::super::lasting_contact::{LastingContact, spoke};
use super::super::pairs::{Pair, near};
use super::super::path::pose;
use super::super::solid::{Pose, Solid};
use super::super::touch::{Touch, touches};
use super::Crowd;
use super::impulses::Jointed;
use super::substep::separate;

/// The smallest and the largest number of substeps in a step.
const SUBSTEPS_PER_STEP: [f64; 2] = [2.0, 64.0];

/// The longest path of a body in a substep, as a fraction of the body's size. The path may be longer if this limit would require more
/// substeps than the largest number in [`SUBSTEPS_PER_STEP`].
const MAX_PATH_PER_SUBSTEP: f64 = 0.12;

/// Two bodies that move relative to each other by at most this many times the size of the smaller one in a substep cannot pass through each
/// other in it.
const MAX_MISSING_PATH: f64 = 0.5;

/// Points of bodies that push each other stay in contact at the end of the step if their gap is below this fraction of the smaller body's
/// size.
pub(super) const PUSHING_CONTACT_TOLERANCE: f64 = 1e-5;

/// Bodies are jammed if they overlap at the end of the step by more than this fraction of the smaller body's size.
pub(super) const JAMMED_OVERLAP: f64 = 0.01;

/// The largest number of attempts to separate jammed bodies. After them, the run fails.
pub(super) const MAX_SEPARATION_ATTEMPTS: usize = 50;

/// Bodies stay in the crowd while their gap to another body is below this fraction of the smaller body's size. Lower bounces do not count as
/// free flight.
pub(super) const MAX_CROWD_GAP: f64 = 0.01;

/// The largest number of times that a substep is halved because its impulses add energy. If they still do, the run fails.
const MAX_HALVINGS: u32 = 6;

/// Times within a substep count as equal if they differ by less than this fraction of the substep.
const TIME_TOLERANCE: f64 = 1e-12;

/// Bodies count as touching if their gap is below this fraction of their size.
const CONTACT_TOLERANCE: f64 = 1e-9;

/// The motion of the crowd through a step, sampled at the ends of equal substeps.
#[derive(Clone, Default)]
pub(super) struct SubstepMotion {
    /// The time at which the motion begins, s.
    start: f64,
    /// The length of each substep, s.
    part: f64,
    /// The states at the beginning and at the end of each substep, with one entry for each body of the crowd.
    states: Vec<State>,
    /// The state of all bodies at the beginning of the motion. `velocity` holds the velocities of bodies outside the crowd, m/s.
    first: State,
    velocity: Vec<DVec3>,
    /// The pairs of bodies that can meet during the motion.
    pairs: Vec<Pair>,
    failure: Option<Breakdown>,
    /// The impacts during the motion that are not reported yet, in order of time.
    impacts: Vec<Impact>,
    /// The two moments within substeps that were computed last: the time since the beginning of the motion, s, and the state.
    between: [(f64, State); 2],
}

impl SubstepMotion {
    /// Returns the state of the crowd at the end of the motion.
    pub(super) fn last(&self) -> &State {
        self.states.last().unwrap_or(&self.first)
    }

    pub(super) fn failure(&self) -> Option<Breakdown> {
        self.failure
    }
}

impl Collider {
    /// Advances the crowd from time `t` by `dt` seconds. `rest` is the time from `t` + `dt` to the end of the step, s. All other bodies have
    /// already been advanced from `before` to `after`. Returns a breakdown if the motion fails.
    pub(crate) fn advance_crowd(
        &mut self,
        model: &Model,
        (t, dt, rest): (f64, f64, f64),
        (before, after): (&State, &mut State),
        loads: &mut Loads,
    ) -> Option<Breakdown> {
        if self.crowd.is_empty() || dt == 0.0 {
            return None;
        }
        let known = self.crowd.course.take().and_then(|mut course| {
            let now = self.moment(&mut course, t, model, loads);
            // The computed motion is invalid if other bodies have hit the crowd in the meantime.
            let is_here = State { accounts: now.accounts, ..self.crowd.part_of(before) } == now;
            is_here.then_some((course, now.accounts))
        });
        let (mut course, old) = match known {
            Some(known) => known,
            None => (self.course(model, (t, dt + rest), (before, after), loads), before.accounts),
        };
        // The loads have worked along the motion that the integration method gave the crowd. The motion of the crowd takes its place, and so
        // does its work.
        for power in [self.crowd.power(model, t, before), self.crowd.power(model, t + dt, after)] {
            after.accounts.add(-0.5 * dt, power);
        }
        let new = self.moment(&mut course, t + dt, model, loads);
        for (at, &body) in self.crowd.bodies.iter().enumerate() {
            after.location[body] = new.location[at];
            after.velocity[body] = new.velocity[at];
            after.orientation[body] = new.orientation[at];
            after.angular_momentum[body] = new.angular_momentum[at];
        }
        after.accounts.add(1.0, new.accounts);
        after.accounts.add(-1.0, old);
        let failure = course.failure;
        self.crowd.course = Some(course);
        failure
    }

    /// Computes the motion of the crowd from the state `before`, for `span` seconds. Bodies outside the crowd move at their velocities in
    /// `after`.
    pub(super) fn course(
        &mut self,
        model: &Model,
        (t, span): (f64, f64),
        (before, after): (&State, &State),
        loads: &mut Loads,
    ) -> SubstepMotion {
        let pairs = self.crowd_pairs(model, before, span);
        let parts = self.parts(model, before, span, &pairs);
        let mut course = SubstepMotion {
            start: t,
            part: span / parts,
            states: vec![self.crowd.part_of(before)],
            first: before.clone(),
            velocity: after.velocity.clone(),
            pairs,
            ..SubstepMotion::default()
        };
        for k in 0..parts as usize {
            let next = self.advance_from(&course, k, course.part, model, loads);
            course.states.push(next);
            course.impacts.append(&mut self.crowd.impacts);
        }
        course.failure = self.crowd.solver.take_failure();
        course
    }

    /// Reports the impacts of the crowd up to `time`, s, to which the crowd has been advanced.
    pub(crate) fn note_rebounds(&mut self, time: f64) {
        let Collider { crowd, impacts, laws, .. } = self;
        laws.note_all(&crowd.laws);
        let Some(course) = &mut crowd.course else { return };
        let passed = course.impacts.partition_point(|impact| impact.time <= time);
        impacts.extend(course.impacts.drain(..passed));
    }

    /// Returns the state of the crowd at `time`, s.
    pub(super) fn moment(
        &mut self,
        course: &mut SubstepMotion,
        time: f64,
        model: &Model,
        loads: &mut Loads,
    ) -> State {
        let passed = ((time - course.start) / course.part).max(0.0);
        let last = course.states.len() - 1;
        let k = ((passed + TIME_TOLERANCE) as usize).min(last);
        let left = time - course.start - k as f64 * course.part;
        if k == last || left <= TIME_TOLERANCE * course.part {
            return course.states[k].clone();
        }
        let key = time - course.start;
        if let Some((_, known)) = course.between.iter().find(|(at, _)| at.to_bits() == key.to_bits()) {
            return known.clone();
        }
        let pushing = self.crowd.pushing.clone();
        let found = self.advance_from(course, k, left, model, loads);
        self.crowd.pushing = pushing;
        self.crowd.impacts.clear();
        self.crowd.solver.take_failure();
        course.between.swap(0, 1);
        course.between[0] = (key, found.clone());
        found
    }

    /// Returns the state of the crowd `part` seconds after the beginning of substep `k`, at or before its end.
    fn advance_from(
        &mut self,
        course: &SubstepMotion,
        k: usize,
        part: f64,
        model: &Model,
        loads: &mut Loads,
    ) -> State {
        let mut crowd = std::mem::take(&mut self.crowd);
        crowd.laws.note_all(&self.laws);
        let passed = k as f64 * course.part;
        let time = course.start + passed;
        let mut now = course.first.clone();
        for (location, velocity) in now.location.iter_mut().zip(&course.velocity) {
            // Bodies outside the crowd move on at constant velocity.
            *location += passed * *velocity;
        }
        for (at, &body) in crowd.bodies.iter().enumerate() {
            now.location[body] = course.states[k].location[at];
            now.velocity[body] = course.states[k].velocity[at];
            now.orientation[body] = course.states[k].orientation[at];
            now.angular_momentum[body] = course.states[k].angular_momentum[at];
        }
        now.accounts = course.states[k].accounts;
        self.advance_part(&mut crowd, course, model, (time, part, 0), &mut now, loads);
        let part = crowd.part_of(&now);
        self.crowd = crowd;
        part
    }

    /// Advances the crowd by `part` seconds from `time`. A substep whose impulses add energy, which no contact can, is repeated in two halves.
    /// `halvings` is the number of halvings so far.
    fn advance_part(
        &self,
        crowd: &mut Crowd,
        course: &SubstepMotion,
        model: &Model,
        (time, part, halvings): (f64, f64, u32),
        now: &mut State,
        loads: &mut Loads,
    ) {
        model.place(time, now);
        let (before, impacts) = (now.clone(), crowd.impacts.len());
        let closed = self.crowd_places(model, now, &course.pairs, (part, crowd.is_all));
        let residual = crowd.advance(closed, model, (time, part), now, loads);
        if residual.is_some_and(|residual| residual.is_excess()) && halvings < MAX_HALVINGS {
            now.clone_from(&before);
            crowd.impacts.truncate(impacts);
            crowd.solver.start_cold();
            crowd.pile.start_cold();
            let half = 0.5 * part;
            self.advance_part(crowd, course, model, (time, half, halvings + 1), now, loads);
            for (i, location) in now.location.iter_mut().enumerate() {
                if !crowd.bodies.contains(&i) {
                    *location += half * course.velocity[i];
                }
            }
            self.advance_part(crowd, course, model, (time + half, half, halvings + 1), now, loads);
            return;
        }
        if let Some(residual) = residual {
            crowd.laws.note(residual);
            if residual.is_broken() {
                crowd.solver.fail(residual.breakdown());
            }
        }
        if !model.constraints().is_empty() {
            crowd.joints.take_contacts_for_sweeps(Vec::new(), model);
            crowd.joints.hold_joints(model, time + part, now);
            crowd.joints.settle(model, time + part, now);
            if let Some(breakdown) = crowd.joints.take_failure() {
                crowd.solver.fail(breakdown);
            }
        }
    }

    /// Returns the pairs of bodies that can meet within `dt` seconds and whose contacts the crowd handles.
    pub(super) fn crowd_pairs(&self, model: &Model, state: &State, dt: f64) -> Vec<Pair> {
        let mut is_in = vec![false; self.solids.len()];
        self.crowd.bodies.iter().for_each(|&body| is_in[body] = true);
        let margin = |i: usize| match &self.solids[i] {
            Some(solid) if is_in[i] => {
                let speed =
                    state.velocity[i].length() + model.angular_velocity(i, state).length() * solid.reach();
                2.0 * speed * dt + 0.1 * solid.size()
            }
            _ => 0.0,
        };
        let margins: Vec<f64> = (0..self.solids.len()).map(margin).collect();
        let is_held = |pair: &Pair| self.crowd.holds(pair.bodies, |body| is_in[body], model);
        match self.pairs.within(&margins) {
            Some(known) => known.iter().filter(|pair| is_held(pair)).cloned().collect(),
            None => {
                let mut pairs = near(&self.contacts, &self.solids, &margins, (model, state));
                pairs.retain(is_held);
                pairs
            }
        }
    }

    /// Returns the bodies of the crowd that are not in free flight, because they are close to other bodies of the crowd or to fixed bodies.
    pub(super) fn leaning(&self, model: &Model, state: &State) -> BTreeSet<usize> {
        let mut all = BTreeSet::new();
        for pair in self.crowd_pairs(model, state, 0.0) {
            let [Some(x), Some(y)] = pair.bodies.map(|body| self.solids[body].as_ref()) else { continue };
            let [p, q] = pair.bodies.map(|body| pose(body, model, state));
            let near = nearest(x, &p, y, &q, f64::INFINITY);
            if near.is_some_and(|near| near.gap <= MAX_CROWD_GAP * self.size(pair.bodies)) {
                all.extend(pair.bodies);
            }
        }
        all
    }

    /// Returns the number of substeps in a step of `dt` seconds: fast bodies need more. If all bodies are in the crowd, those that meet no
    /// other do not count.
    fn parts(&self, model: &Model, state: &State, dt: f64, pairs: &[Pair]) -> f64 {
        let mut is_near = vec![!self.crowd.is_all; self.solids.len()];
        pairs.iter().flat_map(|pair| pair.bodies).for_each(|body| is_near[body] = true);
        let way = |&i: &usize| {
            let (size, reach) =
                self.solids[i].as_ref().map_or((f64::INFINITY, 0.0), |solid| (solid.size(), solid.reach()));
            let speed = state.velocity[i].length() + model.angular_velocity(i, state).length() * reach;
            speed * dt / (MAX_PATH_PER_SUBSTEP * size)
        };
        let counted = self.crowd.bodies.iter().filter(|&&body| is_near[body]);
        counted.map(way).fold(SUBSTEPS_PER_STEP[0], f64::max).min(SUBSTEPS_PER_STEP[1]).ceil()
    }

    /// Returns the possible contacts of the crowd within `part` seconds. If all bodies are in the crowd, no other search finds what approaches
    /// fast, so contacts of any distance count.
    fn crowd_places(
        &self,
        model: &Model,
        state: &State,
        pairs: &[Pair],
        (part, is_all): (f64, bool),
    ) -> Vec<LastingContact> {
        let mut all = Vec::new();
        for pair in pairs {
            let [Some(x), Some(y)] = pair.bodies.map(|body| self.solids[body].as_ref()) else { continue };
            let speed = |i: usize, solid: &Solid| {
                let reach = if solid.reach().is_finite() { solid.reach() } else { 0.0 };
                state.velocity[i].length() + model.angular_velocity(i, state).length() * reach
            };
            let way = 2.0 * part * (speed(pair.bodies[0], x) + speed(pair.bodies[1], y));
            let close = close([x, y]);
            let most = if is_all { way.max(close) } else { 10.0 * close };
            let within = way.clamp(0.1 * close, most);
            let mut places = self.places_within(model, state, pair, [x, y], within);
            // What moves far in a substep could be in another body in the meantime.
            if 0.5 * way <= MAX_MISSING_PATH * self.size(pair.bodies) {
                let comes = |place: &LastingContact| {
                    let [first, second] = velocities(&place.touch.meeting, pair.bodies, (model, state));
                    let rate = (second - first).dot(place.touch.meeting.normal);
                    place.touch.meeting.gap > 0.0 && place.touch.meeting.gap + part * rate < 0.0
                };
                let may_miss =
                    places.iter().any(comes) && self.are_apart_after(part, model, state, pair, [x, y]);
                places.iter_mut().for_each(|place| place.may_miss = may_miss);
            }
            all.extend(places);
        }
        self.without_seams(all, model, state)
    }

    /// Returns true if two bodies do not overlap after a free flight of `part` seconds.
    fn are_apart_after(
        &self,
        part: f64,
        model: &Model,
        state: &State,
        pair: &Pair,
        [x, y]: [&Solid; 2],
    ) -> bool {
        let [p, q] = pair.bodies.map(|body| {
            let Pose { location, orientation } = pose(body, model, state);
            let turn = DQuat::from_scaled_axis(part * model.angular_velocity(body, state));
            Pose {
                location: location + part * state.velocity[body],
                orientation: (turn * orientation).normalize(),
            }
        });
        let closed = PUSHING_CONTACT_TOLERANCE * self.size(pair.bodies);
        nearest(x, &p, y, &q, f64::INFINITY).is_some_and(|near| near.gap >= -closed)
    }

    /// Returns the contacts without those at seams, which stop nothing.
    fn without_seams(
        &self,
        mut all: Vec<LastingContact>,
        model: &Model,
        state: &State,
    ) -> Vec<LastingContact> {
        let places = all.iter().map(|place| (place.bodies, place.touch.meeting)).collect();
        let mut at_seams = self.at_seams(&places, model, state).into_iter();
        all.retain(|_| !at_seams.next().unwrap_or(false));
        all
    }

    /// Returns all contacts of a pair of bodies with gaps below `within`, m.
    fn places_within(
        &self,
        model: &Model,
        state: &State,
        pair: &Pair,
        [x, y]: [&Solid; 2],
        within: f64,
    ) -> Vec<LastingContact> {
        let [p, q] = pair.bodies.map(|body| pose(body, model, state));
        let closed = |touch: Touch| LastingContact {
            bodies: pair.bodies,
            spoke: spoke(&touch.patches, [&p, &q], &touch.meeting),
            touch,
            law: pair.law,
            size: self.size(pair.bodies),
            still: 0.0,
            may_miss: false,
        };
        let hits = |touch: &Touch| {
            let velocities = velocities(&touch.meeting, pair.bodies, (model, state));
            !slide_past([x, y], [&p, &q], &touch.meeting, velocities)
        };
        touches(x, &p, y, &q, within).into_iter().filter(hits).map(closed).collect()
    }

    /// Separates bodies of the crowd that overlap too deeply at the end of a step. Returns the contacts of the crowd.
    ///
    /// # Errors
    ///
    /// Returns a breakdown if two bodies remain jammed after all attempts.
    pub(crate) fn end_course(
        &mut self,
        model: &Model,
        time: f64,
        state: &mut State,
    ) -> Result<Vec<Arc<LastingContact>>, Breakdown> {
        let mut jammed = None;
        for _ in 0..MAX_SEPARATION_ATTEMPTS {
            let (all, deep) = self.touching_in_crowd(model, state, 0.0);
            if deep.is_none() {
                return Ok(self.accept_places(all));
            }
            jammed = deep;
            // What is moved apart must not be moved into its neighbors.
            let (all, _) = self.touching_in_crowd(model, state, MAX_CROWD_GAP);
            let Crowd { pile, solver, .. } = &mut self.crowd;
            if model.constraints().is_empty() {
                pile.take_contacts(all, model, state);
                separate(pile, model, time, state);
            } else {
                let mut jointed = Jointed::of(solver);
                jointed.take_contacts(all, model, time, state);
                separate(&mut jointed, model, time, state);
            }
        }
        if self.crowd.is_all {
            // They overlap by what the bodies at them allow, which the report of the run says.
            let (all, _) = self.touching_in_crowd(model, state, 0.0);
            return Ok(self.accept_places(all));
        }
        let bodies = jammed.unwrap_or_default().map(BodyId::new);
        Err(Breakdown::Jammed { bodies, time })
    }

    /// Returns the contacts of the crowd, and two bodies that overlap too deeply, if there are any. Points with a gap below `near`, as a
    /// fraction of the smaller body's size, count as contacts, too.
    pub(super) fn touching_in_crowd(
        &self,
        model: &Model,
        state: &State,
        near: f64,
    ) -> (Vec<LastingContact>, Option<[usize; 2]>) {
        let (mut all, mut deep) = (Vec::new(), None);
        for pair in self.crowd_pairs(model, state, 0.0) {
            let [Some(x), Some(y)] = pair.bodies.map(|body| self.solids[body].as_ref()) else { continue };
            let size = self.size(pair.bodies);
            let within = self.touching_gap(pair.bodies, model, state).max(near * size);
            let places = self.places_within(model, state, &pair, [x, y], within);
            if places.iter().any(|place| place.touch.meeting.gap < -JAMMED_OVERLAP * size) {
                deep = Some(pair.bodies);
            }
            all.extend(places);
        }
        let all = self.without_seams(all, model, state);
        (all, deep)
    }
}

impl Collider {
    /// Returns the gap up to which two bodies touch, m.
    pub(super) fn touching_gap(&self, bodies: [usize; 2], model: &Model, state: &State) -> f64 {
        if self.crowd.pushing.binary_search(&bodies).is_ok() {
            return PUSHING_CONTACT_TOLERANCE * self.size(bodies);
        }
        let [Some(x), Some(y)] = bodies.map(|body| self.solids[body].as_ref()) else { return 0.0 };
        ContactScale::of(bodies, [x, y], (model, state)).tolerance(CONTACT_TOLERANCE)
    }
}

impl Crowd {
    /// Extracts the part of a state that belongs to the crowd, with one entry for each body.
    fn part_of(&self, state: &State) -> State {
        State {
            location: self.bodies.iter().map(|&i| state.location[i]).collect(),
            velocity: self.bodies.iter().map(|&i| state.velocity[i]).collect(),
            orientation: self.bodies.iter().map(|&i| state.orientation[i]).collect(),
            angular_momentum: self.bodies.iter().map(|&i| state.angular_momentum[i]).collect(),
            accounts: state.accounts,
        }
    }
}
