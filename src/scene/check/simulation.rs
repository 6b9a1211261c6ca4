//! Reads the table `[simulation]`.

use super::Context;
use super::contact;
use super::corrections::is_file;
use super::counts::Counts;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic};
use crate::physics::{METHODS, Method};
use crate::scene::grammar::scene::{scene, simulation};
use crate::scene::{ContactLaw, SimulationSettings, SpeedCurve, Timeline};

/// The default integrator of scenes with joints or event-driven contacts. It is of second order, because impacts and loads are only as
/// accurate as the motion between them.
const DEFAULT_CONSTRAINED_INTEGRATOR: &str = "velocity-verlet";

/// Reads the simulation's settings, and the values that give the numbers of frames and timesteps. `needs_steps` is false if no body moves
/// freely.
pub(super) fn read(root: &View<'_>, needs_steps: bool, speed: SpeedCurve) -> (SimulationSettings, Counts) {
    let view = root.table(&scene::SIMULATION);
    let contacts = contact::law(&view);
    let is_constrained = match contacts {
        // Time stepping has its own integrator.
        Some(ContactLaw::TimeStepping) => false,
        Some(ContactLaw::EventDriven) => true,
        None => !root.named(&scene::JOINT).is_empty(),
    };
    let default =
        Method::by_name(DEFAULT_CONSTRAINED_INTEGRATOR).filter(|_| is_constrained).unwrap_or(&METHODS[0]);
    let method = view.get(&simulation::INTEGRATOR).and_then(Method::by_name).unwrap_or(default);
    let mut simulation = SimulationSettings {
        timeline: Timeline {
            duration: view.get(&simulation::DURATION),
            frame_rate: view.get(&simulation::FRAME_RATE),
            speed,
        },
        step: if method.adaptive { f64::INFINITY } else { view.get(&simulation::STEP) },
        tolerance: view.get(&simulation::TOLERANCE),
        method,
        gravity: view.get(&simulation::GRAVITY),
        contacts,
    };
    let counts = Counts { timeline: simulation.timeline.clone(), step: simulation.step, needs_steps };
    if counts.are_too_many() {
        // Set the duration to 0, so that later code does not count an excessive number of frames.
        simulation.timeline.duration = 0.0;
    }
    (simulation, counts)
}

/// Reports a key that the integrator does not use: `step` for an adaptive integrator, `tolerance` for other integrators. Reports nothing
/// if the integrator comes from `--set`, because the scene was written for another integrator.
pub(super) fn check(view: &View<'_>, simulation: &SimulationSettings, context: &mut Context<'_>) {
    let method = simulation.method;
    let (step, tolerance) = (&simulation::STEP.spec, &simulation::TOLERANCE.spec);
    let (wrong, right, value) =
        if method.adaptive { (step, tolerance, "1e-9") } else { (tolerance, step, "0.001") };
    let Some(span) = view.key_span(wrong) else { return };
    let (wrong, right) = (wrong.name, right.name);
    if view.span(&simulation::INTEGRATOR).is_some_and(|span| !is_file(span.source(), &context.sources)) {
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

#[cfg(test)]
mod tests {
    use crate::Scene;

    #[test]
    fn the_default_integrator_suits_joints_and_event_driven_contacts() {
        let ball = "[body.ball]\nshape.sphere.radius = 0.1\nlocation = [1, 1, 0]\n";
        let rod = "[joint.rod.rod]\nbetween = [[0, 1, 0], 'ball']\n";
        let event_driven = "simulation.contacts = 'event-driven'\n";
        let time_stepping = "simulation.contacts = 'time-stepping'\n";
        let own = "simulation.integrator = 'euler-cromer'\n";
        for (text, expected) in [
            (ball.to_owned(), "euler-cromer"),
            (format!("{ball}{rod}"), "velocity-verlet"),
            (format!("{event_driven}{ball}"), "velocity-verlet"),
            (format!("{event_driven}{ball}{rod}"), "velocity-verlet"),
            (format!("{time_stepping}{ball}"), "euler-cromer"),
            (format!("{time_stepping}{ball}{rod}"), "euler-cromer"),
            (format!("{own}{ball}{rod}"), "euler-cromer"),
            (format!("{own}{event_driven}{ball}"), "euler-cromer"),
        ] {
            let scene = Scene::parse(&text).unwrap();
            assert_eq!(scene.simulation.method.name, expected, "{text}");
        }
    }
}
