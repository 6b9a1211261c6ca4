//! Advancing a world in time: steps, births and deaths of bodies, and snapshots within steps.

use super::super::{Snapshot, State, Step, System};
use super::event::Counts;
use super::snapshot::picture;
use super::{World, laws_of};

/// An interval that exceeds a whole number of steps by less than this fraction gets no further step. Decimal fractions have rounding
/// errors, but 0.1 s must still be ten steps of 0.01 s.
const STEP_TOLERANCE: f64 = 1e-9;

/// A step ends at a sudden change of a given velocity if less than this fraction of it is left.
const SHORTEST_REMAINDER: f64 = 1e-11;

/// The largest number of sudden changes of given velocities in a step that end a piece of it.
const MAX_JUMPS: u32 = 100;

/// Returns the smallest number of equal steps that divide an interval (s), if no step may exceed `longest` (s). At least 1, at most
/// `u32::MAX`.
pub(in super::super) fn steps_of(interval: f64, longest: f64) -> u32 {
    let steps = (interval / longest * (1.0 - STEP_TOLERANCE)).ceil();
    // The conversion saturates, so the result is valid for every number and for NaN.
    (steps as u32).max(1)
}

impl World {
    /// Returns the number of equal steps that [`advance_to`](Self::advance_to) makes in an interval (s): the smallest that respects the
    /// longest allowed step. At least 1, at most `u32::MAX`.
    #[must_use]
    pub fn steps_within(&self, interval: f64) -> u32 {
        steps_of(interval, self.step)
    }

    /// Makes one step of `dt` seconds, of any length. Births and deaths of bodies within it take effect at its end.
    pub fn step(&mut self, dt: f64) {
        self.depart();
        self.step_from(self.time, dt, &[], &mut |_| {});
        self.time += dt;
        self.arrive();
    }

    fn step_from(&mut self, t: f64, dt: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) {
        self.settle();
        if self.solver.has_failed() {
            // The run ends here. A further step would forget why.
            return;
        }
        self.ledger.close(&self.model, t, &self.state);
        self.end = t + dt;
        self.solver.expect_step(dt);
        self.check_rest(t);
        if self.is_stepped() {
            self.step_by_moreau(t, dt, moments, see);
            self.hold_still(t + dt, dt);
            return;
        }
        self.is_sudden = self.next_jump(t, dt).is_some();
        if !self.step_apart(t, dt, moments, see) {
            self.decide_all(t);
            self.follow_events(t, dt, moments, see);
        }
        self.hold_still(t + dt, dt);
    }

    /// Makes a step of `dt` seconds in pieces that end at events, such as impacts. Calls `see` with a snapshot at each of `moments`.
    pub(super) fn follow_events(&mut self, t: f64, dt: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) {
        let (mut now, mut left, mut length) = (t, moments, dt);
        let (mut counts, mut jumps) = (Counts::default(), 0);
        if let Some(collider) = &mut self.collider {
            collider.set_out();
            if collider.is_crowded() {
                while self.let_touched_go() {}
            }
            if self.collider.as_mut().is_some_and(|collider| collider.stay(&self.model, &self.state, dt)) {
                self.meet(t, false);
            }
        }
        self.crowd_strained(t);
        loop {
            if !left.is_empty() {
                self.before.clone_from(&self.state);
            }
            let jump = if self.is_sudden && jumps < MAX_JUMPS { self.next_jump(now, length) } else { None };
            let (mut duration, mut event) = (0.0, None);
            let moves = jump.is_none_or(|jump| jump.before > 0.0);
            if moves {
                let rubbed = self.state.accounts.friction;
                (duration, event) = self.make_piece(now, jump.map_or(length, |jump| jump.before.min(length)));
                if self.is_unsolved(now + duration) && self.go_back(now) {
                    continue;
                }
                self.solver.accept();
                if let Some(collider) = &mut self.collider {
                    collider.note_ways(&self.model, &self.before, &self.state, duration);
                    collider.note_rebounds(now + duration);
                    if let Some((bodies, _)) = self.solver.hardest_contact() {
                        collider.note_friction(&self.model, &self.state, rubbed, (bodies, now + duration));
                    }
                }
                self.solver.blame_friction(&self.model, now + duration);
            }
            // An event ends this part of the step, or else a jump. If there is neither, the whole step is done.
            let Some(end) = event.map(|_| duration).or(jump.map(|jump| jump.after)) else {
                self.look_within(now, duration, left, see);
                self.disperse(t + dt);
                return;
            };
            if moves {
                let (within, later) = left.split_at(left.partition_point(|&moment| moment <= now + end));
                left = later;
                self.look_within(now, duration, within, see);
            }
            now += end;
            length = t + dt - now;
            let Some(event) = event else {
                jumps += 1;
                jump.into_iter().for_each(|jump| self.pass_jump(jump, now));
                if length <= SHORTEST_REMAINDER * dt || self.solver.has_failed() {
                    self.disperse(t + dt);
                    return;
                }
                continue;
            };
            let bodies = self.bodies_of(event);
            let are_restless = self.pair_of(event).is_some_and(|pair| counts.are_restless(pair));
            let is_idle = self.pass(event, now);
            self.integrator.discontinuity();
            let are_too_many = counts.are_too_many(event, duration, length, is_idle);
            let heap = self.heap_of(event, &bodies);
            if !heap.is_empty() {
                self.crowd(now, &heap);
            } else if are_restless
                || counts.is_crowded(event)
                || self.happens_too_often(event)
                || self.is_in_crowd(event)
            {
                self.crowd(now, &bodies);
            }
            if are_too_many || self.solver.has_failed() {
                self.give_up(event, now);
                return;
            }
        }
    }

    /// Advances the world to time `t`, s. Afterwards [`time`](Self::time) is exactly `t`. Time cannot go back: a `t` that is not later (or
    /// not finite) changes nothing.
    pub fn advance_to(&mut self, t: f64) {
        self.advance_seeing(t, &[], &mut |_| {});
    }

    pub(super) fn advance_seeing(&mut self, t: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) {
        if !(t > self.time && t.is_finite()) {
            return;
        }
        if self.calendar.next().is_none_or(|next| next > t) {
            self.advance_evenly(t, moments, see);
        } else if self.model.is_given() {
            // If all motions are given, intermediate steps are not needed. With one step for each birth, the time would grow with the
            // square of the number of bodies. The snapshots are taken from a copy of the world, which advances to each moment.
            let mut copy = None;
            for &moment in moments {
                let ahead = copy.get_or_insert_with(|| self.clone());
                ahead.advance_through(moment);
                see(ahead.peek());
            }
            self.advance_through(t);
        } else {
            self.advance_by_events(t, moments, see);
        }
    }

    /// Advances to time `t`, s, in intervals that end at each birth or death of a body.
    fn advance_by_events(&mut self, t: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) {
        let mut left = moments;
        while self.time < t {
            self.depart();
            let leg = self.calendar.leg(t, left);
            left = leg.later;
            self.advance_evenly(leg.end, leg.within, see);
            self.arrive();
            leg.at_end.iter().for_each(|_| see(self.peek()));
        }
    }

    /// Advances to time `t`, s, without intermediate births and deaths: all of them take effect at the end.
    fn advance_through(&mut self, t: f64) {
        self.depart();
        self.advance_evenly(t, &[], &mut |_| {});
        self.arrive();
    }

    /// Removes the bodies that die at the current time, before time goes on.
    fn depart(&mut self) {
        let due = self.calendar.depart(self.time);
        self.change(&due);
    }

    /// Adds the bodies that are born at the time just reached.
    fn arrive(&mut self) {
        let due = self.calendar.arrive(self.time);
        self.change(&due);
        // The change is settled at once, so the energy ledger does not depend on whether this moment is observed.
        self.settle();
        self.ledger.close(&self.model, self.time, &self.state);
    }

    fn change(&mut self, due: &[(usize, bool)]) {
        if due.is_empty() {
            return;
        }
        let bodies: Vec<usize> = due.iter().map(|(body, _)| *body).collect();
        self.let_held_by_go(&bodies);
        self.about_to_change_some();
        if let Some(collider) = &mut self.collider {
            collider.forget_bodies(&bodies);
        }
        self.model.let_come_and_go(due, &mut self.state);
    }

    /// Returns a snapshot of the current moment without changing the energy ledger.
    fn peek(&mut self) -> Snapshot {
        let balance = self.ledger.peek(&self.model, self.time, &self.state);
        let mut copy = self.decided();
        let World { model, state, solver, rest, crowd, collider, loads, time, .. } =
            copy.as_mut().unwrap_or(self);
        let laws = laws_of(collider.as_ref());
        picture(&mut System::new(model, solver), *time, state, (balance, rest, crowd, laws), loads)
    }

    fn advance_evenly(&mut self, t: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) {
        let interval = t - self.time;
        let start = self.time;
        let steps = self.steps_within(interval);
        let dt = interval / f64::from(steps);
        let mut left = moments;
        let mut reached = start;
        for k in 0..steps {
            // Each time is computed from the start. Adding dt repeatedly would add up rounding errors.
            let begin = start + f64::from(k) * dt;
            let end = if k + 1 == steps { t } else { start + f64::from(k + 1) * dt };
            reached = begin + dt;
            let (within, later) = left.split_at(left.partition_point(|&moment| moment <= end));
            left = later;
            self.step_from(begin, dt, within, see);
        }
        self.time = t;
        // Bodies with a given motion are placed for the exact time, without the rounding error of the steps.
        if reached.to_bits() != t.to_bits() {
            self.model.place(t, &mut self.state);
        }
    }

    /// Calls `see` with a snapshot at each of these moments within the last step, which began at `start` and took `duration` seconds.
    fn look_within(&mut self, start: f64, duration: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) {
        if moments.is_empty() {
            return;
        }
        let Self { model, state, integrator, solver, ledger, loads, before, rest, crowd, collider, .. } =
            self;
        let laws = laws_of(collider.as_ref());
        let step = Step { model, start, duration, before, after: state };
        let mut system = System::new(model, solver);
        let dense = integrator.dense(&mut system, step);
        let mut within = State::default();
        for &time in moments {
            dense.at(time, &mut within);
            if system.is_constrained() {
                system.settle(time, &mut within);
            }
            let balance = ledger.peek(model, time, &within);
            see(picture(&mut system, time, &within, (balance, rest, crowd, laws), loads));
        }
    }
}
