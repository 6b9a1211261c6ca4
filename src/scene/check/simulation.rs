//! Reads the table `[simulation]`.

use super::Context;
use super::contact;
use super::corrections::is_file;
use super::counts::Counts;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic};
use crate::dynamics::{METHODS, Method};
use crate::scene::SimulationSettings;

/// Reads the simulation's settings, and the values that give the numbers of frames and timesteps. `needs_steps` is false if no body moves
/// freely.
pub(super) fn read(view: &View<'_>, needs_steps: bool) -> (SimulationSettings, Counts) {
    let method = view.text("integrator").and_then(Method::by_name).unwrap_or(&METHODS[0]);
    let mut simulation = SimulationSettings {
        duration: view.number("duration").unwrap_or_default(),
        frame_rate: view.number("frame_rate").unwrap_or_default(),
        step: if method.adaptive { f64::INFINITY } else { view.number("step").unwrap_or_default() },
        tolerance: view.number("tolerance").unwrap_or_default(),
        method,
        gravity: view.vector("gravity").unwrap_or_default(),
        contacts: contact::law(view),
    };
    let SimulationSettings { duration, frame_rate, step, .. } = simulation;
    let counts = Counts { duration, frame_rate, step, needs_steps };
    if counts.are_too_many() {
        // Set the duration to 0, so that later code does not count an excessive number of frames.
        simulation.duration = 0.0;
    }
    (simulation, counts)
}

/// Reports a key that the integrator does not use: `step` for an adaptive integrator, `tolerance` for other integrators. Reports nothing
/// if the integrator comes from `--set`, because the scene was written for another integrator.
pub(super) fn check(view: &View<'_>, simulation: &SimulationSettings, context: &mut Context<'_>) {
    let method = simulation.method;
    let (wrong, right, value) =
        if method.adaptive { ("step", "tolerance", "1e-9") } else { ("tolerance", "step", "0.001") };
    let Some(span) = view.key_span(wrong) else { return };
    if view.span("integrator").is_some_and(|span| !is_file(span.source, context)) {
        return;
    }
    let (message, help) = if method.adaptive {
        (
            format!("the integrator `{}` chooses its own steps", method.name),
            format!("say how exact they are: `{right} = {value}`, or leave the line out"),
        )
    } else {
        let adaptive: Vec<String> = Method::all()
            .filter(|method| method.adaptive)
            .map(|method| format!("`{}`", method.name))
            .collect();
        (
            format!("the integrator `{}` makes steps of equal length", method.name),
            format!(
                "say how long they are: `{right} = {value}`; {} choose them by `{wrong}`",
                adaptive.join(" and ")
            ),
        )
    };
    context.diagnostics.push(Diagnostic::error(Code::BadIntegrator, message).at(span, "").help(help));
}
