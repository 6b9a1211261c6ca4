//! A step in pieces that end at events: where a rope becomes taut, a limit is reached, or a motor has its speed.

use super::World;
use crate::dynamics::System;

/// So many events within a step mean that they do not end.
pub(super) const EVENTS: usize = 10_000;

/// Trials until the time of an event is known to the last bit; each halves what is left at least every second time.
const TRIALS: usize = 120;

impl World {
    /// Makes a step of `dt` from time `t` (s), or up to the first event within it. Gives how long it has been, and the row of
    /// the event. Where there can be events, `before` is the state at its beginning.
    pub(super) fn make_piece(&mut self, t: f64, dt: f64) -> (f64, Option<usize>) {
        if !System::new(&self.model, &mut self.solver).has_events() {
            self.make_step(t, dt);
            return (dt, None);
        }
        self.before.clone_from(&self.state);
        self.make_step(t, dt);
        let (margin, row) = self.margin(t + dt);
        if margin >= 0.0 {
            return (dt, None);
        }
        let (dt, row) = self.find_event(t, (dt, margin, row));
        (dt, Some(row))
    }

    fn make_step(&mut self, t: f64, dt: f64) {
        let mut system = System::new(&self.model, &mut self.solver);
        system.begin(t, &self.state);
        self.integrator.advance(&mut system, t, dt, &mut self.state);
        system.settle(t + dt, &mut self.state);
        self.steps += 1;
    }

    fn margin(&mut self, t: f64) -> (f64, usize) {
        System::new(&self.model, &mut self.solver).margin(t, &self.state, &mut self.loads)
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
            if length <= early || length >= late {
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
        self.try_piece(t, late);
        (late, row)
    }

    /// The state `dt` after the beginning of the piece, made by one step; its margin.
    fn try_piece(&mut self, t: f64, dt: f64) -> (f64, usize) {
        self.state.clone_from(&self.before);
        self.integrator.discontinuity();
        self.make_step(t, dt);
        self.margin(t + dt)
    }
}
