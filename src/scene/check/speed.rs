//! Reads the speed of the film, `output.speed`.

use super::Context;
use super::motion::out_of_order;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::scene::{FASTEST_FILM, SLOWEST_FILM, output, scene};
use crate::scene::view::View;
use crate::scene::{SimulationSettings, SpeedCurve};

/// Reads the speed of the film: a number, or a list of simulated times with the speed at each. Reports speeds out of range, and times that
/// do not increase.
pub(super) fn read(root: &View<'_>, context: &mut Context<'_>) -> SpeedCurve {
    let view = root.table(&scene::OUTPUT);
    if let Some(speed) = view.get_as::<f64>(&output::SPEED) {
        return SpeedCurve::new([[0.0, speed]]);
    }
    let Some(points) = view.get_as::<Vec<[f64; 2]>>(&output::SPEED) else { return SpeedCurve::default() };
    let nodes = view.list(&output::SPEED).unwrap_or_default();
    let mut last: Option<(f64, Span)> = None;
    let before = context.diagnostics.len();
    for ([time, speed], node) in points.iter().zip(nodes) {
        if !(SLOWEST_FILM..=FASTEST_FILM).contains(speed) {
            let message = format!("the speed of a film is from {SLOWEST_FILM} to {FASTEST_FILM:e}");
            let error = Diagnostic::error(Code::OutOfRange, message).at(node.span, format!("speed {speed}"));
            let help = format!("a film that is slow has a small speed: `[{time}, 0.01]` is a hundredth");
            context.diagnostics.push(error.help(help));
        }
        out_of_order("a speed", &mut last, *time, node.span, context);
    }
    if context.diagnostics.len() > before { SpeedCurve::default() } else { SpeedCurve::new(points) }
}

/// Refuses a speed of the film in a scene with emitters. Their particles move from frame to frame, so the speed would change where they are.
pub(super) fn check_emitters(root: &View<'_>, simulation: &SimulationSettings, context: &mut Context<'_>) {
    let view = root.table(&scene::OUTPUT);
    let Some(span) = view.span(&output::SPEED) else { return };
    if simulation.timeline.speed.is_even() || root.named(&scene::EMITTER).is_empty() {
        return;
    }
    let message = "a scene with emitters cannot give its film a speed";
    let help = "the whole film is slow if `video_rate` in [output] is below `frame_rate` in [simulation]";
    let error = Diagnostic::error(Code::BadEmitter, message).at(span, "particles move from frame to frame");
    context.diagnostics.push(error.help(help));
}
