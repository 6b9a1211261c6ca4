//! Velocity Verlet: half a kick, a drift, half a kick.

use super::super::{Loads, Model, State};
use super::{Integrator, Method, splitting};

/// Source: W. C. Swope et al., J. Chem. Phys. 76 (1982) 637.
///
/// Their method falls to first order where a force depends on velocity, as it evaluates the force at the end of the
/// step before the velocity there is known. Here that velocity is predicted, v + a·dt; it is off by O(dt²), so the
/// step by O(dt³), and second order is kept.
pub(super) const METHOD: Method = Method {
    name: "velocity-verlet",
    order: 2,
    symplectic: true,
    summary: "second order, symplectic: one evaluation of forces a step",
    create: || Box::new(VelocityVerlet::default()),
};

#[derive(Clone, Default)]
struct VelocityVerlet {
    start: Loads,
    end: Loads,
    /// Whether `start` holds the loads at the current state, from the end of the step before.
    primed: bool,
}

impl Integrator for VelocityVerlet {
    fn advance(&mut self, model: &Model, t: f64, dt: f64, state: &mut State) {
        let half = 0.5 * dt;
        if !self.primed {
            model.evaluate(t, state, &mut self.start);
        }
        splitting::kick(model, &self.start, half, state);
        splitting::drift(model, dt, state);

        // The second half of the kick, with the old loads: this is the prediction.
        splitting::kick(model, &self.start, half, state);
        model.place(t + dt, state);
        model.evaluate(t + dt, state, &mut self.end);

        // And now what the new loads would have made of it.
        for (i, &inverse_mass) in model.inverse_mass().iter().enumerate() {
            state.velocity[i] += half * inverse_mass * (self.end.force[i] - self.start.force[i]);
            state.angular_momentum[i] += half * (self.end.torque[i] - self.start.torque[i]);
        }
        state.accounts.work += half * (self.start.power + self.end.power);

        std::mem::swap(&mut self.start, &mut self.end);
        self.primed = true;
    }

    fn discontinuity(&mut self) {
        self.primed = false;
    }

    fn clone_box(&self) -> Box<dyn Integrator> {
        Box::new(self.clone())
    }
}
