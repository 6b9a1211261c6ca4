//! `[simulation]`.

use glam::DVec3;

use super::Context;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic};
use crate::dynamics::{METHODS, Method};
use crate::scene::Simulation;

/// More frames than anyone renders: eleven hours at 25 frames per second.
pub(in crate::scene) const MAX_FRAMES: f64 = 1_000_000.0;
/// More timesteps than anyone waits for: days, even for a single body.
const MAX_STEPS: f64 = 1e11;

/// Reads it; without a body that `needs_steps`, none are taken, and no number of them is too large.
pub(super) fn read(view: &View<'_>, needs_steps: bool, context: &mut Context<'_>) -> Simulation {
    let method = view.text("integrator").and_then(Method::by_name).unwrap_or(&METHODS[0]);
    let mut simulation = Simulation {
        duration: view.number("duration").unwrap_or(10.0),
        frame_rate: view.number("frame_rate").unwrap_or(25.0),
        step: view.number("step").unwrap_or(1.0 / 240.0),
        method,
        gravity: view.vector("gravity").unwrap_or(DVec3::ZERO),
    };
    let frames = (simulation.duration * simulation.frame_rate).round() + 1.0;
    let steps = if needs_steps {
        simulation.duration / simulation.step.min(1.0 / simulation.frame_rate)
    } else {
        0.0
    };
    if frames > MAX_FRAMES {
        let message =
            format!("the scene has {} frames; at most {} are written", count(frames), count(MAX_FRAMES));
        let error =
            Diagnostic::error(Code::TooManyFrames, message).help("frames = duration × frame_rate + 1");
        context.diagnostics.push(point(error, view, &["duration", "frame_rate"]));
    } else if steps > MAX_STEPS {
        let message =
            format!("the scene has {} timesteps; at most {} are taken", count(steps), count(MAX_STEPS));
        let error = Diagnostic::error(Code::TooManySteps, message)
            .help("timesteps = duration / step, where a step is at most one frame long");
        context.diagnostics.push(point(error, view, &["step", "duration", "frame_rate"]));
    }
    if frames > MAX_FRAMES || steps > MAX_STEPS {
        // So that nothing later counts what cannot be counted.
        simulation.duration = 0.0;
    }
    simulation
}

/// Points at the values of those keys that are given.
fn point(error: Diagnostic, view: &View<'_>, keys: &[&str]) -> Diagnostic {
    keys.iter().filter_map(|key| view.span(key)).fold(error, |error, span| error.at(span, ""))
}

/// A number that may be large, so that it can be read: `1,000,001`.
fn count(number: f64) -> String {
    if number >= 1e15 {
        let most = f64::MAX.min(number);
        return format!("{}{most:.1e}", if number.is_finite() { "" } else { "more than " });
    }
    let digits = format!("{number:.0}");
    let mut text = String::new();
    for (place, digit) in digits.char_indices() {
        if place > 0 && (digits.len() - place) % 3 == 0 {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
