//! Yoshida's fourth-order method: three second-order steps, of which the middle one goes backwards in time.

use super::super::{Loads, State, System};
use super::velocities::Velocities;
use super::{Integrator, Method, splitting};

/// Yoshida's fourth-order method. Source: H. Yoshida, *Construction of higher order symplectic integrators*, Phys. Lett. A 150 (1990) 262.
///
/// Each second-order step must be symmetric in time, because the method otherwise loses its fourth order. So each of these steps is a
/// drift for half of its time, a kick, and a second such drift. Forces that depend on velocity use the mean of the velocities before and
/// after the kick.
pub(super) const METHOD: Method = Method {
    name: "yoshida4",
    order: 4,
    symplectic: true,
    constraints: false,
    adaptive: false,
    summary: "fourth order, symplectic: for long and precise motion without joints and impacts",
    create: || Box::new(Yoshida4::default()),
    take_over: None,
};

/// 1 / (2 − ∛2): the length of the first and of the third second-order step, as a fraction of the whole step. The lengths of the three
/// steps add up to 1.
const OUTER_STEP_FRACTION: f64 = 1.351_207_191_959_657_8;

/// The largest number of iterations that find the mean velocity in a kick.
const MAX_ITERATIONS: usize = 60;

#[derive(Clone, Default)]
struct Yoshida4 {
    loads: Loads,
    before: Velocities,
    after: Velocities,
}

impl Yoshida4 {
    /// Makes a second-order step of `dt` seconds; a negative `dt` goes backwards in time.
    fn leap(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State) {
        let (model, half) = (system.model(), 0.5 * dt);
        splitting::drift(model, half, state);
        model.place(t + half, state);
        self.before.read(state);
        system.evaluate_forces(t + half, state, &mut self.loads);
        splitting::kick(model, &self.loads, dt, state);
        let trials = if model.depends_on_motion() { MAX_ITERATIONS } else { 0 };
        for _ in 0..trials {
            self.after.read(state);
            self.before.write_mean(&self.after, state);
            system.evaluate_forces(t + half, state, &mut self.loads);
            self.before.write(state);
            splitting::kick(model, &self.loads, dt, state);
            if self.after.settle(state) {
                break;
            }
        }
        state.accounts.add(dt, self.loads.power);
        splitting::drift(model, half, state);
    }
}

impl Integrator for Yoshida4 {
    fn advance(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State) {
        let outer = OUTER_STEP_FRACTION * dt;
        self.leap(system, t, outer, state);
        self.leap(system, t + outer, dt - 2.0 * outer, state);
        self.leap(system, t + dt - outer, outer, state);
    }

    fn clone_box(&self) -> Box<dyn Integrator> {
        Box::new(self.clone())
    }
}
