//! A step in pieces that end at events: where bodies touch, a rope becomes taut, a limit is reached, or a motor has its speed.

use super::World;
use crate::dynamics::{BodyId, Breakdown, System};

/// So many changes of constraints within a step mean that they do not end.
const CHANGES: u32 = 10_000;

/// So many impacts within a step mean the same. The impacts that spell π to seven digits are fewer, nearly all in one step.
const IMPACTS: u32 = 4_000_000;

/// After so many at the same instant, two bodies that touch without coming nearer are left alone until the next step.
const STAY: u32 = 20;

/// So many events at the same instant mean the same: each settles what touches then.
const AT_ONCE: u32 = 1_000;

/// Trials until the time of an event is known to the last bit; each halves what is left at least every second time.
const TRIALS: usize = 120;

/// Events within this part of a step are at its beginning.
const INSTANT: f64 = 1e-13;

/// Trials until two bodies touch; each squares what is left.
const TOUCHES: usize = 12;

/// What ends a piece of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Event {
    /// A row of the constraints changes what it does.
    Row(usize),
    /// Two bodies touch.
    Touch([usize; 2]),
}

/// How many events there have been within a step.
#[derive(Default)]
pub(super) struct Counts {
    changes: u32,
    impacts: u32,
    /// Those one after another at the same instant.
    at_once: u32,
}

impl Counts {
    /// Whether a touch happens again and again at the same instant.
    pub(super) fn stay(&self) -> bool {
        self.at_once > STAY
    }

    /// Counts one more, at the end of a piece that has been so long, s, and says whether that is too many.
    pub(super) fn are_too_many(&mut self, event: Event, length: f64) -> bool {
        self.at_once = if length > 0.0 { 0 } else { self.at_once + 1 };
        match event {
            Event::Row(_) => self.changes += 1,
            Event::Touch(_) => self.impacts += 1,
        }
        self.changes > CHANGES || self.impacts > IMPACTS || self.at_once > AT_ONCE
    }
}

impl World {
    /// Makes a step of `dt` from time `t` (s), or up to the first event within it. Gives how long it has been, and the event.
    /// Where there can be events, `before` is the state at its beginning.
    pub(super) fn make_piece(&mut self, t: f64, dt: f64) -> (f64, Option<Event>) {
        let has_events = System::new(&self.model, &mut self.solver).has_events();
        if !has_events && self.collider.is_none() {
            self.make_step(t, dt);
            return (dt, None);
        }
        self.before.clone_from(&self.state);
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

    /// An event: takes its impulses, and finds out which constraints push from then on.
    pub(super) fn pass(&mut self, event: Event, t: f64) {
        if let Event::Row(row) = event {
            self.solver.note_change(&self.model, row);
        }
        if self.collider.is_some() {
            self.meet(t, matches!(event, Event::Touch(_)));
        } else {
            let mut system = System::new(&self.model, &mut self.solver);
            system.decide(t, &mut self.state, &mut self.loads);
        }
    }

    /// Bodies touch, or part: strikes those that come nearer, and finds out which stay in touch.
    fn meet(&mut self, t: f64, is_touch: bool) {
        let Some(collider) = &mut self.collider else { return };
        let strike = match collider.strike(&self.model, t, &mut self.state, &mut self.solver) {
            Ok(strike) => strike,
            Err(breakdown) => {
                self.solver.fail(breakdown);
                return;
            }
        };
        let have_changed = self.solver.take_contacts(strike.closed);
        if is_touch && !have_changed && !self.solver.concerns(&strike.struck) {
            // What holds bodies has nothing to do with it.
            return;
        }
        while !self.solver.is_idle(&self.model) {
            let mut system = System::new(&self.model, &mut self.solver);
            system.decide(t, &mut self.state, &mut self.loads);
            if !self.solver.drop_open_contacts(&self.model) {
                break;
            }
        }
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

    fn make_step(&mut self, t: f64, dt: f64) {
        let mut system = System::new(&self.model, &mut self.solver);
        system.set_out(t, dt, &self.state);
        self.integrator.advance(&mut system, t, dt, &mut self.state);
        system.settle(t + dt, &mut self.state);
        self.steps += 1;
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
            let length = if is_slow || !(secant > early && secant < late) { middle } else { secant };
            if length <= early || length >= late || late <= INSTANT * end.0 {
                break;
            }
            let (margin, at) = self.try_piece(t, length);
            let is_late = margin < 0.0;
            if is_late {
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
        self.state.clone_from(&self.before);
        if dt == 0.0 {
            return;
        }
        self.integrator.discontinuity();
        // What went wrong in a step that was too long does not count.
        self.solver.take_failure();
        self.make_step(t, dt);
    }
}
