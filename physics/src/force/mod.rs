//! Forces: their interface, and one file for each kind of force. The crate re-exports all public items.
//!
//! Forces between pairs (`pairs.rs`) visit each pair once. So the sum over all pairs conserves momentum up to rounding. Only bodies act on
//! particles, so no particle depends on other particles.
//!
//! # The tree of gravitation
//!
//! With an opening angle, gravitation is summed by a tree (`tree/`). A node is split at the middle of its longest edge, but neither part
//! gets less than an eighth of the bodies, so the tree stays shallow for every distribution of bodies. Groups of 32 bodies traverse the tree
//! together. The order of the terms in a body's sum depends only on the tree, so rayon may process the groups in any order.
//!
//! A node is expanded about its center of mass up to its second moments. The expansion of the softened kernel includes the trace of these
//! moments. At an opening angle of 0.5, the error of the forces is 4e-4 (root mean square); at 0.3 it is 8e-5, at 1 it is 5e-3. The reported
//! potential is that of the same tree. The forces are not exactly its gradient, and the two forces of a pair are not exactly opposite. So
//! energy, momentum and angular momentum drift by less than the error of the forces.

mod between;
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
mod on_each;
mod pairs;
mod spring;
mod tree;

pub use between::ForceBetween;
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
pub use on_each::ForceOnEach;
pub use spring::Spring;

use std::ops::Range;

use super::{Loads, Model, State, WorkAccount};

/// The moment at which forces are evaluated, with all data that a force may use.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// The time, s.
    pub time: f64,
    /// The positions and velocities of the bodies.
    pub state: &'a State,
    /// The masses and other constants of the bodies.
    pub model: &'a Model,
}

/// A force, or anything else that pushes or rotates bodies.
///
/// A new kind of force is a type that implements this trait. Such a type can be defined anywhere, because a world works with every
/// implementation.
pub trait Force: Send + Sync {
    /// Adds the forces and torques at this moment to `loads`.
    ///
    /// If the force, or a part of the force, has no potential, the power of this part, F·v + τ·ω, is added to `loads.power.work`. Loads on
    /// fixed bodies are dropped afterwards.
    fn apply(&self, moment: &Moment, loads: &mut Loads);

    /// Returns the potential energy at this moment, J; 0 for a force without a potential.
    ///
    /// Constant contributions of fixed bodies are left out.
    fn potential(&self, moment: &Moment) -> f64;

    /// Adds to `shares` what each body has of the [potential energy](Self::potential), J. Of the energy of two bodies, each has half. If one of
    /// them is fixed or has a given motion, the other one has all of it. All shares together are the potential energy. A force without a
    /// potential keeps this default, which adds nothing.
    fn share_potential(&self, _moment: &Moment, _shares: &mut [f64]) {}

    /// Returns the account for the work of the force's part without a potential; `None` if there is no such part.
    fn work_account(&self) -> Option<WorkAccount> {
        None
    }

    /// Adds only the forces and torques of the part without a potential, and their power. This function is called only if there is a
    /// [`work_account`](Self::work_account). The default calls [`apply`](Self::apply).
    fn apply_without_potential(&self, moment: &Moment, loads: &mut Loads) {
        self.apply(moment, loads);
    }

    /// Adds the forces on a range of bodies only, and returns true. Only a [local](Self::is_local) force can do this. The default adds
    /// nothing and returns false; all bodies must then be evaluated together.
    fn apply_to(&self, _bodies: Range<usize>, _moment: &Moment, _loads: &mut Loads) -> bool {
        false
    }

    /// Whether the force has a potential, and the force on a body depends on that body alone. Bodies that do not touch can then be
    /// advanced one after another.
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

    /// Returns this force if it is Newton's gravitation. Methods that move bodies along Kepler orbits need it.
    fn gravitation(&self) -> Option<&Gravitation> {
        None
    }

    /// Returns the number of pairs of bodies in one evaluation; 0 if the computing time of an evaluation does not depend on pairs.
    fn pairs(&self) -> u64 {
        0
    }

    /// Returns the state in which the last evaluation of the force was not finite; `None` if the force was finite, and for forces that are
    /// always finite.
    fn undefined(&self) -> Option<Undefined> {
        None
    }
}

/// Adds an energy (J) to the `shares` of the bodies that have it together, in equal parts. A body that no force moves gets a part only if
/// forces move none of them. Fixed bodies get no part.
fn share<const N: usize>(energy: f64, bodies: [usize; N], moment: &Moment, shares: &mut [f64]) {
    let model = moment.model;
    let is_one_free = bodies.iter().any(|body| model.can_move(*body));
    let gets_a_part = |body: usize| if is_one_free { model.can_move(body) } else { model.movable()[body] };
    let their = || bodies.iter().copied().filter(|body| gets_a_part(*body));
    #[allow(clippy::cast_precision_loss, reason = "there are one or two bodies")]
    let part = energy / their().count() as f64;
    their().for_each(|body| shares[body] += part);
}

#[cfg(test)]
mod testing {
    use glam::DVec3;

    use super::super::{Accounts, RigidBody, Shape};
    use super::*;

    /// Returns a model and a state with free bodies at the given locations, with the given velocities. Their masses are 1, 2, 3, … kg.
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

    /// Returns a model and a state with free bodies of 1 kg at rest, with the given charges at the given locations.
    pub(super) fn charged(located: &[(f64, DVec3)]) -> (Model, State) {
        let (mut model, mut state) = (Model::default(), State::default());
        for &(charge, location) in located {
            let body = RigidBody::new(&Shape::Sphere { radius: 0.1 }, 1.0);
            model.push(&body.with_charge(charge).with_location(location), &mut state);
        }
        (model, state)
    }

    /// Returns the loads that a single force exerts at time 0.
    pub(super) fn loads(force: &dyn Force, model: &Model, state: &State) -> Loads {
        let mut loads = Loads {
            force: vec![DVec3::ZERO; state.len()],
            torque: vec![DVec3::ZERO; state.len()],
            power: Accounts::default(),
        };
        force.apply(&Moment { time: 0.0, state, model }, &mut loads);
        loads
    }

    /// Checks F = −∂U/∂x on every body, by central differences, and that the shares of the bodies add up to U. With h = 1e-5, the differences are wrong by h² U‴/6, about 1e-10 for these
    /// forces, and by the rounding error of U over h, about 1e-16 · 100 / 1e-5 = 1e-9.
    pub(super) fn assert_minus_gradient(force: &dyn Force, model: &Model, state: &State) {
        const H: f64 = 1e-5;
        let moment = Moment { time: 0.0, state, model };
        let mut shares = vec![0.0; state.len()];
        force.share_potential(&moment, &mut shares);
        let (sum, potential) = (shares.iter().sum::<f64>(), force.potential(&moment));
        let size: f64 = shares.iter().map(|share| share.abs()).sum();
        assert!((sum - potential).abs() <= 1e-13 * size, "the shares {shares:?} are not {potential}");
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
