//! The velocity Verlet method: half a kick, a drift, half a kick.

use super::super::{Loads, State, System};
use super::velocities::Velocities;
use super::{Integrator, Method, splitting};

/// The velocity Verlet method. Source: W. C. Swope et al., J. Chem. Phys. 76 (1982) 637.
///
/// The published method falls to first order if a force depends on velocity, because it evaluates the force at the end of the step before
/// the velocity at that time is known. This version predicts that velocity as v + a·dt. The prediction has an error of O(dt²) and the step
/// one of O(dt³), so the method stays of second order. With constraints, it is RATTLE: H. C. Andersen, J. Comput. Phys. 52 (1983) 24.
pub(super) const METHOD: Method = Method {
    name: "velocity-verlet",
    order: 2,
    symplectic: true,
    constraints: true,
    adaptive: false,
    summary: "second order, symplectic, one evaluation of forces a step: for long motion, also with joints and impacts",
    create: || Box::new(VelocityVerlet::default()),
    take_over: None,
};

#[derive(Clone, Default)]
struct VelocityVerlet {
    start: Loads,
    end: Loads,
    /// Whether `start` holds the loads at the present state, kept from the end of the last step.
    primed: bool,
    /// The velocities at the start (`begin`) and in the middle of a step; used only in steps with constraints.
    begin: Velocities,
    middle: Velocities,
}

impl VelocityVerlet {
    /// Makes a step of RATTLE, in which the impulses of the constraints are part of the kicks. [`System::settle`] adds the impulses at the
    /// end of the step.
    fn rattle(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State) {
        let (model, half) = (system.model(), 0.5 * dt);
        self.begin.read(state);
        splitting::kick(model, &self.start, half, state);
        system.aim(t, dt, state);
        self.middle.read(state);
        splitting::drift(model, dt, state);
        // The velocity at the end is predicted on the assumption that both halves of the kick are equal.
        self.begin.extrapolate(state);
        model.place(t + dt, state);
        system.evaluate_forces(t + dt, state, &mut self.end);
        self.middle.write(state);
        splitting::kick(model, &self.end, half, state);
    }

    fn free(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State) {
        let (model, half) = (system.model(), 0.5 * dt);
        splitting::kick(model, &self.start, half, state);
        splitting::drift(model, dt, state);

        // A second half kick with the old loads predicts the velocity at the end.
        splitting::kick(model, &self.start, half, state);
        model.place(t + dt, state);
        system.evaluate_forces(t + dt, state, &mut self.end);

        // The new loads replace the old loads in the second half kick.
        splitting::kick_again(model, [&self.start, &self.end], half, state);
    }
}

impl Integrator for VelocityVerlet {
    fn advance(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State) {
        if !self.primed {
            system.evaluate_forces(t, state, &mut self.start);
        }
        if system.is_constrained() {
            self.rattle(system, t, dt, state);
        } else {
            self.free(system, t, dt, state);
        }
        state.accounts.add(0.5 * dt, self.start.power);
        state.accounts.add(0.5 * dt, self.end.power);

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
