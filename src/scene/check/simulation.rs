//! `[simulation]`.

use super::contact;
use super::counts::Counts;
use super::view::View;
use crate::dynamics::{METHODS, Method};
use crate::scene::Simulation;

/// Reads it, and how many frames and timesteps that makes; none are taken without a body that `needs_steps`.
pub(super) fn read(view: &View<'_>, needs_steps: bool) -> (Simulation, Counts) {
    let method = view.text("integrator").and_then(Method::by_name).unwrap_or(&METHODS[0]);
    let mut simulation = Simulation {
        duration: view.number("duration").unwrap_or_default(),
        frame_rate: view.number("frame_rate").unwrap_or_default(),
        step: view.number("step").unwrap_or_default(),
        method,
        gravity: view.vector("gravity").unwrap_or_default(),
        contacts: contact::law(view),
    };
    let Simulation { duration, frame_rate, step, .. } = simulation;
    let counts = Counts { duration, frame_rate, step, needs_steps };
    if counts.are_too_many() {
        // So that nothing later counts what cannot be counted.
        simulation.duration = 0.0;
    }
    (simulation, counts)
}
