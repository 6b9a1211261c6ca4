//! Steps of fixed length, made by a method that otherwise chooses its own steps.

use super::super::{Integrator, Loads, State, System};
use super::bodies::{Bodies, Field, Scales};
use super::stepper::Stepper;
use super::time::Time;

/// Makes steps of a given length by an adaptive method. The method restarts at each step, which costs additional evaluations of the
/// forces.
#[derive(Clone)]
pub(in super::super) struct Fixed<S> {
    method: S,
    bodies: Bodies,
    scales: Scales,
    stage: State,
    loads: Loads,
}

impl<S> Fixed<S> {
    pub(super) fn new(method: S) -> Fixed<S> {
        Fixed {
            method,
            bodies: Bodies::default(),
            scales: Scales::default(),
            stage: State::default(),
            loads: Loads::default(),
        }
    }
}

impl<S: Stepper + 'static> Integrator for Fixed<S> {
    fn advance(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State) {
        let Fixed { method, bodies, scales, stage, loads } = self;
        let model = system.model();
        bodies.sort(model, state);
        stage.clone_from(state);
        model.evaluate(t, stage, loads);
        *scales = Scales::of(bodies, model, stage, loads);
        let now = Time::at(t);
        let field = &mut Field { model, bodies, scales, stage, loads };
        method.begin(field, now);
        method.step_by(field, now, dt);
        method.write(field, state);
    }

    fn clone_box(&self) -> Box<dyn Integrator> {
        Box::new(self.clone())
    }
}
