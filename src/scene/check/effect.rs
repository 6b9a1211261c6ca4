//! Keys of a body that need a force to have an effect.

use super::Context;
use super::view::View;
use crate::diagnostic::Diagnostic;
use crate::scene::{Body, Force, ForceKind};

/// Warns of masses that neither make a body slow to move nor attract another.
pub(super) fn check(root: &View<'_>, bodies: &[Body], forces: &[Force], context: &mut Context<'_>) {
    let mut attracts = vec![false; bodies.len()];
    for force in forces {
        if let ForceKind::Gravitation { on, .. } = &force.kind {
            on.iter().for_each(|&body| attracts[body] = true);
        }
    }
    for ((name, _, view), (body, attracts)) in root.named("body").into_iter().zip(bodies.iter().zip(attracts))
    {
        if !body.start.fixed || attracts {
            continue;
        }
        for key in ["mass", "density"].into_iter().filter(|key| view.has(key)) {
            let warning = Diagnostic::warning("no-effect", format!("`{key}` of `{name}` has no effect"));
            let why = if body.shape.is_unbounded() { "a plane is always fixed" } else { "it is fixed" };
            context.diagnostics.extend(view.key_span(key).map(|span| warning.at(span, why)));
        }
    }
}
