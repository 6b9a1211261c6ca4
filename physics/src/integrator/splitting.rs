//! Building blocks of symplectic methods. The equations of motion are split into two parts, and each part is solved exactly.

use glam::DVec3;

use super::super::{Loads, Model, State};
use super::rotation;

/// Applies constant loads for `dt` seconds at fixed positions: v += F/m dt, L += τ dt.
pub(super) fn kick(model: &Model, loads: &Loads, dt: f64, state: &mut State) {
    if let Some(bodies) = model.in_focus() {
        for &i in bodies {
            state.velocity[i] += dt * model.inverse_mass()[i] * loads.force[i];
            state.angular_momentum[i] += dt * loads.torque[i];
        }
        return;
    }
    for ((velocity, &force), &inverse_mass) in
        state.velocity.iter_mut().zip(&loads.force).zip(model.inverse_mass())
    {
        *velocity += dt * inverse_mass * force;
    }
    for (angular_momentum, &torque) in state.angular_momentum.iter_mut().zip(&loads.torque) {
        *angular_momentum += dt * torque;
    }
}

/// Corrects a kick of `dt` seconds that was made with the loads `first`, so that it equals a kick with the loads `later`.
pub(super) fn kick_again(model: &Model, [first, later]: [&Loads; 2], dt: f64, state: &mut State) {
    let mut change = |i: usize| {
        state.velocity[i] += dt * model.inverse_mass()[i] * (later.force[i] - first.force[i]);
        state.angular_momentum[i] += dt * (later.torque[i] - first.torque[i]);
    };
    match model.in_focus() {
        Some(bodies) => bodies.iter().for_each(|&i| change(i)),
        None => (0..model.len()).for_each(change),
    }
}

/// Moves the bodies for `dt` seconds as if no loads acted on them: x += v dt, and a free rotation.
pub(super) fn drift(model: &Model, dt: f64, state: &mut State) {
    if let Some(bodies) = model.in_focus() {
        bodies.iter().for_each(|&i| drift_body(model, dt, state, i));
        return;
    }
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

/// Moves body `i` for `dt` seconds as if no loads acted on it: x += v dt, and a free rotation.
pub(crate) fn drift_body(model: &Model, dt: f64, state: &mut State, i: usize) {
    state.location[i] += dt * state.velocity[i];
    let angular_momentum = state.angular_momentum[i];
    if angular_momentum != DVec3::ZERO {
        let inverse_inertia = model.inverse_inertia()[i];
        state.orientation[i] = rotation::free(state.orientation[i], angular_momentum, inverse_inertia, dt);
    }
}
