//! The explicit Euler method: all updates use the values at the start of the step.

use super::super::{State, System};
use super::dense::{DenseOutput, Step, Tangent};
use super::runge_kutta::{Slope, follow};
use super::{Integrator, Method};

/// The explicit Euler method, for comparison: with it, an oscillator gains energy without bound. Source: L. Euler, *Institutiones calculi
/// integralis* I (1768), § 650; Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, I.7.
pub(super) const METHOD: Method = Method {
    name: "explicit-euler",
    order: 1,
    symplectic: false,
    constraints: true,
    adaptive: false,
    summary: "first order: gains energy without bound, for comparison only",
    create: || Box::new(ExplicitEuler::default()),
    take_over: None,
};

#[derive(Clone, Default)]
struct ExplicitEuler {
    slope: Slope,
}

impl Integrator for ExplicitEuler {
    fn advance(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State) {
        self.slope.measure(system, t, state);
        follow([(1.0, &self.slope)], dt, state);
    }

    fn dense<'a>(&self, _: &mut System<'_>, step: Step<'a>) -> Box<dyn DenseOutput + 'a> {
        Box::new(Tangent(step))
    }

    fn clone_box(&self) -> Box<dyn Integrator> {
        Box::new(self.clone())
    }
}
