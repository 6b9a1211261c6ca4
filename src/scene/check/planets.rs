//! Checks scenes with a planetary integrator, which moves free bodies around a heavy body by gravitation alone.

use glam::DVec3;

use super::Context;
use super::read::figure;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::scene::{scene, simulation};
use crate::scene::{Body, Force, ForceKind, SimulationSettings};

/// The minimum ratio of the heaviest body's mass to the total mass of the other bodies.
const MIN_MASS_RATIO: f64 = 20.0;

/// Reports all forces and bodies that a planetary integrator does not support. Does nothing for other integrators.
pub(super) fn check(
    root: &View<'_>,
    simulation: &SimulationSettings,
    bodies: &[Body],
    forces: &[Force],
    context: &mut Context<'_>,
) {
    if !simulation.method.is_planetary() {
        return;
    }
    let table = root.table(&scene::SIMULATION);
    let name = simulation.method.name;
    let Some(chosen) = table.span(&simulation::INTEGRATOR) else { return };
    let before = context.diagnostics.len();
    let mut wrong = |span: Option<Span>, message: String| {
        let error = Diagnostic::error(Code::BadIntegrator, message).at(span.unwrap_or(chosen), "");
        let help =
            format!("`{name}` is for bodies that one `gravitation` alone moves; `gauss-radau` takes all");
        context.diagnostics.push(error.help(help));
    };
    if simulation.gravity != DVec3::ZERO {
        wrong(
            table.span(&simulation::GRAVITY),
            format!("`{name}` takes no gravity that is the same everywhere"),
        );
    }
    let mut attractions = 0;
    for (force_name, span, _) in root.named(&scene::FORCE) {
        let Some(force) = forces.iter().find(|force| force.name == force_name) else { continue };
        let gravitation = match &force.kind {
            ForceKind::Between(force) => force.gravitation(),
            _ => None,
        };
        match gravitation {
            Some(gravitation) => {
                attractions += 1;
                if attractions > 1 {
                    wrong(
                        Some(span),
                        format!("`{name}` takes one gravitation, and `{force_name}` is one more"),
                    );
                } else if gravitation.softening != 0.0 {
                    wrong(Some(span), format!("`{name}` takes no softening, as `{force_name}` has it"));
                } else if gravitation.opening_angle.is_some() {
                    wrong(
                        Some(span),
                        format!("`{name}` sums up all pairs, and `{force_name}` has an `opening_angle`"),
                    );
                } else if gravitation.against.is_some() || gravitation.bodies.len() < bodies.len() {
                    wrong(
                        Some(span),
                        format!(
                            "`{name}` needs each body to attract each other one, not as `{force_name}` says"
                        ),
                    );
                }
            }
            None => {
                wrong(Some(span), format!("`{name}` takes no force but gravitation, as `{force_name}` is"));
            }
        }
    }
    for ((body, _), span) in
        bodies.iter().zip(0..).zip(root.named(&scene::BODY).into_iter().map(|(_, span, _)| span))
    {
        let what = if body.start.fixed {
            "is fixed"
        } else if body.motion.is_some() {
            "has a motion that is given"
        } else if !body.presence.is_always() {
            "is not there all the time"
        } else if body.start.force != DVec3::ZERO || body.start.torque != DVec3::ZERO {
            "has a force or a torque of its own"
        } else {
            continue;
        };
        wrong(Some(span), format!("`{name}` moves no body that {what}, as `{}`", body.name));
    }
    if context.diagnostics.len() > before || bodies.is_empty() {
        return;
    }
    let mut wrong = |message: String, help: &str| {
        let error = Diagnostic::error(Code::BadIntegrator, message).at(chosen, "");
        context.diagnostics.push(error.help(help));
    };
    if attractions == 0 {
        return wrong(
            format!("`{name}` needs a gravitation that moves the bodies"),
            "write `[force.gravity]` and `gravitation = {}`",
        );
    }
    let heaviest = bodies.iter().map(|body| body.start.mass).fold(0.0, f64::max);
    let others = bodies.iter().map(|body| body.start.mass).sum::<f64>() - heaviest;
    if heaviest < MIN_MASS_RATIO * others {
        let message = format!(
            "`{name}` needs a body that is at least {} times as heavy as all others together",
            figure(MIN_MASS_RATIO)
        );
        wrong(message, "take another integrator: `gauss-radau` is for any masses");
    }
}
