//! Warns of body properties, such as a charge, that have no effect because no force uses them.

use glam::DVec3;

use super::Context;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic};
use crate::physics::{Dipoles, J2};
use crate::scene::grammar::KeySpec;
use crate::scene::grammar::bodies;
use crate::scene::{Body, Force, ForceKind};

/// Warns of the mass of a fixed body on which no gravitation acts, and of a charge or a magnetic moment on which no force acts.
pub(super) fn check(root: &View<'_>, bodies: &[Body], forces: &[Force], context: &mut Context<'_>) {
    let (mut attracts, mut electric) = (vec![false; bodies.len()], vec![false; bodies.len()]);
    let mut magnetic = vec![false; bodies.len()];
    for force in forces {
        match &force.kind {
            ForceKind::Between(between) => force.kind.bodies().iter().for_each(|body| {
                attracts[body.index()] |= between.depends_on_mass();
                electric[body.index()] |= between.depends_on_charge();
            }),
            ForceKind::OnEach(force) => {
                force.bodies().iter().for_each(|body| electric[body.index()] |= force.depends_on_charge());
            }
            ForceKind::Formula { bodies, law } => {
                bodies.iter().for_each(|body| electric[body.index()] |= law.depends_on_charge());
            }
            ForceKind::Dipoles(Dipoles { bodies, against, .. }) => {
                bodies.iter().chain(against.iter().flatten()).for_each(|body| magnetic[body.index()] = true);
            }
            ForceKind::J2(J2 { planet, bodies, .. }) => {
                bodies.iter().chain([planet]).for_each(|body| attracts[body.index()] = true);
            }
            ForceKind::Buoyancy { .. } | ForceKind::Spring { .. } => {}
        }
    }
    for (i, (table, body)) in root.bodies().zip(bodies).enumerate() {
        let (name, before) = (table.name(), context.diagnostics.len());
        let mut warn = |key: &KeySpec, why: &str| {
            let warning = Diagnostic::warning(Code::NoEffect, format!("`{key}` of `{name}` has no effect"));
            let span = table.look(|view| view.key_span(key));
            context.diagnostics.extend(span.map(|span| warning.at(span, why)));
        };
        if body.start.fixed && !attracts[i] {
            let why = if body.shape.is_unbounded() { "a plane is always fixed" } else { "it is fixed" };
            [&bodies::body::MASS.spec, &bodies::body::DENSITY.spec]
                .into_iter()
                .for_each(|key| warn(key, why));
        }
        if body.start.charge != 0.0 && !electric[i] {
            warn(&bodies::body::CHARGE.spec, "no force acts on this charge");
        }
        if body.magnetic_moment != DVec3::ZERO && !magnetic[i] {
            warn(&bodies::body::MAGNETIC_MOMENT.spec, "no force acts on this moment");
        }
        context.once(before, name, table.span());
    }
}
