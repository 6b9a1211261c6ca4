//! Forces: their interface, and one file for each kind. `dynamics` re-exports all public items.

mod buoyancy;
mod cells;
mod constant;
mod coulomb;
mod dipoles;
mod drag;
mod formula;
mod gravitation;
mod gravity;
mod j2;
mod lennard_jones;
mod lorentz;
mod pairs;
mod spring;
mod tree;

pub use buoyancy::Buoyancy;
pub use constant::ConstantForce;
pub use coulomb::Coulomb;
pub use dipoles::Dipoles;
pub use drag::Drag;
pub use formula::{FORCE_BLOCK, ForceLaw, FormulaForce, Undefined, in_a_row};
pub use gravitation::Gravitation;
pub use gravity::UniformGravity;
pub use j2::J2;
pub use lennard_jones::LennardJones;
pub use lorentz::Lorentz;
pub use spring::Spring;

use std::ops::Range;

use super::{Loads, Model, State, WorkAccount};

/// All data that a force may use.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// Time, s.
    pub time: f64,
    /// The positions and velocities of the bodies.
    pub state: &'a State,
    /// The masses and other constants of the bodies.
    pub model: &'a Model,
}

/// A force, or anything else that pushes or rotates bodies.
///
/// A new kind of force is one type with this trait. It can be defined anywhere, since the world does not know the kinds.
pub trait Force: Send + Sync {
    /// Adds the forces and torques at this moment to `loads`.
    ///
    /// A force that has no potential, or only for a part, adds the power of the rest, F·v + τ·ω, to `loads.power.work`. Loads on fixed
    /// bodies are dropped afterwards.
    fn apply(&self, moment: &Moment, loads: &mut Loads);

    /// The potential energy, J; 0 for a force that has none.
    ///
    /// The share of a fixed body is left out if it is constant.
    fn potential(&self, moment: &Moment) -> f64;

    /// The account for the work of the part without a potential. `None` if there is no such part.
    fn work_account(&self) -> Option<WorkAccount> {
        None
    }

    /// Adds the part of the forces and torques without a potential, and its power. It is called only if there is a
    /// [`work_account`](Self::work_account). The default calls [`apply`](Self::apply).
    fn apply_without_potential(&self, moment: &Moment, loads: &mut Loads) {
        self.apply(moment, loads);
    }

    /// Adds the forces on a range of bodies only. Only a [local](Self::is_local) force can do this. The default does nothing and returns
    /// false; such a force is always evaluated as a whole.
    fn apply_to(&self, _bodies: Range<usize>, _moment: &Moment, _loads: &mut Loads) -> bool {
        false
    }

    /// Whether the force has a potential and depends on no other body. Bodies that do not meet can then be advanced one after another.
    fn is_local(&self) -> bool {
        false
    }

    /// Whether the force depends on velocities, or does work without a potential.
    fn depends_on_motion(&self) -> bool {
        true
    }

    /// Whether the force can rotate bodies, or depends on their orientations.
    fn turns_bodies(&self) -> bool {
        true
    }

    /// This force as Newton's gravitation, if it is that. Methods that move bodies along orbits need it.
    fn gravitation(&self) -> Option<&Gravitation> {
        None
    }

    /// The number of pairs of bodies in an evaluation, if it determines the time.
    fn pairs(&self) -> u64 {
        0
    }

    /// The position at which the last evaluation had no finite value. `None` for a force that is finite everywhere.
    fn undefined(&self) -> Option<Undefined> {
        None
    }
}

#[cfg(test)]
mod testing {
    use glam::DVec3;

    use super::super::{Accounts, RigidBody, Shape};
    use super::*;

    /// Free bodies at the given locations with the given velocities; mass 1, 2, 3, …
    pub(super) fn bodies(located: &[(DVec3, DVec3)]) -> (Model, State) {
        let (mut model, mut state) = (Model::default(), State::default());
        let sphere = Shape::Sphere { radius: 0.1 };
        let mut mass = 0.0;
        for &(location, velocity) in located {
            mass += 1.0;
            model.push(
                &RigidBody::new(&sphere, mass).with_location(location).with_velocity(velocity),
                &mut state,
            );
        }
        (model, state)
    }

    /// Free bodies of 1 kg at rest, with the given charges at the given locations.
    pub(super) fn charged(located: &[(f64, DVec3)]) -> (Model, State) {
        let (mut model, mut state) = (Model::default(), State::default());
        for &(charge, location) in located {
            let body = RigidBody::new(&Shape::Sphere { radius: 0.1 }, 1.0);
            model.push(&body.with_charge(charge).with_location(location), &mut state);
        }
        (model, state)
    }

    /// The loads of one force alone.
    pub(super) fn loads(force: &dyn Force, model: &Model, state: &State) -> Loads {
        let mut loads = Loads {
            force: vec![DVec3::ZERO; state.len()],
            torque: vec![DVec3::ZERO; state.len()],
            power: Accounts::default(),
        };
        force.apply(&Moment { time: 0.0, state, model }, &mut loads);
        loads
    }

    /// Checks F = −∂U/∂x on every body, by central differences. With h = 1e-5 these are off by h² U‴/6, about 1e-10
    /// here, and by the rounding of U over h, about 1e-16 · 100 / 1e-5 = 1e-9.
    pub(super) fn assert_minus_gradient(force: &dyn Force, model: &Model, state: &State) {
        const H: f64 = 1e-5;
        let given = loads(force, model, state).force;
        for (i, given) in given.iter().enumerate() {
            for axis in 0..3 {
                let potential = |shift: f64| {
                    let mut state = state.clone();
                    state.location[i][axis] += shift;
                    force.potential(&Moment { time: 0.0, state: &state, model })
                };
                let minus_gradient = (potential(-H) - potential(H)) / (2.0 * H);
                assert!(
                    (given[axis] - minus_gradient).abs() < 2e-8,
                    "{i} {axis}: {} {minus_gradient}",
                    given[axis]
                );
            }
        }
    }
}
