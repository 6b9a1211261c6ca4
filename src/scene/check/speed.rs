//! Reads the speed of the film, `output.speed`.

use super::Context;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::SpeedCurve;
use crate::scene::grammar::scene::{output, scene};
use crate::scene::view::View;

/// Reads the speed of the film: a number, or a list of simulated times with the speed at each. Reports a speed of 0, and times that do not
/// increase.
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
        if *speed == 0.0 {
            let error =
                Diagnostic::error(Code::OutOfRange, "the film cannot stand still").at(node.span, "speed 0");
            let help = format!("a film that is slow has a small speed: `[{time}, 0.01]` is a hundredth");
            context.diagnostics.push(error.help(help));
        }
        if let Some((before, other)) = last.filter(|(before, _)| before >= time) {
            let message = format!("a speed at {time} s stands after one at {before} s");
            let error = Diagnostic::error(Code::KeyframeOrder, message).at(node.span, "this is not later");
            context.diagnostics.push(error.at(other, "the one before"));
        }
        last = Some((*time, node.span));
    }
    if context.diagnostics.len() > before { SpeedCurve::default() } else { SpeedCurve::new(points) }
}
