//! A step in pieces that end at events: where bodies touch, a rope becomes taut, a limit is reached, or a motor has its speed.

use std::collections::BTreeSet;

use super::World;
use super::event::Event;
use crate::dynamics::{BodyId, Breakdown, System};

/// Trials until the time of an event is known to the last bit; each halves what is left at least every second time.
const TRIALS: usize = 120;

/// Times that differ by less than this part of a step are the same.
const INSTANT: f64 = 1e-13;

/// Trials until two bodies touch; each squares what is left.
const TOUCHES: usize = 12;

impl World {
    /// Makes a step of `dt` from time `t` (s), or up to the first event within it. Gives how long it has been, and the event.
    /// Where there can be events, `before` is the state at its beginning.
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

    /// Makes a step that has just been made anew where bodies touch within it, so that it ends there.
    fn find_touch(&mut self, t: f64, dt: f64) -> Option<(f64, [usize; 2])> {
        let Self { model, state, before, solver, collider, .. } = self;
        let (first, bodies) =
            collider.as_mut()?.first_touch(model, (before, state), dt, solver.contacts())?;
        // They part until `early` or later, and come nearer at `late`: a rebound can be lower than a rounding of the gap.
        let (mut early, mut late, mut length) = (0.0, first, first);
        for _ in 0..TOUCHES {
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

    /// The gap of two bodies and its rate, as [`Collider::gap`](crate::dynamics::contact::Collider::gap) has them.
    fn gap(&self, bodies: [usize; 2]) -> Option<(f64, f64)> {
        self.collider.as_ref()?.gap(&self.model, &self.state, bodies)
    }

    /// An event: takes its impulses, and finds out which constraints push from then on. Returns whether it was a touch that struck nothing.
    pub(super) fn pass(&mut self, event: Event, t: f64) -> bool {
        match event {
            Event::Row(row) => self.solver.note_change(&self.model, row),
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

    /// Bodies touch, or part: strikes those that come nearer, and finds out which stay in touch. Where no forces are found that fit, the
    /// bodies are advanced by time-stepping. Returns whether something was struck.
    pub(super) fn meet(&mut self, t: f64, is_touch: bool) -> bool {
        let has_struck = self.meet_once(t, is_touch, true);
        self.crowd_undecided(t);
        has_struck
    }

    /// The same for bodies that come to rest: finds out what all contacts do, also those of heaps.
    pub(super) fn meet_at_rest(&mut self, t: f64) {
        self.meet_once(t, false, false);
        self.crowd_undecided(t);
    }

    /// Finds out what contacts do of which nothing else is known.
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
            // What holds bodies has nothing to do with it.
            return has_struck;
        }
        self.decide(t);
        if have_changed {
            // A gap that is left would be closed within the next step, however short that is.
            self.solver.close_gaps(&self.model, t, &mut self.state);
        }
        has_struck
    }

    /// Where contacts begin: nothing may be within another, and what touches is struck or stays in touch.
    pub(super) fn begin_contacts(&mut self) {
        let Some(collider) = &mut self.collider else { return };
        let closed = self.solver.contacts();
        if let Some(breakdown) = collider.start(&self.model, self.time, &self.state, closed) {
            self.solver.fail(breakdown);
            return;
        }
        self.meet(self.time, false);
    }

    /// Notes that a run cannot go on, since something happens again and again.
    pub(super) fn give_up(&mut self, event: Event, time: f64) {
        match event {
            Event::Row(row) => self.solver.give_up(&self.model, row, time),
            Event::Touch(bodies) => {
                self.solver.fail(Breakdown::Jammed { bodies: bodies.map(BodyId::new), time });
            }
        }
    }

    /// Makes a step of all bodies as the forces and the constraints move them.
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
        // More places of bodies that touch: they have no row of their own.
        let places = collider.margin(&self.model, &self.state, self.solver.contacts()) + 1.0;
        if places < margin.0 { (places, margin.1) } else { margin }
    }

    /// Makes the step shorter until it ends just after the event: the margin at its end is a function of its length, of which the
    /// root is found by the Illinois method with bisections. Source: M. Dowell & P. Jarratt, BIT 11 (1971) 168.
    fn find_event(&mut self, t: f64, end: (f64, f64, usize)) -> (f64, usize) {
        let (mut early, mut early_margin) = (0.0, 1.0);
        let (mut late, mut late_margin, mut row) = end;
        let (mut width, mut was_late) = (late, None);
        // An end that stays a second time counts half.
        let mut weights = [1.0; 2];
        let mut later: Option<(f64, f64)> = None;
        for trial in 0..TRIALS {
            // An event that is over by what is tolerated is found.
            if late_margin >= -1.0 {
                break;
            }
            let middle = 0.5 * (early + late);
            // Where the last three trials have not halved what is left, this one does.
            let is_slow = trial % 3 == 2 && late - early > 0.5 * std::mem::replace(&mut width, late - early);
            let (a, b) = (weights[0] * early_margin, weights[1] * late_margin);
            let secant = (early * b - late * a) / (b - a);
            // A place that has not been there before appears with its event: only what is late tells when that is.
            let beyond = later.filter(|_| trial % 3 == 0).map(|(length, margin)| {
                let slope = (margin - late_margin) / (length - late);
                let root = late - (late_margin + 0.5) / slope;
                if early == 0.0 && (root.is_nan() || root <= 0.0) { 0.5 * INSTANT * end.0 } else { root }
            });
            let length = match beyond {
                Some(beyond) if beyond > early && beyond < late => beyond,
                _ if is_slow || !(secant > early && secant < late) => middle,
                _ => secant,
            };
            if length <= early || length >= late || late - early <= INSTANT * end.0 {
                break;
            }
            let (margin, at) = self.try_piece(t, length);
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
        // What happens at once has nothing before it.
        let length = if late <= INSTANT * end.0 { 0.0 } else { late };
        self.try_piece(t, length);
        (length, row)
    }

    /// The state `dt` after the beginning of the piece, made by one step; its margin.
    fn try_piece(&mut self, t: f64, dt: f64) -> (f64, usize) {
        self.try_step(t, dt);
        self.margin(t + dt)
    }

    /// The state `dt` after the beginning of the piece, made by one step.
    fn try_step(&mut self, t: f64, dt: f64) {
        self.state.take_over(&self.before, self.model.in_focus());
        if dt == 0.0 {
            return;
        }
        self.integrator.discontinuity();
        // What went wrong in a step that was too long does not count.
        self.solver.take_failure();
        self.make_step(t, dt);
    }
}
