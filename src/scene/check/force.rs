//! `[force.NAME]`.

use glam::DVec3;

use super::view::View;
use super::{Context, read};
use crate::diagnostic::Diagnostic;
use crate::scene::grammar::Bound;
use crate::scene::source::{Node, Value};
use crate::scene::{Body, Force, ForceKind, SpringEnd};

pub(super) fn read(root: &View<'_>, bodies: &[Body], context: &mut Context<'_>) -> Vec<Force> {
    let tables = root.named("force");
    let read = |(name, _, view): (&str, _, View<'_>)| {
        let constant = view.variant("constant").map(|view| constant(&view, bodies, context));
        let kind =
            constant.or_else(|| view.variant("spring").and_then(|view| spring(&view, bodies, context)));
        kind.map(|kind| Force { name: name.to_owned(), kind })
    };
    tables.into_iter().filter_map(read).collect()
}

fn constant(view: &View<'_>, bodies: &[Body], context: &mut Context<'_>) -> ForceKind {
    let movable = || (0..bodies.len()).filter(|&i| !bodies[i].start.fixed).collect();
    let on = match view.list("on") {
        None => movable(),
        Some(items) => {
            let mut on: Vec<usize> = Vec::with_capacity(items.len());
            for item in items {
                let Some(body) = named_body(item, context) else { continue };
                if on.contains(&body) {
                    let message = format!("the body `{}` is named twice", bodies[body].name);
                    context
                        .diagnostics
                        .push(Diagnostic::error("named-twice", message).at(item.span, "the second time"));
                } else if bodies[body].start.fixed {
                    let message = format!("the force has no effect on `{}`", bodies[body].name);
                    context
                        .diagnostics
                        .push(Diagnostic::warning("no-effect", message).at(item.span, "it is fixed"));
                }
                on.push(body);
            }
            on
        }
    };
    ForceKind::Constant {
        on,
        force: view.vector("force").unwrap_or(DVec3::ZERO),
        torque: view.vector("torque").unwrap_or(DVec3::ZERO),
    }
}

fn spring(view: &View<'_>, bodies: &[Body], context: &mut Context<'_>) -> Option<ForceKind> {
    let [first, second] = view.list("between")? else { return None };
    let between = [end(first, context)?, end(second, context)?];
    let moves = |end: SpringEnd| matches!(end, SpringEnd::Body(i) if !bodies[i].start.fixed);
    if between[0] == between[1] {
        let error = Diagnostic::error("spring-ends", "both ends of the spring are at the same place");
        context.diagnostics.push(error.at(second.span, "the same as the first end"));
    } else if !between.into_iter().any(moves) {
        let error = Diagnostic::error("spring-ends", "neither end of the spring can move");
        let error = error.at(first.span, "").at(second.span, "");
        context.diagnostics.push(error.help("one end at least must be a body that is not fixed"));
    }
    let place = |end: SpringEnd| match end {
        SpringEnd::Body(i) => bodies[i].start.location,
        SpringEnd::Point(point) => point,
    };
    Some(ForceKind::Spring {
        between,
        stiffness: view.number("stiffness").unwrap_or(0.0),
        damping: view.number("damping").unwrap_or(0.0),
        rest_length: view
            .number("rest_length")
            .unwrap_or_else(|| place(between[0]).distance(place(between[1]))),
    })
}

fn end(node: &Node, context: &Context<'_>) -> Option<SpringEnd> {
    match node.value {
        Value::Array(_) => read::vector(node, Bound::Any).map(SpringEnd::Point),
        _ => named_body(node, context).map(SpringEnd::Body),
    }
}

fn named_body(node: &Node, context: &Context<'_>) -> Option<usize> {
    node.as_str().and_then(|name| context.names.bodies.get(name)).copied()
}
