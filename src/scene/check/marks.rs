//! Reads the marks of a scene: `[angle.NAME]`, `[distance.NAME]`, `[area.NAME]`, and the texts and components of arrows.

use glam::DVec3;

use super::label::pieces;
use super::measures::{OwnBody, Reader, Things};
use super::read::figure;
use super::view::View;
use super::{Context, end};
use crate::diagnostic::{Code, Diagnostic, Span, nearest};
use crate::font::{Typeface, Weight};
use crate::lettering;
use crate::physics::{Anchor, BodyId};
use crate::scene::grammar::bodies::body;
use crate::scene::grammar::forces::constant;
use crate::scene::grammar::marks::{angle, area, distance, leg};
use crate::scene::grammar::scene::scene;
use crate::scene::grammar::showing::{arrow, arrows, joint_arrows};
use crate::scene::grammar::{Any, Key, KeySpec, joints};
use crate::scene::source::{Node, Value};
use crate::scene::{
    Angle, Area, ArrowMark, ArrowOwner, Components, Distance, Leg, Piece, Quantity, SimulationSettings,
    Subject, read,
};

/// The vectors of a body that a leg of an angle can point along.
const VECTORS: [Quantity; 3] = Quantity::OF_BODIES;

/// What texts, cameras and lights can name.
#[derive(Clone, Copy)]
pub(super) struct Known<'a, 'b> {
    pub(super) root: &'a View<'b>,
    pub(super) things: Things<'a>,
    pub(super) simulation: &'a SimulationSettings,
}

/// The size up to which a vector counts as zero, relative to the largest that is likely in the run.
const NEGLIGIBLE_VECTOR: f64 = 1e-9;

impl Known<'_, '_> {
    /// The size up to which a vector of a body counts as zero, in SI units. It follows from the initial speeds and from gravity, so it is the
    /// same in all units.
    fn negligible(self, body: usize, quantity: Quantity) -> f64 {
        let (gravity, duration) = (self.simulation.gravity.length(), self.simulation.timeline.duration);
        let speeds = self.things.bodies.iter().map(|body| body.start.velocity.length());
        let speed = speeds.fold(gravity * duration, f64::max);
        let acceleration = if duration > 0.0 { gravity.max(speed / duration) } else { gravity };
        NEGLIGIBLE_VECTOR
            * match quantity {
                Quantity::Velocity => speed,
                Quantity::Acceleration => acceleration,
                _ => self.things.bodies[body].start.mass * acceleration,
            }
    }

    /// Reads the text of a key. `of` is the body whose measures need no name. `None` if the key is missing.
    fn text(
        self,
        view: &View<'_>,
        key: &Key<Option<crate::scene::value::Text>>,
        of: Option<usize>,
        context: &mut Context<'_>,
    ) -> Option<Vec<Piece>> {
        Some(self.pieces(view.get(key).zip(view.span(key))?, of, context))
    }

    /// Reads a text with values. `of` is the body whose measures need no name.
    fn pieces(self, (text, span): (&str, Span), of: Option<usize>, context: &mut Context<'_>) -> Vec<Piece> {
        let own = of.map(|body| OwnBody { body: Subject::One(body), ghosts: false });
        pieces(Reader::new("label", (text, span), self.root, own, self.things, context))
    }
}

pub(super) fn angles(known: Known<'_, '_>, context: &mut Context<'_>) -> Vec<Angle> {
    let read = |(name, span, view): (&str, Span, View<'_>)| {
        let text = known.text(&view, &angle::TEXT, None, context);
        let text = text.unwrap_or_else(|| vec![Piece::Words(usual_text((name, span), context))]);
        let vertex = end::anchor(view.node(&angle::AT)?, context)?;
        let legs = [&angle::FROM, &angle::TO].map(|key| leg_of(&view, key, vertex, known, context));
        let [from, to] = legs;
        Some(Angle {
            name: name.to_owned(),
            vertex,
            legs: [from?, to?],
            axis: view.get(&angle::AXIS),
            radius: view.get(&angle::RADIUS),
            text,
            color: view.get(&angle::COLOR),
        })
    };
    known.root.named(&scene::ANGLE).into_iter().filter_map(read).collect()
}

/// Returns the text of an angle without one, which comes from its name. Reports letters of the name that the font does not have.
fn usual_text((name, span): (&str, Span), context: &mut Context<'_>) -> String {
    let text = Angle::usual_text(name);
    let font = Typeface::usual().font(Weight::Regular);
    if let Some(letter) = text.chars().find(|letter| !font.has(*letter)) {
        let message = format!("the font has no letter `{letter}`");
        let error =
            Diagnostic::error(Code::LabelLetter, message).at(span, "the name is the text of the angle");
        context.diagnostics.push(error.help("another text: `text = \"…\"`"));
    }
    let set = lettering::set(&text, 0..text.len(), &mut None).unwrap_or(text);
    context.fonts.has_bold |= lettering::has_bold(&set);
    set
}

/// Reads a leg of an angle. Reports a leg without a direction.
fn leg_of(
    view: &View<'_>,
    key: &Key<Any>,
    vertex: Anchor,
    known: Known<'_, '_>,
    context: &mut Context<'_>,
) -> Option<Leg> {
    let node = view.node(key)?;
    let leg = direction_of(node, known, context)?;
    if leg == Leg::Towards(vertex) {
        let error = Diagnostic::error(Code::BadMark, "this leg of the angle has no direction");
        context.diagnostics.push(error.at(node.span, "it is the vertex itself"));
        return None;
    }
    Some(leg)
}

/// Reads a direction, such as a leg of an angle.
fn direction_of(node: &Node, known: Known<'_, '_>, context: &mut Context<'_>) -> Option<Leg> {
    Some(match &node.value {
        Value::Array(_) => Leg::Along(DVec3::from_array(read::direction(node).ok()?)),
        Value::Table(table) => {
            let view = View::new(&leg::TABLE, Some(table));
            match view.get(&leg::POINT) {
                Some(point) => Leg::Towards(Anchor::Point(point)),
                None => {
                    let id = BodyId::new(end::body(view.node(&leg::BODY)?, context)?);
                    Leg::Towards(Anchor::Body { id, at: view.get(&leg::AT) })
                }
            }
        }
        _ => named_leg(node, known, context)?,
    })
}

/// Reads a leg that names a body, such as `"bob"`, or a vector of a body, such as `"ball.velocity"`.
fn named_leg(node: &Node, known: Known<'_, '_>, context: &mut Context<'_>) -> Option<Leg> {
    let text = node.as_str()?;
    if let Some(body) = context.names.bodies.get(text) {
        return Some(Leg::Towards(Anchor::centre(BodyId::new(*body))));
    }
    let (name, vector) = text.rsplit_once('.').map_or((text, None), |(name, vector)| (name, Some(vector)));
    let Some(body) = context.names.bodies.get(name).copied() else {
        let error = Diagnostic::error(Code::UnknownName, format!("there is no body `{name}`"));
        let near = nearest(name, known.things.bodies.iter().map(|body| &*body.name).take(1000));
        let label = near.map_or(String::new(), |near| format!("did you mean `{near}`?"));
        context.diagnostics.push(error.at(node.span, label));
        return None;
    };
    let vector = vector.unwrap_or_default();
    let quantity = VECTORS.into_iter().find(|quantity| quantity.name() == vector);
    if quantity.is_none() {
        let message = format!("a body has no vector `{vector}` that gives a direction");
        let names = VECTORS.map(Quantity::name);
        let label = nearest(vector, names).map_or(String::new(), |near| format!("did you mean `{near}`?"));
        let help = format!("there are {}", crate::scene::grammar::quoted(&names));
        context
            .diagnostics
            .push(Diagnostic::error(Code::UnknownName, message).at(node.span, label).help(help));
    }
    let quantity = quantity?;
    Some(Leg::Of { body, quantity, negligible: known.negligible(body, quantity) })
}

pub(super) fn distances(known: Known<'_, '_>, context: &mut Context<'_>) -> Vec<Distance> {
    let read = |(name, _, view): (&str, Span, View<'_>)| {
        let text = known.text(&view, &distance::TEXT, None, context);
        let [first, second] = view.list(&distance::BETWEEN)? else { return None };
        let between = [end::anchor(first, context)?, end::anchor(second, context)?];
        if between[0] == between[1] {
            let error = Diagnostic::error(Code::BadMark, "this distance is always 0");
            context.diagnostics.push(error.at(second.span, "both ends are the same point"));
            return None;
        }
        Some(Distance {
            name: name.to_owned(),
            between,
            along: view.get(&distance::ALONG),
            offset: view.get(&distance::OFFSET),
            text,
            color: view.get(&distance::COLOR),
        })
    };
    known.root.named(&scene::DISTANCE).into_iter().filter_map(read).collect()
}

/// Reads the swept areas. Reports areas that stay 0, and too many sectors.
pub(super) fn areas(known: Known<'_, '_>, context: &mut Context<'_>) -> Vec<Area> {
    let timeline = &known.simulation.timeline;
    let read = |(name, span, view): (&str, Span, View<'_>)| {
        let body = end::body(view.node(&area::BODY)?, context)?;
        let node = view.node(&area::CENTER)?;
        let center = end::anchor(node, context)?;
        if center == Anchor::centre(BodyId::new(body)) {
            let error = Diagnostic::error(Code::BadMark, "this area is always 0");
            context.diagnostics.push(error.at(node.span, "it is the center of the body itself"));
            return None;
        }
        let from = view.get(&area::FROM).unwrap_or(0.0);
        let until = view.get(&area::UNTIL);
        if let Some((until, span)) = until.zip(view.span(&area::UNTIL)).filter(|(until, _)| *until <= from) {
            let message =
                format!("the area `{name}` begins at {} s and ends at {} s", figure(from), figure(until));
            let error = Diagnostic::error(Code::EndBeforeStart, message).at(span, "this must be later");
            context.diagnostics.push(match view.span(&area::FROM) {
                Some(span) => error.at(span, "than this"),
                None => error,
            });
            return None;
        }
        let until = until.unwrap_or(timeline.end());
        let every = view.get(&area::EVERY).unwrap_or(until - from);
        if let Some(span) = view.span(&area::EVERY).filter(|_| (until - from) / every > Area::MAX_SECTORS) {
            let message =
                format!("a sector every {} s is more than {} in all", figure(every), Area::MAX_SECTORS);
            context.diagnostics.push(Diagnostic::error(Code::BadMark, message).at(span, ""));
            return None;
        }
        if from + every > until.min(timeline.end()) + timeline.slack() || every <= 0.0 {
            let keys = [&area::EVERY, &area::UNTIL, &area::FROM];
            let span = keys.into_iter().find_map(|key| view.span(key)).unwrap_or(span);
            let warning =
                Diagnostic::warning(Code::NeverThere, format!("no sector of the area `{name}` is completed"));
            let label = format!("the scene goes from 0 to {} s", figure(timeline.end()));
            context.diagnostics.push(warning.at(span, label));
        }
        let every = if every > 0.0 { every } else { f64::MAX };
        Some(Area { name: name.to_owned(), body, center, from, every, until, color: view.get(&area::COLOR) })
    };
    known.root.named(&scene::AREA).into_iter().filter_map(read).collect()
}

/// Reads the texts and components of arrows.
pub(super) fn arrow_marks(known: Known<'_, '_>, context: &mut Context<'_>) -> Vec<ArrowMark> {
    let mut marks = Vec::new();
    let mut read = |owner: ArrowOwner, arrows: &View<'_>, key: &KeySpec, quantity: Quantity| {
        let Some(view) = arrows.variant(key) else { return };
        let of = match owner {
            ArrowOwner::Body(body) => Some(body),
            ArrowOwner::Joint(_) | ArrowOwner::Force(_) => None,
        };
        let text = known.text(&view, &arrow::LABEL, of, context);
        let mut texts = view.list(&arrow::COMPONENT_LABELS).unwrap_or_default().iter();
        let mut next = || {
            let node = texts.next()?;
            Some(known.pieces((node.as_str()?, node.span), of, context))
        };
        let texts = next().zip(next()).map(|(along, across)| [along, across]);
        let along = view.node(&arrow::COMPONENTS);
        let components = along.and_then(|node| direction_of(node, known, context));
        if let (None, Some(span)) = (along, view.key_span(&arrow::COMPONENT_LABELS)) {
            let message = "`component_labels` has no effect without `components`";
            context.diagnostics.push(Diagnostic::warning(Code::NoEffect, message).at(span, ""));
        }
        let components = components.map(|along| Components { along, texts });
        if text.is_some() || components.is_some() {
            marks.push(ArrowMark { owner, quantity, text, components });
        }
    };
    for (number, body) in known.root.bodies().enumerate() {
        // Most bodies have no arrows. The table of a copy is rebuilt each time that it is read.
        if known.things.bodies.get(number).is_some_and(|body| body.showing.has_arrows()) {
            body.look(|view| {
                let arrows = view.table(&body::ARROWS);
                for quantity in Quantity::OF_BODIES.into_iter().chain(Quantity::OF_LOADS) {
                    let key = arrows::TABLE.key(quantity.name());
                    key.into_iter().for_each(|key| read(ArrowOwner::Body(number), &arrows, key, quantity));
                }
            });
        }
    }
    for (number, (_, _, view)) in known.root.named(&scene::FORCE).into_iter().enumerate() {
        if let Some((_, kind)) = view.chosen() {
            read(ArrowOwner::Force(number), &kind, &constant::ARROW.spec, Quantity::NamedForce);
        }
    }
    for (number, (_, _, view)) in known.root.named(&scene::JOINT).into_iter().enumerate() {
        let arrows = view.chosen().and_then(|(_, kind)| kind.variant(&joints::ball::ARROWS));
        for quantity in Quantity::OF_JOINTS {
            let key = joint_arrows::TABLE.key(quantity.name());
            key.into_iter()
                .zip(&arrows)
                .for_each(|(key, arrows)| read(ArrowOwner::Joint(number), arrows, key, quantity));
        }
    }
    marks
}
