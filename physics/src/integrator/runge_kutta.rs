//! Building blocks of explicit Runge–Kutta methods: the slope of the state, and steps along weighted slopes.

use glam::{DQuat, DVec3};

use super::super::{Accounts, Loads, Model, State, System};
use super::rotation;

/// The time derivative of a [`State`]. The loads hold the derivatives of angular momentum (torque) and of work (power).
#[derive(Clone, Default)]
pub(super) struct Slope {
    location: Vec<DVec3>,
    velocity: Vec<DVec3>,
    orientation: Vec<DQuat>,
    loads: Loads,
}

impl Slope {
    /// Evaluates the time derivative at `state` and time `t` (s): the right-hand side of the equations of motion.
    pub(super) fn measure(&mut self, system: &mut System<'_>, t: f64, state: &State) {
        system.evaluate(t, state, &mut self.loads);
        self.read(system.model(), state);
    }

    /// Places the bodies with a given motion for a later time `t` (s), and evaluates the time derivative at that time.
    pub(super) fn arrive(&mut self, system: &mut System<'_>, t: f64, state: &mut State) {
        system.arrive(t, state, &mut self.loads);
        self.read(system.model(), state);
    }

    fn read(&mut self, model: &Model, state: &State) {
        self.location.clone_from(&state.velocity);
        self.velocity.clear();
        self.velocity.extend(
            self.loads.force.iter().zip(model.inverse_mass()).map(|(&force, &inverse)| force * inverse),
        );
        self.orientation.clear();
        self.orientation.extend((0..state.len()).map(|i| {
            let angular_velocity = model.angular_velocity(i, state);
            rotation::rate(state.orientation[i], angular_velocity)
        }));
    }
}

/// Advances `state` by `dt` (s) along the weighted sum of slopes. The sum moves orientations off the unit sphere, so they are normalized
/// afterwards, also at the stages of a method. This does not change the order of the method.
pub(super) fn follow<const N: usize>(slopes: [(f64, &Slope); N], dt: f64, state: &mut State) {
    add(&mut state.location, dt, slopes.map(|(weight, slope)| (weight, slope.location.as_slice())));
    add(&mut state.velocity, dt, slopes.map(|(weight, slope)| (weight, slope.velocity.as_slice())));
    add(
        &mut state.angular_momentum,
        dt,
        slopes.map(|(weight, slope)| (weight, slope.loads.torque.as_slice())),
    );
    for (i, orientation) in state.orientation.iter_mut().enumerate() {
        let mut rate = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        for (weight, slope) in slopes {
            rate += slope.orientation[i] * weight;
        }
        // Most bodies do not rotate, so this condition saves a square root.
        if rate.length_squared() != 0.0 {
            *orientation = (*orientation + rate * dt).normalize();
        }
    }
    let mut power = Accounts::default();
    slopes.iter().for_each(|(weight, slope)| power.add(*weight, slope.loads.power));
    state.accounts.add(dt, power);
}

/// Computes values += dt · Σ weight · slope. The small terms are summed up first, which reduces rounding errors.
fn add<const N: usize>(values: &mut [DVec3], dt: f64, slopes: [(f64, &[DVec3]); N]) {
    for (i, value) in values.iter_mut().enumerate() {
        let mut sum = DVec3::ZERO;
        for (weight, slope) in slopes {
            sum += weight * slope[i];
        }
        *value += dt * sum;
    }
}
