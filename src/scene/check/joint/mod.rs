//! Reads the joints of a scene from `[joint.NAME]`.

mod freedom;
mod rope;
mod swing;

use glam::DVec3;

pub(super) use swing::swing;

use super::Context;
use super::end;
use super::read::figure;
use super::showing;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::{Anchor, Ball, Fixed, Freedom, Hinge, Rod, Servo, Slider};
use crate::scene::grammar::joints::{hinge, joint, look, rod};
use crate::scene::grammar::scene::scene;
use crate::scene::grammar::showing::joint_arrows;
use crate::scene::grammar::{Any, Key};
use crate::scene::source::Node;
use crate::scene::value;
use crate::scene::{Arrow, Body, Joint, JointKind, JointLook, Quantity, SimulationSettings};

/// The largest initial error of a joint's constraint that gives no warning, relative to the size of the joint. Rounding of coordinates
/// with few digits causes larger errors.
const MAX_ERROR_WITHOUT_WARNING: f64 = 1e-9;

/// The initial error of a joint's constraint above which the scene is rejected, relative to the size of the joint. Smaller errors give a
/// warning.
const MAX_ERROR_WITHOUT_REJECTION: f64 = 1e-3;

pub(super) fn read(
    root: &View<'_>,
    bodies: &[Body],
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) -> Vec<Joint> {
    let mut joints: Vec<Joint> = Vec::new();
    let named = root.named(&scene::JOINT);
    // Read gears last, because they couple other joints.
    let (gears, others): (Vec<_>, Vec<_>) =
        named.into_iter().partition(|(_, _, view)| view.variant(&joint::GEAR).is_some());
    let gear_names: Vec<&str> = gears.iter().map(|(name, ..)| *name).collect();
    let method = simulation.method;
    for (name, span, view) in others.into_iter().chain(gears) {
        let before = context.diagnostics.len();
        let mut reader = Reader { name, span, bodies, simulation, gears: &gear_names, context };
        let chosen = KINDS.iter().find_map(|(key, read)| Some((read, view.variant(key)?)));
        let found = chosen.and_then(|(read, view)| read(&mut reader, &view, &joints));
        if found.is_some() && !method.constraints {
            let message = format!("the integrator `{}` keeps no joints", method.name);
            let error = Diagnostic::error(Code::BadJoint, message).at(span, "");
            context.diagnostics.push(error.help("take another one: `simulation.integrator = \"rk4\"`"));
        }
        context.once(before, name, span);
        let Some((kind, servo)) = found else { continue };
        let arrows = arrows(&view);
        let collides = self::kind(&view).is_some_and(|kind| kind.get(&hinge::COLLIDES));
        if simulation.contacts.is_some() && kind.between().iter().any(|end| end.body().is_none()) {
            let before = context.diagnostics.len();
            let key = self::kind(&view).and_then(|kind| kind.key_span(&hinge::COLLIDES));
            let warning =
                Diagnostic::warning(Code::NoEffect, format!("`collides` of `{name}` has no effect"));
            let why = "it joins a body to a point of the world";
            context.diagnostics.extend(key.map(|key| warning.at(key, why)));
            context.once(before, name, span);
        }
        let look = look(&view, &kind);
        joints.push(Joint { name: name.to_owned(), look, collides, kind, servo, arrows });
    }
    joints
}

/// Formats a length with four significant digits.
fn about(length: f64) -> String {
    figure(format!("{length:.3e}").parse().unwrap_or(length))
}

/// Returns the inner table for the kind of a joint, such as `hinge`. `None` if the joint has no kind.
pub(super) fn kind<'a>(joint: &View<'a>) -> Option<View<'a>> {
    Some(joint.chosen()?.1)
}

/// Reads the arrows that show the reaction force and the reaction torque of a joint.
fn arrows(view: &View<'_>) -> [Option<Arrow>; 2] {
    let kind = kind(view);
    let arrow = |quantity: Quantity| {
        showing::arrow(&kind.as_ref()?.table(&hinge::ARROWS), joint_arrows::TABLE.key(quantity.name())?)
    };
    Quantity::OF_JOINTS.map(arrow)
}

/// Reads how a joint is drawn. `None` if the joint is not drawn.
fn look(view: &View<'_>, kind: &JointKind) -> Option<JointLook> {
    if matches!(kind, JointKind::Gear(_)) {
        return None;
    }
    let kind = self::kind(view)?;
    let look = kind.table(&hinge::LOOK);
    (kind.get_as::<value::Text>(&hinge::LOOK) != Some("none"))
        .then(|| JointLook { radius: look.get(&look::RADIUS), color: look.get(&look::COLOR) })
}

/// Reads the table of a joint of one kind, given the joints before it: the joint, and the motor that drives it like a spring.
type Read = fn(&mut Reader<'_, '_>, &View<'_>, &[Joint]) -> Option<(JointKind, Option<Servo>)>;

/// All kinds of joints, each with the function that reads its table. Of a joint with several kinds, which is an error, the first is read.
static KINDS: [(&Key<Any>, Read); 8] = [
    (&joint::HINGE, |reader, view, _| reader.hinge(view)),
    (&joint::SLIDER, |reader, view, _| reader.slider(view)),
    (&joint::ROD, |reader, view, _| Some((JointKind::Rod(reader.rod(view)?), None))),
    (&joint::BALL, |reader, view, _| Some((JointKind::Ball(reader.ball(view)?), None))),
    (&joint::ROPE, |reader, view, _| Some((JointKind::Rope(reader.rope(view)?), None))),
    (&joint::PULLEY, |reader, view, _| Some((JointKind::Pulley(reader.pulley(view)?), None))),
    (&joint::GEAR, |reader, view, joints| Some((JointKind::Gear(reader.gear(view, joints)?), None))),
    (&joint::FIXED, |reader, view, _| Some((JointKind::Fixed(reader.fixed(view)?), None))),
];

/// Reads one joint.
struct Reader<'a, 'c> {
    name: &'a str,
    span: Span,
    bodies: &'a [Body],
    simulation: &'a SimulationSettings,
    /// The names of all gears in the scene.
    gears: &'a [&'a str],
    context: &'a mut Context<'c>,
}

impl Reader<'_, '_> {
    fn hinge(&mut self, view: &View<'_>) -> Option<(JointKind, Option<Servo>)> {
        let (between, _) = self.joined(view, true)?;
        let axis = view.get(&hinge::AXIS)?.normalize();
        let axis = self.in_axes_of(between[0], axis);
        let joint = Hinge::new(between, axis, self.turned(between));
        let (freedom, servo) = self.freedom(view, joint.coordinate());
        Some((JointKind::Hinge(joint.with(freedom)), servo))
    }

    fn slider(&mut self, view: &View<'_>) -> Option<(JointKind, Option<Servo>)> {
        let (between, _) = self.joined(view, false)?;
        let axis = view.get(&hinge::AXIS)?.normalize();
        let axis = self.in_axes_of(between[0], axis);
        let turned = self.turned(between);
        let joint = Slider { between, axis, turned, freedom: Freedom::default() };
        let (freedom, servo) = self.freedom(view, joint.coordinate());
        Some((JointKind::Slider(Slider { freedom, ..joint }), servo))
    }

    fn ball(&mut self, view: &View<'_>) -> Option<Ball> {
        let (between, _) = self.joined(view, true)?;
        Some(Ball { between })
    }

    fn fixed(&mut self, view: &View<'_>) -> Option<Fixed> {
        let (between, _) = self.joined(view, false)?;
        Some(Fixed { between, turned: self.turned(between) })
    }

    fn rod(&mut self, view: &View<'_>) -> Option<Rod> {
        let (between, nodes) = self.ends(view, &[])?;
        let [from, to] = between.map(|anchor| end::place(anchor, self.bodies));
        let distance = from.distance(to);
        let length = view.get(&rod::LENGTH).unwrap_or(distance);
        if distance == 0.0 {
            let message = format!("the ends of the rod `{}` are at the same place", self.name);
            let help = "a joint without length is a `ball`";
            self.refuse(message, nodes[1].span, "where the other end is", help);
            return None;
        }
        let missing = (distance - length).abs();
        let span = view.span(&rod::LENGTH).unwrap_or(self.span);
        let what = format!(
            "its ends are {} m apart at the start",
            figure(format!("{distance:.9}").parse().unwrap_or(distance))
        );
        self.fits(missing, length, span, &what);
        Some(Rod { between, length })
    }

    /// Reads the ends of a joint that connects two bodies at a common point, and returns them with this point in world coordinates. The
    /// point comes from the key `at`, or else from the first end that gives a point. If neither exists and `needs_place` is false, the
    /// point is the center of the second end.
    fn joined(&mut self, view: &View<'_>, needs_place: bool) -> Option<([Anchor; 2], DVec3)> {
        let (mut between, nodes) = self.ends(view, &[])?;
        let bodies = self.bodies;
        let says: [bool; 2] =
            std::array::from_fn(|i| matches!(between[i], Anchor::Point(_)) || end::says_point(nodes[i]));
        let places = between.map(|anchor| end::place(anchor, bodies));
        let at = view.get(&hinge::AT);
        let point = match (at, says) {
            (Some(at), _) => at,
            (None, [true, _]) => places[0],
            (None, [false, true]) => places[1],
            // The unknown key may be a misspelled `at`. It has already been reported.
            (None, [false, false]) if needs_place && view.has_unknown() => return None,
            (None, [false, false]) if needs_place => {
                let [a, b] = places;
                let message = format!("the joint `{}` does not say where it is", self.name);
                let error = Diagnostic::error(Code::MissingKey, message).at(self.span, "needs `at`");
                let [x, y, z] = ((a + b) / 2.0).to_array().map(about);
                let help =
                    format!("a point of the world at the start, such as `at = [{x}, {y}, {z}]`, half-way");
                self.context.diagnostics.push(error.help(help));
                return None;
            }
            (None, [false, false]) => places[1],
        };
        for i in 0..2 {
            if !says[i] {
                between[i] = self.on(between[i], point);
                continue;
            }
            let missing = places[i].distance(point);
            let other = if at.is_some() { "`at`" } else { "the other end" };
            let what = format!("this end is {} m from {other} at the start", about(missing));
            let arm =
                |anchor: Anchor| anchor.body().map_or(0.0, |id| end::pose(id, bodies).0.distance(point));
            let size = between.map(arm).into_iter().fold(missing, f64::max);
            self.fits(missing, size, nodes[i].span, &what);
        }
        Some((between, point))
    }

    /// Reports a joint whose constraint is violated at the start: an error if the distance `missing` is large relative to `size`, a
    /// warning if it is small.
    fn fits(&mut self, missing: f64, size: f64, span: Span, what: &str) {
        let name = self.name;
        if missing > MAX_ERROR_WITHOUT_REJECTION * size {
            let message =
                format!("the joint `{name}` does not hold at the start: {} m are missing", about(missing));
            let error = Diagnostic::error(Code::JointApart, message).at(span, what);
            self.context.diagnostics.push(error);
        } else if missing > MAX_ERROR_WITHOUT_WARNING * size {
            let message = format!(
                "the joint `{name}` holds only nearly at the start: {} m are missing",
                about(missing)
            );
            let warning = Diagnostic::warning(Code::JointApart, message).at(span, what);
            self.context
                .diagnostics
                .push(warning.help("its bodies are moved the shortest way to where it holds"));
        }
    }

    /// Reads the two ends of a joint. At least one of them, or of the points `over` which a rope runs, must be able to move, and not all of
    /// them may be on one body.
    fn ends<'n>(&mut self, view: &View<'n>, over: &[Anchor]) -> Option<([Anchor; 2], [&'n Node; 2])> {
        let [first, second] = view.list(&hinge::BETWEEN)? else { return None };
        let between = [end::anchor(first, self.context)?, end::anchor(second, self.context)?];
        let moves = |end: &Anchor| {
            end.body().is_some_and(|id| {
                let body = &self.bodies[id.index()];
                !body.start.fixed && body.motion.is_none()
            })
        };
        let all = || between.iter().chain(over);
        let is_same = between[0].body().is_some() && all().all(|end| end.body() == between[0].body());
        let (span, why, help) = if is_same {
            (second.span, "the same body as the end before it", "a joint has two different ends")
        } else if !all().any(moves) {
            (first.span, "neither end can move", "one end at least must be a body that forces can move")
        } else {
            return Some((between, [first, second]));
        };
        self.refuse(format!("the joint `{}` cannot hold anything", self.name), span, why, help);
        None
    }

    /// Adds an error about an impossible joint.
    fn refuse(&mut self, message: String, span: Span, why: &str, help: &str) {
        let error = Diagnostic::error(Code::BadJoint, message).at(span, why).help(help);
        self.context.diagnostics.push(error);
    }

    /// Returns the given world point as an end of the joint: as the point of the end's body that coincides with the world point at the
    /// start, or as the world point itself if the end has no body.
    fn on(&self, end: Anchor, point: DVec3) -> Anchor {
        match end {
            Anchor::Body { id, .. } => {
                let (location, orientation) = end::pose(id, self.bodies);
                Anchor::Body { id, at: orientation.conjugate() * (point - location) }
            }
            Anchor::Point(_) => Anchor::Point(point),
        }
    }

    /// Converts a direction from world axes to the initial body axes of an end.
    fn in_axes_of(&self, end: Anchor, direction: DVec3) -> DVec3 {
        end.body().map_or(direction, |id| end::pose(id, self.bodies).1.conjugate() * direction)
    }

    /// Returns the initial rotation from the body axes of the first end to those of the second end.
    fn turned(&self, between: [Anchor; 2]) -> glam::DQuat {
        let turn = |end: Anchor| end.body().map_or(glam::DQuat::IDENTITY, |id| end::pose(id, self.bodies).1);
        turn(between[1]).conjugate() * turn(between[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::grammar::Rule;

    #[test]
    fn each_kind_of_joint_in_the_grammar_is_read() {
        let Rule::ExactlyOne(names) = joint::TABLE.rule else { panic!("a joint has one kind") };
        let read: Vec<&str> = KINDS.iter().map(|(key, _)| key.spec.name).collect();
        assert!(names.iter().all(|name| read.contains(name)), "{names:?} {read:?}");
        assert_eq!(names.len(), read.len());
    }
}
