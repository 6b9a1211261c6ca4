//! `[simulation]`.

use glam::DVec3;

use super::Context;
use super::view::View;
use crate::diagnostic::{Diagnostic, Span};
use crate::dynamics::{METHODS, Method};
use crate::scene::Simulation;

/// More frames than anyone renders: eleven hours at 25 frames per second.
const MAX_FRAMES: f64 = 1_000_000.0;
/// More timesteps than anyone waits for: days, even for a single body.
const MAX_STEPS: f64 = 1e11;

pub(super) fn read(view: &View<'_>, context: &mut Context<'_>) -> Simulation {
    let method = view.text("integrator").and_then(Method::by_name).unwrap_or(&METHODS[0]);
    let mut simulation = Simulation {
        duration: view.number("duration").unwrap_or(10.0),
        frame_rate: view.number("frame_rate").unwrap_or(25.0),
        step: view.number("step").unwrap_or(1.0 / 240.0),
        method,
        gravity: view.vector("gravity").unwrap_or(DVec3::ZERO),
    };
    let place = |keys: &[&str]| keys.iter().find_map(|key| view.span(key));
    let frames = (simulation.duration * simulation.frame_rate).round() + 1.0;
    if frames > MAX_FRAMES {
        let message =
            format!("the scene has {} frames; at most {} are written", count(frames), count(MAX_FRAMES));
        let help = "frames = duration × frame_rate + 1";
        refuse("too-many-frames", message, place(&["duration", "frame_rate"]), help, context);
    }
    let steps = simulation.duration / simulation.step.min(1.0 / simulation.frame_rate);
    if steps > MAX_STEPS {
        let message =
            format!("the scene has {} timesteps; at most {} are taken", count(steps), count(MAX_STEPS));
        let help = "timesteps = duration / step, where a step is at most one frame long";
        refuse("too-many-steps", message, place(&["step", "duration", "frame_rate"]), help, context);
    }
    if frames > MAX_FRAMES || steps > MAX_STEPS {
        // So that nothing later counts what cannot be counted.
        simulation.duration = 0.0;
    }
    simulation
}

fn refuse(code: &'static str, message: String, span: Option<Span>, help: &str, context: &mut Context<'_>) {
    let error = Diagnostic::error(code, message).help(help);
    context.diagnostics.push(match span {
        Some(span) => error.at(span, ""),
        None => error,
    });
}

/// A number that may be large, so that it can be read.
fn count(number: f64) -> String {
    if number < 1e15 { format!("{number:.0}") } else { format!("{number:.1e}") }
}
