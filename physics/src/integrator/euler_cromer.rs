//! The Euler–Cromer method: it updates the velocity first, then the position with the new velocity.

use super::super::{Loads, State, System};
use super::dense::{DenseOutput, Drift, Hermite, Step};
use super::{Integrator, Method, splitting};

/// The Euler–Cromer method, also called semi-implicit or symplectic Euler. Source: A. Cromer, *Stable solutions using the Euler
/// approximation*, Am. J. Phys. 49 (1981) 455. With constraints, it is SHAKE of first order: Hairer, Lubich & Wanner, *Geometric Numerical
/// Integration*, VII.1.3.
pub(super) const METHOD: Method = Method {
    name: "euler-cromer",
    order: 1,
    symplectic: true,
    constraints: true,
    adaptive: false,
    summary: "first order, symplectic: cheap, and the energy error stays bounded",
    create: || Box::new(EulerCromer::default()),
    take_over: None,
};

#[derive(Clone, Default)]
struct EulerCromer {
    loads: Loads,
}

impl Integrator for EulerCromer {
    fn advance(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State) {
        system.evaluate_forces(t, state, &mut self.loads);
        state.accounts.add(dt, self.loads.power);
        splitting::kick(system.model(), &self.loads, dt, state);
        system.aim(t, dt, state);
        splitting::drift(system.model(), dt, state);
    }

    fn dense<'a>(&self, system: &mut System<'_>, step: Step<'a>) -> Box<dyn DenseOutput + 'a> {
        // With constraints, the velocity that leads to the position at the end of the step differs from the velocity in the state at the
        // end. So `Drift` would give wrong velocities.
        if system.is_constrained() { Box::new(Hermite::new(system, step)) } else { Box::new(Drift(step)) }
    }

    fn clone_box(&self) -> Box<dyn Integrator> {
        Box::new(self.clone())
    }
}
