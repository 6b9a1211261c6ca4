//! Euler–Cromer: first the velocity, then the location with the new velocity.

use super::super::{Loads, Model, State};
use super::dense::{DenseOutput, Drift, Step};
use super::{Integrator, Method, splitting};

/// Also called semi-implicit or symplectic Euler. Source: A. Cromer, *Stable solutions using the Euler approximation*,
/// Am. J. Phys. 49 (1981) 455.
pub(super) const METHOD: Method = Method {
    name: "euler-cromer",
    order: 1,
    symplectic: true,
    summary: "first order, symplectic: cheap, and the energy error stays bounded",
    create: || Box::new(EulerCromer::default()),
};

#[derive(Clone, Default)]
struct EulerCromer {
    loads: Loads,
}

impl Integrator for EulerCromer {
    fn advance(&mut self, model: &Model, t: f64, dt: f64, state: &mut State) {
        model.evaluate(t, state, &mut self.loads);
        state.accounts.work += self.loads.power * dt;
        splitting::kick(model, &self.loads, dt, state);
        splitting::drift(model, dt, state);
    }

    fn dense<'a>(&self, step: Step<'a>) -> Box<dyn DenseOutput + 'a> {
        Box::new(Drift(step))
    }

    fn clone_box(&self) -> Box<dyn Integrator> {
        Box::new(self.clone())
    }
}
