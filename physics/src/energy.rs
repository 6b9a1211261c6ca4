//! Energy and momentum of a world, and how well a run conserves them.
//!
//! A force without a potential reports its power, which is integrated with the motion. So the drift is
//!
//! drift = (E − E₀ − all accounts) / largest kinetic energy so far
//!
//! The accounts ([`Accounts`]) hold, by name, the energy that forces without a potential, motors, limits, impacts and friction have added so
//! far. They also hold the work of a guided end of a joint. For an exact method the drift is zero, also with dampers, torques and the work
//! of guided bodies.
//!
//! A guided body has a given motion. It is moved to each time at which a method evaluates forces. Its kinetic energy is in the balance, but
//! neither in the total nor in the drift, since its guide does the work for it.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{Accounts, Model, State};

/// The energies and momenta of all bodies at one moment, and the drift of the energy.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Balance {
    /// The kinetic energy of translation and rotation of the bodies that forces move, Σ ½ m v² + ½ L·ω, J.
    pub kinetic: f64,
    /// The kinetic energy of the bodies with a given motion, J. Their guides do the work for it, so neither the total nor the drift counts
    /// it.
    pub given_kinetic: f64,
    /// The potential energy of all forces that have one, J.
    pub potential: f64,
    /// The energy that forces without a potential, impacts and motors have brought in so far, J, one entry for each account.
    pub accounts: Accounts,
    /// The sum of the kinetic energy of the bodies that forces move and the potential energy, J.
    pub total: f64,
    /// The total linear momentum Σ m v, world axes, kg m/s.
    pub linear_momentum: DVec3,
    /// The total angular momentum about the origin of the world, Σ x × m v + L, kg m²/s.
    pub angular_momentum: DVec3,
    /// The integration error of the energy, E − E₀ − all accounts, J.
    pub error: f64,
    /// The integration error of the energy, relative to the largest kinetic energy so far. It is 0 as long as nothing has moved.
    pub drift: f64,
}

/// The ledger of the expected energy, with which measured energies are compared.
///
/// The expected energy E₀ is brought in from outside: by the bodies and forces at the start, and by every later change to them. A change
/// is booked in two parts. [`open`](Self::open) stores the energy before the first of several changes, and [`close`](Self::close) measures
/// the energy after the last. Adding ten thousand bodies therefore takes only two measurements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EnergyLedger {
    brought_in: f64,
    /// The energy before the changes that are not booked yet, J. `None` if all changes are booked.
    before: Option<f64>,
    largest_kinetic: f64,
}

impl EnergyLedger {
    /// Creates the ledger of an empty world, before bodies are added.
    #[must_use]
    pub fn new() -> Self {
        Self { brought_in: 0.0, before: Some(0.0), largest_kinetic: 0.0 }
    }

    /// Stores the energy before a change. Must be called before bodies or forces are changed from outside.
    pub fn open(&mut self, model: &Model, time: f64, state: &State) {
        if self.before.is_none() {
            self.before = Some(mechanical(model, time, state));
        }
    }

    /// Raises the largest kinetic energy so far to the present one, if that is larger. Must be called before constraints remove velocities
    /// that violate them: the initial motion sets the scale of the drift, even if nothing of it remains.
    pub fn see_given(&mut self, model: &Model, state: &State) {
        self.largest_kinetic = self.largest_kinetic.max(kinetic(model, state));
    }

    /// Books the changes since [`open`](Self::open), if there were any. Must be called before time advances.
    pub fn close(&mut self, model: &Model, time: f64, state: &State) {
        if let Some(before) = self.before.take() {
            let kinetic = kinetic(model, state);
            self.brought_in += kinetic + model.potential(time, state) - before;
            self.largest_kinetic = self.largest_kinetic.max(kinetic);
        }
    }

    /// Measures the energies and momenta, and the drift from the expected energy. Books open changes first.
    pub fn measure(&mut self, model: &Model, time: f64, state: &State) -> Balance {
        self.close(model, time, state);
        let balance = self.peek(model, time, state);
        self.largest_kinetic = self.largest_kinetic.max(balance.kinetic);
        balance
    }

    /// Measures the energies and momenta as [`measure`](Self::measure) does, but does not change the ledger. This is for snapshots at
    /// requested moments, which must not affect the run.
    #[must_use]
    pub fn peek(&self, model: &Model, time: f64, state: &State) -> Balance {
        let kinetic = kinetic(model, state);
        let given_kinetic = kinetic_of(model, state, model.guided().map(|(body, _)| body));
        let potential = model.potential(time, state);
        let total = kinetic + potential;
        let accounts = state.accounts;
        let largest_kinetic = self.largest_kinetic.max(kinetic);
        let error = total - self.brought_in - accounts.total();
        let drift = if largest_kinetic > 0.0 { error / largest_kinetic } else { 0.0 };
        let (linear_momentum, angular_momentum) = momenta(model, state);
        Balance {
            kinetic,
            given_kinetic,
            potential,
            accounts,
            total,
            linear_momentum,
            angular_momentum,
            error,
            drift,
        }
    }
}

impl Balance {
    /// The kinetic energy of all bodies, those with a given motion included, J.
    #[must_use]
    pub fn kinetic_of_all(&self) -> f64 {
        self.kinetic + self.given_kinetic
    }

    /// The sum of the kinetic and the potential energy of all bodies, those with a given motion included, J.
    #[must_use]
    pub fn total_of_all(&self) -> f64 {
        self.total + self.given_kinetic
    }
}

impl Default for EnergyLedger {
    fn default() -> Self {
        Self::new()
    }
}

/// Returns the indices of the bodies that forces move. The motion of all other bodies does not count in the balance.
fn free(model: &Model) -> impl Iterator<Item = usize> + '_ {
    model.inverse_mass().iter().enumerate().filter(|(_, inverse)| **inverse != 0.0).map(|(i, _)| i)
}

/// Returns the sum of the kinetic and the potential energy of a state, J.
pub(super) fn mechanical(model: &Model, time: f64, state: &State) -> f64 {
    kinetic(model, state) + model.potential(time, state)
}

fn kinetic(model: &Model, state: &State) -> f64 {
    kinetic_of(model, state, free(model))
}

fn kinetic_of(model: &Model, state: &State, bodies: impl Iterator<Item = usize>) -> f64 {
    let mut twice = 0.0;
    for i in bodies {
        let mass = model.mass()[i];
        twice += mass * state.velocity[i].length_squared();
        twice += state.angular_momentum[i].dot(model.angular_velocity(i, state));
    }
    0.5 * twice
}

fn momenta(model: &Model, state: &State) -> (DVec3, DVec3) {
    let (mut linear, mut angular) = (DVec3::ZERO, DVec3::ZERO);
    for i in free(model) {
        let momentum = model.mass()[i] * state.velocity[i];
        linear += momentum;
        angular += state.location[i].cross(momentum) + state.angular_momentum[i];
    }
    (linear, angular)
}

#[cfg(test)]
mod tests {
    use super::super::{Method, RigidBody, Shape, UniformGravity, World};
    use super::*;

    #[test]
    fn the_balance_of_two_bodies_by_hand() {
        let mut world = World::new();
        let sphere = Shape::Sphere { radius: 1.0 };
        world.add(
            RigidBody::new(&sphere, 2.0)
                .with_location(DVec3::new(0.0, 3.0, 0.0))
                .with_velocity(DVec3::new(4.0, 0.0, 0.0))
                .with_angular_velocity(DVec3::new(0.0, 5.0, 0.0)),
        );
        world.add(
            RigidBody::new(&sphere, 100.0).with_location(DVec3::Y).with_velocity(DVec3::X).with_fixed(true),
        );
        world.add_force(UniformGravity { acceleration: DVec3::new(0.0, -10.0, 0.0) });
        let balance = world.balance();
        // Kinetic energy ½·2·4² + ½·(⅖·2·1²)·5²; potential energy m g h; momentum m v; angular momentum x × m v + I ω. The fixed body
        // contributes nothing.
        assert!((balance.kinetic - 26.0).abs() < 1e-14);
        assert!((balance.potential - 60.0).abs() < 1e-14);
        assert!((balance.total - 86.0).abs() < 1e-14);
        assert_eq!(balance.linear_momentum, DVec3::new(8.0, 0.0, 0.0));
        assert!(balance.angular_momentum.abs_diff_eq(DVec3::new(0.0, 4.0, -24.0), 1e-14));
        assert_eq!((balance.drift, balance.accounts.work), (0.0, 0.0));
    }

    #[test]
    fn nothing_that_moves_means_no_drift() {
        let mut world = World::new();
        world.add(RigidBody::new(&Shape::Plane { normal: DVec3::Y }, 1.0));
        world.advance_to(1.0);
        assert_eq!(world.balance().drift, 0.0);
    }

    /// If the changes were not booked, the drift would be as large as the energy that each change brings in: at least 0.1.
    #[test]
    fn changes_by_hand_are_not_drift() {
        let mut world = World::new();
        if let Some(method) = Method::by_name("rk4") {
            world.set_integrator(method); // exact for constant forces
        }
        let ball =
            RigidBody::new(&Shape::Sphere { radius: 1.0 }, 1.0).with_velocity(DVec3::new(1.0, 2.0, 3.0));
        let id = world.add(ball.with_location(DVec3::splat(10.0)));
        world.advance_to(1.0);
        assert!(world.balance().drift.abs() < 1e-12);
        world.apply_force(id, DVec3::new(0.0, -3.0, 0.0));
        world.apply_torque(id, DVec3::new(0.0, 0.0, 0.1));
        world.advance_to(2.0);
        assert!(world.balance().drift.abs() < 1e-12);
        world.add(ball.with_location(DVec3::splat(-7.0)));
        world.add_force(UniformGravity { acceleration: DVec3::new(0.0, -9.81, 0.0) });
        world.advance_to(3.0);
        let balance = world.balance();
        assert!(balance.drift.abs() < 1e-12, "{}", balance.drift);
        assert!(balance.accounts.work > 1e-3, "the torque has done work");
    }
}
