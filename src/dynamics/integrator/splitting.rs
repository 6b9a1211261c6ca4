//! What symplectic methods are made of: the motion split into two parts, each of which can be solved by itself.

use glam::DVec3;

use super::super::{Loads, Model, State};
use super::rotation;

/// The effect of constant loads for `dt` on bodies that keep their places: v += F/m dt, L += τ dt.
pub(super) fn kick(model: &Model, loads: &Loads, dt: f64, state: &mut State) {
    for ((velocity, &force), &inverse_mass) in
        state.velocity.iter_mut().zip(&loads.force).zip(model.inverse_mass())
    {
        *velocity += dt * inverse_mass * force;
    }
    for (angular_momentum, &torque) in state.angular_momentum.iter_mut().zip(&loads.torque) {
        *angular_momentum += dt * torque;
    }
}

/// The motion for `dt` of bodies on which nothing acts: x += v dt, and a free rotation.
pub(super) fn drift(model: &Model, dt: f64, state: &mut State) {
    for (location, &velocity) in state.location.iter_mut().zip(&state.velocity) {
        *location += dt * velocity;
    }
    let turning = state.orientation.iter_mut().zip(&state.angular_momentum).zip(model.inverse_inertia());
    for ((orientation, &angular_momentum), &inverse_inertia) in turning {
        if angular_momentum != DVec3::ZERO {
            *orientation = rotation::free(*orientation, angular_momentum, inverse_inertia, dt);
        }
    }
}

/// The same for one body.
pub(in crate::dynamics) fn drift_body(model: &Model, dt: f64, state: &mut State, i: usize) {
    state.location[i] += dt * state.velocity[i];
    let angular_momentum = state.angular_momentum[i];
    if angular_momentum != DVec3::ZERO {
        let inverse_inertia = model.inverse_inertia()[i];
        state.orientation[i] = rotation::free(state.orientation[i], angular_momentum, inverse_inertia, dt);
    }
}
