//! Reads the drawings of fields from `[field.NAME]`.

use super::Context;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::marks::field;
use crate::scene::grammar::scene::scene;
use crate::scene::{DrawnField, FieldStyle, Force, ForceKind};

/// Returns the fields that the scene draws. Reports a force without a field.
pub(super) fn read(root: &View<'_>, forces: &[Force], context: &mut Context<'_>) -> Vec<DrawnField> {
    let read = |(name, _, view): (&str, Span, View<'_>)| {
        let of = view.get(&field::FORCE)?;
        let force = forces.iter().position(|force| force.name == of)?;
        let drawn = DrawnField {
            name: name.to_owned(),
            force,
            is_magnetic: view.get(&field::MAGNETIC),
            style: view.choice(&field::SHOW, FieldStyle::ALL, FieldStyle::name),
            at: view.get(&field::AT),
            normal: view.get(&field::NORMAL),
            spacing: view.get(&field::SPACING),
            scale: view.get(&field::SCALE),
            count: u32::try_from(view.get(&field::COUNT)).unwrap_or(1),
            color: view.get(&field::COLOR),
        };
        check(&view, &drawn, &forces[force].kind, context);
        Some(drawn)
    };
    root.named(&scene::FIELD).into_iter().filter_map(read).collect()
}

/// Reports what a force cannot show, and keys without an effect.
fn check(view: &View<'_>, drawn: &DrawnField, force: &ForceKind, context: &mut Context<'_>) {
    let is_magnetic = drawn.is_magnetic || matches!(force, ForceKind::Dipoles(_));
    let mut refuse = |span: Option<Span>, message: &str, label: &str| {
        let error = Diagnostic::error(Code::BadField, message);
        context.diagnostics.extend(span.map(|span| error.at(span, label)));
    };
    let at_force = view.span(&field::FORCE);
    match force {
        ForceKind::Spring { .. } => {
            refuse(at_force, "a spring has no field", "it acts only on the bodies at its ends");
        }
        ForceKind::Buoyancy { .. } => {
            refuse(at_force, "buoyancy has no field", "it depends on the volume of a body");
        }
        _ => {}
    }
    let has_magnetic_field = match force {
        ForceKind::OnEach(force) => force.magnetic_field().is_some(),
        force => matches!(force, ForceKind::Dipoles(_)),
    };
    if drawn.is_magnetic && !has_magnetic_field {
        let label = "only a `lorentz` force and magnets have one";
        refuse(view.span(&field::MAGNETIC), "this force has no magnetic field", label);
    } else if drawn.style == FieldStyle::Levels {
        let has_potential = match force {
            ForceKind::OnEach(force) => force.has_levels() && !is_magnetic,
            ForceKind::Formula { law, .. } => law.has_potential(),
            _ => !is_magnetic,
        };
        if !has_potential {
            refuse(view.span(&field::SHOW), "this field has no potential", "draw arrows or lines");
        }
    }
    let mut useless = |key: Option<Span>, style: &str| {
        let warning = Diagnostic::warning(Code::NoEffect, "this key has no effect here");
        context.diagnostics.extend(key.map(|span| warning.at(span, format!("only {style} have it"))));
    };
    if drawn.style != FieldStyle::Arrows {
        useless(view.key_span(&field::SPACING), "arrows");
        useless(view.key_span(&field::SCALE), "arrows");
    }
    if drawn.style != FieldStyle::Lines {
        useless(view.key_span(&field::COUNT), "lines");
    }
}
