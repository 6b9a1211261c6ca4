//! Reads and checks the collisions of bodies: the key `simulation.contacts`, and the keys that need it.

use std::sync::Arc;

use super::Context;
use super::corrections::{before, is_file};
use super::read::figure;
use super::stepping;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::{Shape, Surface};
use crate::scene::grammar::KeySpec;
use crate::scene::grammar::bodies::body;
use crate::scene::grammar::emitters::emitter;
use crate::scene::grammar::joints::hinge;
use crate::scene::grammar::scene::{environment, scene, simulation};
use crate::scene::grammar::shapes::shape;
use crate::scene::{Body, Collider, ContactLaw, Environment, Ground, SimulationSettings};

/// The keys for the surface properties of a body or of the ground.
static SURFACE_KEYS: [&KeySpec; 3] =
    [&body::RESTITUTION.spec, &body::FRICTION.spec, &body::ROLLING_FRICTION.spec];
/// The keys of a body that have an effect only if `simulation.contacts` is set.
static OF_BODIES: [&KeySpec; 5] = [
    &body::RESTITUTION.spec,
    &body::FRICTION.spec,
    &body::ROLLING_FRICTION.spec,
    &body::COLLIDES.spec,
    &body::COLLISION_GROUP.spec,
];

/// The largest initial depth below the ground that counts as a rounding error, relative to the sum of the body's extent downwards and its
/// largest coordinate. The dynamics tolerates the same overlap between bodies.
const RELATIVE_ROUNDING: f64 = 1e-9;

/// Reads the contact law from `simulation.contacts`. `None` if the scene has no contacts.
pub(super) fn law(simulation: &View<'_>) -> Option<ContactLaw> {
    let word = simulation.get(&simulation::CONTACTS)?;
    ContactLaw::ALL.into_iter().find(|law| law.name() == word)
}

/// Reads how a body collides: its surface and its collision group. `None` if the body does not collide.
pub(super) fn collider(
    name: &str,
    view: &View<'_>,
    shape: &Shape,
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) -> Option<Collider> {
    // Without contacts, no body collides. `check` reports the keys that need contacts.
    simulation.contacts?;
    let mut has_no_effect = |keys: &[&KeySpec], why: &str| {
        for key in keys {
            let message = format!("`{}` of `{name}` has no effect", key.name);
            let warning = Diagnostic::warning(Code::NoEffect, message);
            context.diagnostics.extend(view.key_span(key).map(|span| warning.at(span, why)));
        }
    };
    let collides = view.get(&body::COLLIDES);
    if matches!(shape, Shape::Axes { .. }) {
        let keys = if collides == Some(false) { &OF_BODIES[..3] } else { &OF_BODIES[..] };
        has_no_effect(keys, "axes do not collide");
        return None;
    }
    if collides == Some(false) {
        has_no_effect(&SURFACE_KEYS, "it does not collide");
        has_no_effect(&[&body::COLLISION_GROUP.spec], "it does not collide");
        return None;
    }
    if simulation.contacts == Some(ContactLaw::EventDriven) && shape.has_torus() {
        let message = format!("contacts of `{name}` cannot be computed");
        let error = Diagnostic::error(Code::BadContacts, message);
        let help = "take a `cylinder` with the ring's `inertia` and `look`, a `compound` of capsules, or let others pass through \
                    it: `collides = false`; `simulation.contacts = \"time-stepping\"` takes it as a ring of capsules";
        let span = view.table(&body::SHAPE).key_span(&shape::TORUS).or(view.key_span(&body::SHAPE));
        let error = error.help(help);
        context.diagnostics.push(match span {
            Some(span) => error.at(span, "no distance is computed for a torus"),
            None => error,
        });
    }
    Some(Collider { surface: surface(view), group: view.get(&body::COLLISION_GROUP) })
}

/// Reads the surface properties of a body or of the ground.
fn surface(view: &View<'_>) -> Surface {
    Surface {
        restitution: view.get(&body::RESTITUTION),
        friction: view.get(&body::FRICTION),
        rolling_friction: view.get(&body::ROLLING_FRICTION),
    }
}

/// Prepares the ground for contacts: sets a missing height to 0, and adds the surface that stops bodies.
pub(super) fn ground(root: &View<'_>, simulation: &SimulationSettings, environment: &mut Environment) {
    if let (Some(_), Some(ground)) = (simulation.contacts, &mut environment.ground) {
        let table = root.table(&scene::ENVIRONMENT).variant(&environment::GROUND);
        ground.height = Some(ground.height.unwrap_or(0.0));
        ground.surface = Some(table.map_or(Surface::default(), |table| surface(&table)));
    }
}

/// Without contacts, reports keys that need contacts. With contacts, reports integrators and bodies that do not support contacts, and
/// bodies that begin below the ground.
pub(super) fn check(
    root: &View<'_>,
    simulation: &SimulationSettings,
    bodies: &[Body],
    environment: &Environment,
    context: &mut Context<'_>,
) {
    let table = root.table(&scene::SIMULATION);
    // If the value of `contacts` is wrong, another error reports it. Do not also report the keys that need `contacts`.
    if simulation.contacts.is_none() && !table.has(&simulation::CONTACTS) {
        needed(root, &table, context);
    }
    let Some(span) = table.span(&simulation::CONTACTS).filter(|_| simulation.contacts.is_some()) else {
        return;
    };
    if simulation.contacts == Some(ContactLaw::TimeStepping) {
        stepping::check(root, simulation, bodies, context);
    } else if !simulation.method.constraints {
        let message = format!("the integrator `{}` cannot compute contacts", simulation.method.name);
        let error = Diagnostic::error(Code::BadContacts, message).at(span, "");
        context
            .diagnostics
            .push(error.help("take another one: `simulation.integrator = \"velocity-verlet\"`"));
    }
    if let Some(ground) = &environment.ground {
        below(root, bodies, ground, context);
    }
}

/// Reports each key that needs `simulation.contacts`, once per source span. The first error has a fix that adds the missing line.
fn needed(root: &View<'_>, simulation: &View<'_>, context: &mut Context<'_>) {
    let mut wrong: Vec<(&KeySpec, Span)> = Vec::new();
    for body in root.bodies() {
        body.look(|view| {
            // Without contacts, `collides = false` is true anyway.
            let says_no = view.get(&body::COLLIDES) == Some(false);
            let keys = OF_BODIES.iter().filter(|key| !(says_no && key.name == body::COLLIDES.spec.name));
            wrong.extend(keys.filter_map(|key| Some((*key, view.key_span(key)?))));
        });
    }
    for (_, _, joint) in root.named(&scene::JOINT) {
        let kind = super::joint::kind(&joint).filter(|kind| kind.get(&hinge::COLLIDES));
        let span = kind.and_then(|kind| kind.key_span(&hinge::COLLIDES));
        wrong.extend(span.map(|span| (&hinge::COLLIDES.spec, span)));
    }
    if let Some(ground) = root.table(&scene::ENVIRONMENT).variant(&environment::GROUND) {
        wrong.extend(SURFACE_KEYS.iter().filter_map(|key| Some((*key, ground.key_span(key)?))));
    }
    let bodies = "without it, bodies pass through each other";
    let mut wrong: Vec<(&KeySpec, Span, &str)> =
        wrong.into_iter().map(|(key, span)| (key, span, bodies)).collect();
    for (_, _, view) in root.named(&scene::EMITTER) {
        let span = view.key_span(&emitter::COLLIDES).filter(|_| view.get(&emitter::COLLIDES));
        wrong.extend(
            span.map(|span| (&emitter::COLLIDES.spec, span, "without it, particles pass through bodies")),
        );
    }
    let mut said: Vec<Span> = Vec::new();
    for (key, span, label) in wrong {
        if said.contains(&span) {
            continue;
        }
        let message = format!("`{}` needs `simulation.contacts`", key.name);
        let error = Diagnostic::error(Code::NoContacts, message)
            .at(span, label)
            .help("write `contacts = \"event-driven\"` in [simulation]");
        let fix = said.is_empty().then(|| insertion(root, simulation, span, context));
        said.push(span);
        context.diagnostics.push(match fix {
            Some((place, text)) => error.fix(place, text),
            None => error,
        });
    }
}

/// Returns the source span at which the line for `simulation.contacts` is to be inserted, and the text to insert.
fn insertion(root: &View<'_>, simulation: &View<'_>, at: Span, context: &Context<'_>) -> (Span, String) {
    /// The line that turns on event-driven contacts.
    const CONTACTS_LINE: &str = "contacts = \"event-driven\"";
    let keys = [
        &simulation::DURATION.spec,
        &simulation::FRAME_RATE.spec,
        &simulation::STEP.spec,
        &simulation::INTEGRATOR.spec,
        &simulation::GRAVITY.spec,
    ];
    let mut spans = keys.into_iter().filter_map(|key| simulation.key_span(key));
    if let Some(span) = spans.find(|span| is_file(span.source(), &context.sources)) {
        return before(span, CONTACTS_LINE, context);
    }
    match root.key_span(&scene::SIMULATION).filter(|span| is_file(span.source(), &context.sources)) {
        // The `[simulation]` table is empty: insert the line below its header.
        Some(span) => {
            (span.place_after(context.sources.line_after(span).len()), format!("\n{CONTACTS_LINE}"))
        }
        None => (at.top_of_text(), format!("simulation.{CONTACTS_LINE}\n")),
    }
}

/// Reports free bodies that begin below the ground.
fn below(root: &View<'_>, bodies: &[Body], ground: &Ground, context: &mut Context<'_>) {
    let Some(height) = ground.height else { return };
    for (table, body) in root.bodies().zip(bodies) {
        let is_free = body.collider.is_some() && !body.start.fixed && body.motion.is_none();
        let Some(reach) = body.shape.support(body.start.orientation, -glam::DVec3::Y).filter(|_| is_free)
        else {
            continue;
        };
        let lowest = body.start.location.y - reach;
        if height - lowest <= RELATIVE_ROUNDING * (body.start.location.abs().max_element() + reach.abs()) {
            continue;
        }
        if table.look(|view| view.table(&body::SHAPE).has_unknown()) {
            // A placeholder replaces the unknown shape.
            continue;
        }
        let before = context.diagnostics.len();
        let name = table.name();
        let message = format!("`{name}` begins below the ground");
        let depth = about(height - lowest);
        let label =
            format!("its lowest point is {depth} m below the ground, which is at {} m", figure(height));
        let help = "put it higher, or give the ground another height with `environment.ground.height`, or take it away \
                    with `environment.ground = false`";
        let span = table.look(|view| view.span(&body::LOCATION)).unwrap_or(table.span());
        context.diagnostics.push(Diagnostic::error(Code::BelowGround, message).at(span, label).help(help));
        context.once(before, name, table.span());
    }
}

/// Formats a length with four significant digits.
fn about(length: f64) -> String {
    figure(format!("{length:.3e}").parse().unwrap_or(length))
}

/// Returns the collider of a body. If it equals the collider of the preceding body, both bodies share one allocation.
pub(super) fn shared(last: Option<&Body>, collider: Option<Collider>) -> Option<Arc<Collider>> {
    let collider = collider?;
    let same = last.and_then(|body| body.collider.as_ref()).filter(|last| ***last == collider);
    Some(same.map_or_else(|| Arc::new(collider), Arc::clone))
}
