//! Reads the physical quantities that are drawn beside a body or a spring, such as arrows and trails.

use super::Context;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::Shape;
use crate::scene::grammar::KeySpec;
use crate::scene::grammar::bodies::body;
use crate::scene::grammar::forces::spring;
use crate::scene::grammar::showing::{arrow, arrows, axes, coil, ghosts, trail};
use crate::scene::{
    Arrow, BodyAxes, Ghosts, Quantity, Showing, SimulationSettings, SpringLine, SpringLook, Trail,
};

/// The keys for what is drawn with a moving body.
static MOVING_KEYS: [&KeySpec; 3] = [&body::ARROWS.spec, &body::GHOSTS.spec, &body::TRAIL.spec];
/// The keys for what is drawn with any body.
static SHOWING_KEYS: [&KeySpec; 4] =
    [&body::ARROWS.spec, &body::AXES.spec, &body::GHOSTS.spec, &body::TRAIL.spec];
/// The maximum number of ghosts of a body, which are its drawn past positions.
const MAX_GHOSTS: f64 = 10_000.0;

/// Reads the arrows, axes, ghosts and trail of a body. Warns of keys that have no effect for a plane or a fixed body.
pub(super) fn of_body(
    name: &str,
    view: &View<'_>,
    shape: &Shape,
    fixed: bool,
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) -> Showing {
    let useless = match (shape.is_unbounded(), fixed) {
        (true, _) => Some((&SHOWING_KEYS[..], "a plane is endless")),
        (false, true) => Some((&MOVING_KEYS[..], "it is fixed")),
        _ => None,
    };
    let mut showing = Showing {
        arrows: Quantity::OF_BODIES
            .map(|quantity| arrow(&view.table(&body::ARROWS), arrows::TABLE.key(quantity.name())?)),
        loads: Quantity::OF_LOADS
            .map(|quantity| arrow(&view.table(&body::ARROWS), arrows::TABLE.key(quantity.name())?)),
        axes: wanted(view, &body::AXES).map(|axes| BodyAxes { length: axes.get(&axes::LENGTH) }),
        ghosts: view.variant(&body::GHOSTS).and_then(|ghosts| ghosts_of(&ghosts, simulation, context)),
        trail: wanted(view, &body::TRAIL).map(|trail| Trail {
            duration: trail.get(&trail::DURATION),
            width: trail.get(&trail::WIDTH),
            color: trail.get(&trail::COLOR),
            at: trail.get(&trail::AT),
        }),
    };
    if useless.is_none() {
        loads_without_cause(name, &view.table(&body::ARROWS), &showing, simulation, context);
    }
    if let Some((keys, why)) = useless {
        let is_asked = |key: &KeySpec| match key.name {
            name if name == body::ARROWS.spec.name => showing.has_arrows(),
            name if name == body::AXES.spec.name => showing.axes.is_some(),
            name if name == body::GHOSTS.spec.name => view.variant(&body::GHOSTS).is_some(),
            _ => showing.trail.is_some(),
        };
        for key in keys.iter().filter(|key| is_asked(key)) {
            let message = format!("`{}` of `{name}` has no effect", key.name);
            let warning = Diagnostic::warning(Code::NoEffect, message);
            context.diagnostics.extend(view.key_span(key).map(|span| warning.at(span, why)));
        }
        showing = Showing { axes: showing.axes.filter(|_| !shape.is_unbounded()), ..Showing::default() };
    }
    showing
}

/// Reports arrows for loads that cannot exist: warns of a weight without gravity, and reports an error for contact forces without
/// contacts.
fn loads_without_cause(
    name: &str,
    view: &View<'_>,
    showing: &Showing,
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) {
    let [weight, normal, friction] = showing.loads;
    if weight.is_some() && simulation.gravity == glam::DVec3::ZERO {
        let warning =
            Diagnostic::warning(Code::NoEffect, format!("`arrows.weight` of `{name}` has no effect"));
        let why = "there is no `simulation.gravity`";
        context.diagnostics.extend(view.key_span(&arrows::WEIGHT).map(|span| warning.at(span, why)));
    }
    if simulation.contacts.is_some() {
        return;
    }
    let loads = [(&arrows::NORMAL, normal), (&arrows::FRICTION, friction)];
    for (key, _) in loads.iter().filter(|(_, arrow)| arrow.is_some()) {
        let error = Diagnostic::error(
            Code::NoContacts,
            format!("`arrows.{}` needs `simulation.contacts`", key.spec.name),
        )
        .help("write `contacts = \"event-driven\"` in [simulation]");
        let why = "without it, bodies pass through each other";
        context.diagnostics.extend(view.key_span(*key).map(|span| error.at(span, why)));
    }
}

/// Reads the ghosts of a body. Reports an error and returns `None` if there are too many ghosts.
fn ghosts_of(view: &View<'_>, simulation: &SimulationSettings, context: &mut Context<'_>) -> Option<Ghosts> {
    let every = view.get(&ghosts::EVERY)?;
    if simulation.timeline.duration / every <= MAX_GHOSTS {
        return Some(Ghosts { every, arrows: view.get(&ghosts::ARROWS) });
    }
    let message = format!("a ghost every {} s is more than {MAX_GHOSTS} in all", super::read::figure(every));
    let error = Diagnostic::error(Code::TooManyGhosts, message);
    let span = view.span(&ghosts::EVERY);
    context.diagnostics.extend(span.map(|span| error.at(span, "").help("ghosts = duration / every")));
    None
}

/// Reads an arrow's scale and color. `None` if the scene does not switch the arrow on.
pub(super) fn arrow(arrows: &View<'_>, key: &KeySpec) -> Option<Arrow> {
    let arrow = wanted(arrows, key)?;
    Some(Arrow { scale: arrow.get(&arrow::SCALE), color: arrow.get(&arrow::COLOR) })
}

/// Reads how a spring is drawn. `None` if the spring is not drawn.
pub(super) fn spring(spring: &View<'_>, context: &mut Context<'_>) -> Option<SpringLook> {
    let coil = spring.table(&spring::COIL);
    let mut useless = |span: Option<Span>, key: &str, why: &str| {
        let warning = Diagnostic::warning(Code::NoEffect, format!("`{key}` of a spring has no effect"));
        context.diagnostics.extend(span.map(|span| warning.at(span, why)));
    };
    let is_hidden = spring.get_as::<bool>(&spring::COIL) == Some(false);
    let line = spring.get(&spring::LINE);
    match line {
        "none" => {
            if !is_hidden {
                useless(spring.key_span(&spring::COIL), "coil", "with `line = \"none\"`, it is not drawn");
            }
            return None;
        }
        _ if is_hidden => {
            useless(spring.key_span(&spring::LINE), "line", "with `coil = false`, it is not drawn");
            return None;
        }
        "straight" => {
            useless(coil.key_span(&coil::TURNS), "coil.turns", "it is drawn as a straight line");
        }
        _ => {}
    }
    let turns = coil.get(&coil::TURNS);
    Some(SpringLook {
        line: if line == "straight" { SpringLine::Straight } else { SpringLine::Coil { turns } },
        radius: coil.get(&coil::RADIUS),
        color: coil.get(&coil::COLOR),
    })
}

/// Returns the table under a key that takes `true` or a table. The table is empty for `true`. `None` if the value is `false` or the key is
/// missing.
pub(super) fn wanted<'a>(view: &View<'a>, key: impl AsRef<KeySpec>) -> Option<View<'a>> {
    let key = key.as_ref();
    (view.get_as::<bool>(key) == Some(true) || view.variant(key).is_some()).then(|| view.table(key))
}
