//! Time integration by adaptive methods. The method chooses the steps. Births and deaths happen between steps, and requested moments may
//! lie within steps.

use super::super::{Breakdown, Snapshot};
use super::{Field, FrameIndependent, Scales, Stepper, Time};

impl<S: Stepper> FrameIndependent<S> {
    /// Advances to time `t` in steps that end at each birth and death. Calls `see` with a snapshot for each of `moments`.
    pub(super) fn advance_by_events(
        &mut self,
        t: f64,
        moments: &[f64],
        see: &mut dyn FnMut(Snapshot),
    ) -> Result<(), Breakdown> {
        let mut left = moments;
        while self.time < t {
            let due = self.calendar.depart(self.time);
            self.change(&due);
            let leg = self.calendar.leg(t, left);
            left = leg.later;
            for &moment in leg.within {
                self.go_to(moment)?;
                see(self.peek()?);
            }
            self.go_to(leg.end)?;
            let due = self.calendar.arrive(self.time);
            self.change(&due);
            self.ledger.close(&self.model, self.time, &self.state);
            for _ in leg.at_end {
                see(self.peek()?);
            }
        }
        Ok(())
    }

    /// Returns the snapshot of the present moment, and leaves the energy ledger unchanged.
    fn peek(&mut self) -> Result<Snapshot, Breakdown> {
        let balance = self.ledger.peek(&self.model, self.time, &self.state);
        self.picture(balance).checked()
    }

    /// Adds bodies that are born and removes bodies that die. `due` holds the index of each body, and true for a birth.
    fn change(&mut self, due: &[(usize, bool)]) {
        if !due.is_empty() {
            self.ledger.open(&self.model, self.time, &self.state);
            self.model.let_come_and_go(due, &mut self.state);
            self.is_begun = false;
        }
    }

    /// Moves the bodies to time `t`, s. This time must not be before the last requested time or after the next birth or death.
    fn go_to(&mut self, t: f64) -> Result<(), Breakdown> {
        if !self.is_begun {
            self.begin();
        }
        while self.now.0.until(t) > 0.0 {
            self.make_step(t)?;
        }
        self.time = t;
        self.look();
        Ok(())
    }

    /// Passes the present bodies to the integration method, which starts again.
    fn begin(&mut self) {
        self.is_begun = true;
        self.ledger.close(&self.model, self.time, &self.state);
        self.model.place(self.time, &mut self.state);
        self.bodies.sort(&self.model, &self.state);
        self.stage.clone_from(&self.state);
        self.model.evaluate(self.time, &self.stage, &mut self.loads);
        self.scales = Scales::of(&self.bodies, &self.model, &self.stage, &self.loads);
        self.now.0 = Time::at(self.time);
        let FrameIndependent { model, bodies, scales, stage, loads, now, .. } = self;
        now.1.begin(&mut Field { model, bodies, scales, stage, loads }, now.0);
    }

    /// Makes one step. `wanted` is the time that later steps must reach, s.
    fn make_step(&mut self, wanted: f64) -> Result<(), Breakdown> {
        let stop = self.stop();
        let FrameIndependent { model, bodies, scales, stage, loads, now: (now, method), before, .. } = self;
        let longest = now.until(stop);
        if method.proposal().min(longest) >= now.until(wanted) {
            // This step reaches the requested time, so the state before the step is saved. A shorter step from this state leads to the
            // requested time.
            before.0 = *now;
            before.1.clone_from(method);
        }
        let field = &mut Field { model, bodies, scales, stage, loads };
        let time = now.seconds();
        let step = method.step(field, *now, longest);
        let step = step.map_err(|body| Breakdown::Stalled { body, time })?;
        *now = if step >= longest { Time::at(stop) } else { now.after(step) };
        self.steps += 1;
        Ok(())
    }

    /// Returns the time beyond which the next step must not go, s: the next birth or death, or the end of the run.
    fn stop(&mut self) -> f64 {
        let now = self.now.0.seconds();
        let next = self.calendar.next().unwrap_or(f64::INFINITY);
        let end = if now < self.end { self.end } else { now + self.end.abs().max(1.0) };
        next.min(end)
    }

    /// Computes the state of the bodies at the requested time, which lies within the last step or at its end.
    fn look(&mut self) {
        let FrameIndependent {
            model, bodies, scales, stage, loads, now, before, branch, state, time, ..
        } = self;
        let field = &mut Field { model, bodies, scales, stage, loads };
        if now.0.until(*time) == 0.0 {
            now.1.write(field, state);
        } else {
            branch.clone_from(&before.1);
            branch.step_by(field, before.0, before.0.until(*time));
            branch.write(field, state);
        }
        model.place(*time, state);
    }
}
