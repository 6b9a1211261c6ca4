//! A step in pieces that end at events: bodies touch, a rope becomes taut, a joint reaches its limit, or a motor reaches its speed.

use std::collections::BTreeSet;

use super::World;
use super::event::Event;
use crate::{BodyId, Breakdown, System};

/// The largest number of trials to find the time of an event to the last bit. The interval is halved often enough that they suffice.
const MAX_EVENT_TRIALS: usize = 120;

/// The margin of an event in the middle of its tolerance, as a multiple of the tolerance.
const MIDDLE_MARGIN: f64 = -0.5;

/// The search for the middle ends when the margin is this near to it.
const NEAR_MIDDLE: f64 = 1e-3;

/// The largest number of steps of the search for the middle.
const MIDDLE_TRIALS: usize = 3;

/// Times count as equal if they differ by at most this fraction of the step.
const TIME_TOLERANCE: f64 = 1e-13;

/// The largest number of iterations to find the time at which two bodies touch. Each iteration squares the relative error of this time.
const MAX_TOUCH_ITERATIONS: usize = 12;

/// Moreau's scheme moves bodies apart that overlap by at most this fraction of the smaller one's size when they appear.
const MOVED_APART: f64 = 0.1;

impl World {
    /// Makes a step of `dt` from time `t` (s), or a shorter one that ends at the first event. Returns the length of the step, s, and the
    /// event. If events are possible, `before` holds the state at the start of the step.
    pub(super) fn make_piece(&mut self, t: f64, dt: f64) -> (f64, Option<Event>) {
        let has_events = System::new(&self.model, &mut self.solver).has_events();
        if !has_events && self.collider.is_none() {
            self.make_step(t, dt);
            return (dt, None);
        }
        self.before.take_over(&self.state, self.model.in_focus());
        self.make_step(t, dt);
        let touched = self.find_touch(t, dt);
        let length = touched.map_or(dt, |(length, _)| length);
        let touch = touched.map(|(_, bodies)| Event::Touch(bodies));
        if !has_events {
            return (length, touch);
        }
        let (margin, row) = self.margin(t + length);
        if margin >= 0.0 {
            return (length, touch);
        }
        let (length, row) = self.find_event(t, (length, margin, row));
        (length, Some(Event::Row(row)))
    }

    /// Searches the last step for the first touch of two bodies, and repeats the step so that it ends there. Returns the length of the
    /// shortened step, s, and the bodies; `None` without a touch.
    fn find_touch(&mut self, t: f64, dt: f64) -> Option<(f64, [usize; 2])> {
        let Self { model, state, before, solver, collider, .. } = self;
        let (first, bodies) =
            collider.as_mut()?.first_touch(model, (before, state), dt, solver.contacts())?;
        // At `early` the bodies still separate; at `late` they approach. The rate of the gap tells which is the case. The gap itself
        // cannot, because a rebound can be lower than the rounding error of the gap.
        let (mut early, mut late, mut length) = (0.0, first, first);
        for _ in 0..MAX_TOUCH_ITERATIONS {
            self.try_step(t, length);
            let Some((gap, rate)) = self.gap(bodies) else { break };
            let next = if rate < 0.0 {
                late = length;
                let next = (length + gap / -rate).min(dt);
                if next > early { next } else { 0.5 * (early + late) }
            } else if length < late {
                early = length;
                0.5 * (early + late)
            } else {
                length
            };
            if next == length {
                return Some((length, bodies));
            }
            length = next;
        }
        self.try_step(t, late);
        Some((late, bodies))
    }

    /// Returns the gap of two bodies, m, and its rate, m/s, as [`Collider::gap`](crate::contact::Collider::gap) defines them.
    fn gap(&self, bodies: [usize; 2]) -> Option<(f64, f64)> {
        self.collider.as_ref()?.gap(&self.model, &self.state, bodies)
    }

    /// Handles an event: applies its impulses, and decides which constraints are active from then on. Returns true for a touch without an
    /// impact.
    pub(super) fn pass(&mut self, event: Event, t: f64) -> bool {
        match event {
            Event::Row(_) => {}
            Event::Touch(bodies) => {
                self.let_go(&bodies);
            }
        }
        if self.collider.is_some() {
            let is_touch = matches!(event, Event::Touch(_));
            let has_struck = self.meet(t, is_touch);
            return is_touch && !has_struck;
        }
        let mut system = System::new(&self.model, &mut self.solver);
        system.decide(t, &mut self.state, &mut self.loads);
        false
    }

    /// Handles bodies that touch or separate: applies impacts to bodies that approach, and finds contacts that last. If no consistent
    /// forces exist, Moreau's scheme advances the bodies. Returns true if there was an impact.
    pub(super) fn meet(&mut self, t: f64, is_touch: bool) -> bool {
        if self.is_stepped() {
            // Moreau's scheme handles all contacts in the next step.
            return false;
        }
        let has_struck = self.meet_once(t, is_touch, true);
        self.crowd_undecided(t);
        has_struck
    }

    /// Handles bodies that come to rest: decides the modes of all contacts, including those of heaps, which do not return to Moreau's
    /// scheme.
    pub(super) fn meet_at_rest(&mut self, t: f64) {
        if self.is_stepped() {
            return;
        }
        self.meet_once(t, false, false);
        self.crowd_undecided(t);
    }

    /// Decides the modes of all contacts at time `t`, s. If no consistent modes exist for some bodies, Moreau's scheme advances these.
    pub(super) fn decide_contacts(&mut self, t: f64) {
        self.is_decided = true;
        self.decide(t);
        self.crowd_undecided(t);
    }

    fn crowd_undecided(&mut self, t: f64) {
        while let Some(bodies) = self.solver.take_undecided(&self.model) {
            let Some(collider) = &mut self.collider else { break };
            if self.solver.has_failed() || !collider.join(&self.model, &self.state, &bodies) {
                break;
            }
            self.meet_once(t, false, true);
        }
    }

    fn decide(&mut self, t: f64) {
        while !self.solver.is_idle(&self.model) {
            let mut system = System::new(&self.model, &mut self.solver);
            system.decide(t, &mut self.state, &mut self.loads);
            if !self.solver.drop_open_contacts(&self.model) {
                break;
            }
        }
    }

    fn meet_once(&mut self, t: f64, is_touch: bool, are_heaps_crowded: bool) -> bool {
        self.is_decided = true;
        while self.let_touched_go() {}
        let Some(collider) = &mut self.collider else { return false };
        if are_heaps_crowded {
            collider.crowd_known_heaps(&self.model, &self.state, self.solver.contacts());
        }
        let is_crowded = collider.is_crowded();
        self.solver.leave(&BTreeSet::new());
        let strike = match collider.strike(&self.model, t, &mut self.state, &mut self.solver) {
            Ok(strike) => strike,
            Err(breakdown) => {
                self.solver.fail(breakdown);
                return false;
            }
        };
        let has_struck = !strike.struck.is_empty();
        let have_changed = self.solver.take_contacts(strike.closed);
        self.solver.leave(collider.crowded());
        if is_touch && !have_changed && !is_crowded && !self.solver.concerns(&strike.struck) {
            // The bodies that were hit have no constraints, so no modes have to be decided.
            return has_struck;
        }
        self.decide(t);
        if have_changed {
            // Any remaining gap is closed now, because it would otherwise close within the next step, which may be very short.
            self.solver.close_gaps(&self.model, t, &mut self.state);
        }
        has_struck
    }

    /// Starts contacts at the current state. Overlapping bodies are an error; touching bodies have impacts or stay in contact. Moreau's scheme
    /// moves bodies apart that overlap a little.
    pub(super) fn begin_contacts(&mut self) {
        let part = if self.is_stepped() { MOVED_APART } else { 0.0 };
        let Some(collider) = &mut self.collider else { return };
        let closed = self.solver.contacts();
        if let Some(breakdown) = collider.start(&self.model, (self.time, &self.state), closed, part) {
            self.solver.fail(breakdown);
            return;
        }
        self.meet(self.time, false);
    }

    /// Reports that the run cannot continue, because an event occurs endlessly.
    pub(super) fn give_up(&mut self, event: Event, time: f64) {
        match event {
            Event::Row(row) => self.solver.give_up(&self.model, row, time),
            Event::Touch(bodies) => {
                self.solver.fail(Breakdown::Jammed { bodies: bodies.map(BodyId::new), time });
            }
        }
    }

    /// Makes a step of all bodies under forces and constraints, without searching for events.
    pub(super) fn fly(&mut self, t: f64, dt: f64) {
        let mut system = System::new(&self.model, &mut self.solver);
        system.set_out(t, dt, &self.state);
        self.integrator.advance(&mut system, t, dt, &mut self.state);
        system.settle(t + dt, &mut self.state);
        self.steps += 1;
    }

    pub(super) fn make_step(&mut self, t: f64, dt: f64) {
        self.fly(t, dt);
        let rest = self.end - (t + dt);
        let Self { model, state, before, collider: Some(collider), loads, .. } = self else { return };
        if let Some(breakdown) = collider.advance_crowd(model, (t, dt, rest), (before, state), loads) {
            self.solver.fail(breakdown);
        }
    }

    fn margin(&mut self, t: f64) -> (f64, usize) {
        let margin = System::new(&self.model, &mut self.solver).margin(t, &self.state, &mut self.loads);
        let Some(collider) = &self.collider else { return margin };
        // Touching bodies can get further contact points, which have no constraint rows yet.
        let places = collider.margin(&self.model, &self.state, self.solver.contacts()) + 1.0;
        if places < margin.0 { (places, margin.1) } else { margin }
    }

    /// Shortens the step until it ends just after the event. The margin to the event is a function of the step's length; its root is found
    /// by the Illinois method with bisections. Source: M. Dowell & P. Jarratt, BIT 11 (1971) 168.
    fn find_event(&mut self, t: f64, end: (f64, f64, usize)) -> (f64, usize) {
        let (mut early, mut early_margin) = (0.0, 1.0);
        let (mut late, mut late_margin, mut row) = end;
        let (mut width, mut was_late) = (late, None);
        // If a trial leaves the same end of the interval unchanged as the trial before, the weight of this end is halved.
        let mut weights = [1.0; 2];
        let mut later: Option<(f64, f64)> = None;
        let mut tried = f64::NAN;
        for trial in 0..MAX_EVENT_TRIALS {
            // The search ends when the margin is within the tolerance.
            if late_margin >= -1.0 {
                break;
            }
            let middle = 0.5 * (early + late);
            // If the interval has not been halved in the last three trials, this trial halves it.
            let is_slow = trial % 3 == 2 && late - early > 0.5 * std::mem::replace(&mut width, late - early);
            let (a, b) = (weights[0] * early_margin, weights[1] * late_margin);
            let secant = (early * b - late * a) / (b - a);
            // A new contact point exists only after its event, so only states after the event give its time.
            let beyond = later.filter(|_| trial % 3 == 0).map(|(length, margin)| {
                let slope = (margin - late_margin) / (length - late);
                let root = late - (late_margin + 0.5) / slope;
                if early == 0.0 && (root.is_nan() || root <= 0.0) {
                    0.5 * TIME_TOLERANCE * end.0
                } else {
                    root
                }
            });
            let length = match beyond {
                Some(beyond) if beyond > early && beyond < late => beyond,
                _ if is_slow || !(secant > early && secant < late) => middle,
                _ => secant,
            };
            if length <= early || length >= late || late - early <= TIME_TOLERANCE * end.0 {
                break;
            }
            let (margin, at) = self.try_piece(t, length);
            tried = length;
            let is_late = margin < 0.0;
            if is_late {
                later = Some((late, late_margin));
                (late, late_margin, row) = (length, margin, at);
            } else {
                (early, early_margin) = (length, margin);
            }
            let halved = if was_late == Some(is_late) { 0.5 } else { 1.0 };
            weights[usize::from(is_late)] = 1.0;
            weights[usize::from(!is_late)] *= halved;
            was_late = Some(is_late);
        }
        // Any moment within the tolerance would do, but which one the search meets depends on rounding errors. In the middle of the tolerance,
        // the moment of the event is as exact as the margin.
        let mut other = later.filter(|(_, margin)| early == 0.0 || -margin < early_margin);
        if other.is_none() && early > 0.0 {
            other = Some((early, early_margin));
        }
        for _ in 0..MIDDLE_TRIALS {
            let Some((length, margin)) =
                other.filter(|_| late_margin >= -1.0 && late > TIME_TOLERANCE * end.0)
            else {
                break;
            };
            let next = late + (MIDDLE_MARGIN - late_margin) * (late - length) / (late_margin - margin);
            if (late_margin - MIDDLE_MARGIN).abs() < NEAR_MIDDLE || !(next > early && next < end.0) {
                break;
            }
            let (margin, at) = self.try_piece(t, next);
            tried = next;
            if !(-1.0..0.0).contains(&margin) {
                break;
            }
            other = Some((late, late_margin));
            (late, late_margin, row) = (next, margin, at);
        }
        // An event at the start of the step ends a piece of length 0.
        let length = if late <= TIME_TOLERANCE * end.0 { 0.0 } else { late };
        if tried != length {
            self.try_piece(t, length);
        }
        (length, row)
    }

    /// Advances from the start of the piece by one step of `dt` seconds. Returns the margin to the next event there, and the constraint
    /// row of this event.
    fn try_piece(&mut self, t: f64, dt: f64) -> (f64, usize) {
        self.try_step(t, dt);
        self.margin(t + dt)
    }

    /// Sets the state to that after one step of `dt` seconds from the start of the piece.
    fn try_step(&mut self, t: f64, dt: f64) {
        self.state.take_over(&self.before, self.model.in_focus());
        // Failures in an earlier trial step that was too long do not count.
        self.solver.take_failure();
        if dt == 0.0 {
            return;
        }
        self.integrator.discontinuity();
        self.make_step(t, dt);
    }
}
