//! Springs and joints as drawn: coils, rods, ropes, pins and rails.
//!
//! Their parts are planned once for a run (`plan`). Each frame gives their positions.

mod plan;

use glam::{DQuat, DVec3};

use super::catenary::hanging;
use super::pulley::{Course, Turn};
use crate::dynamics::{Anchor, Pulley, Shape};
use crate::scene::{Body, Color, Scene};
use crate::simulate::{Frame, Survey, surface};

/// The radius of the wire of a coil, as part of the coil's radius.
const WIRE: f64 = 0.14;

/// A part of a spring or of a joint, as it is drawn in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Link<'a> {
    /// The name of the force or the joint in the scene.
    pub name: &'a str,
    /// The form and its position.
    pub form: LinkForm,
    /// Its color.
    pub color: Color,
}

/// A part of a spring or of a joint, whether it is drawn in a frame or not.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedLink<'a> {
    /// The name of the force or the joint in the scene.
    pub name: &'a str,
    /// Its kind.
    pub kind: LinkKind,
    /// Its color.
    pub color: Color,
}

/// The kind of a part of a spring or a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LinkKind {
    /// A ball.
    Pin,
    /// A coil.
    Coil {
        /// The number of its turns.
        turns: u32,
        /// The radius of its wire, in radii of the coil.
        wire: f64,
    },
    /// A straight bar.
    Rod,
    /// A rope.
    Rope,
}

/// The form of a part of a spring or a joint. Lengths are in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum LinkForm {
    /// A ball: a pin, or the end of a spring or a rod at a point of the world.
    Pin {
        /// Its centre.
        at: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// The coil of a spring.
    Coil {
        /// Its two ends.
        ends: [DVec3; 2],
        /// Its radius.
        radius: f64,
        /// The radius of its wire.
        wire: f64,
        /// The number of its turns.
        turns: u32,
    },
    /// A straight bar: a rod, a straight spring, the axle of a hinge, a rail.
    Rod {
        /// Its two ends.
        ends: [DVec3; 2],
        /// Its radius.
        radius: f64,
    },
    /// A rope through points; two points if it is taut.
    Rope {
        /// Its points.
        points: Vec<DVec3>,
        /// Its radius.
        radius: f64,
    },
}

impl Link<'_> {
    /// The straight lines along which it lies, m: for a coil, its axis; none for a pin.
    pub(super) fn lines(&self) -> impl Iterator<Item = [DVec3; 2]> {
        let points: &[DVec3] = match &self.form {
            LinkForm::Pin { .. } => &[],
            LinkForm::Coil { ends, .. } | LinkForm::Rod { ends, .. } => ends,
            LinkForm::Rope { points, .. } => points,
        };
        points.windows(2).map(|pair| [pair[0], pair[1]])
    }

    /// How far it extends from these lines, m.
    pub(super) fn reach(&self) -> f64 {
        match self.form {
            LinkForm::Coil { radius, wire, .. } => radius + wire,
            LinkForm::Pin { radius, .. } | LinkForm::Rod { radius, .. } | LinkForm::Rope { radius, .. } => {
                radius
            }
        }
    }
}

/// The springs and joints of a scene that are drawn.
#[derive(Clone, Debug)]
pub(super) struct Links {
    /// In the order of the forces, their links, and the joints. The parts of each are adjacent.
    parts: Vec<Part>,
    /// The drawn shapes of bodies, by their numbers.
    shapes: Vec<Shape>,
    /// The factors by which bodies are drawn larger, by their numbers.
    scales: Vec<f64>,
    /// The direction of gravity, a unit vector.
    down: Option<DVec3>,
    /// Pairs of a body's number and the number of a part fastened to it, in order.
    of_bodies: Vec<(usize, usize)>,
    /// The thickness of the springs, in the order of the forces and their links.
    springs: Vec<SpringSize>,
}

/// The thickness of a spring.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpringSize {
    /// Its radius, m.
    pub(super) radius: f64,
    /// The least distance between its ends at which it is drawn, m.
    pub(super) room: f64,
    /// Whether it is a coil, and not a straight line.
    pub(super) is_coil: bool,
}

/// A part of a spring or of a joint. It is drawn while both ends of the spring or the joint exist.
#[derive(Clone, Debug)]
struct Part {
    name: String,
    between: [Anchor; 2],
    form: Form,
    color: Color,
}

/// The form of a part in any frame. Lengths are in metres.
#[derive(Clone, Copy, Debug)]
enum Form {
    /// A ball at a point.
    Pin { at: Anchor, radius: f64 },
    /// A coil from end to end.
    Coil { radius: f64, turns: u32 },
    /// A rod. An end at the centre of a body starts at the body's surface.
    Rod { between: [Anchor; 2], radius: f64 },
    /// A rod through a point. The direction is a unit vector in the axes of the point's body; `reach` is its extent
    /// along that direction.
    Bar { at: Anchor, along: DVec3, reach: [f64; 2], radius: f64 },
    /// A rope of a given length. It hangs if it is slack.
    Rope { between: [Anchor; 2], length: f64, radius: f64 },
    /// The rope of a pulley, over its wheels.
    OverWheels { pulley: Pulley, wheel: f64, radius: f64 },
    /// One of the wheels of a pulley; its radius and half its width.
    Wheel { pulley: Pulley, number: usize, wheel: f64, half_width: f64 },
}

impl Links {
    pub(super) fn new(scene: &Scene, survey: &Survey) -> Links {
        let parts = plan::parts(scene, &survey.asked);
        let bodies = if parts.is_empty() { &[] } else { scene.bodies.as_slice() };
        let shapes = bodies.iter().map(Body::drawn).collect();
        let scales = bodies.iter().map(|body| body.look.scale).collect();
        let ends = parts.iter().enumerate().flat_map(|(number, part): (usize, &Part)| {
            part.between.into_iter().filter_map(Anchor::body).map(move |body| (body.index(), number))
        });
        let mut of_bodies: Vec<(usize, usize)> = ends.collect();
        of_bodies.sort_unstable();
        let down = scene.simulation.gravity.try_normalize();
        Links { parts, shapes, scales, down, of_bodies, springs: plan::springs(scene) }
    }

    /// The thickness of the springs, in the order of the forces and their links.
    pub(super) fn springs(&self) -> &[SpringSize] {
        &self.springs
    }

    /// The parts that are fastened to a body, in a frame.
    pub(super) fn of_body(&self, body: usize, frame: &Frame) -> impl Iterator<Item = Link<'_>> {
        let first = self.of_bodies.partition_point(|(other, _)| *other < body);
        let its = self.of_bodies[first..].iter().take_while(move |(other, _)| *other == body);
        its.filter_map(|(_, number)| self.link(&self.parts[*number], frame))
    }

    /// The parts that are drawn in a frame.
    pub(super) fn at(&self, frame: &Frame) -> Vec<Link<'_>> {
        self.parts.iter().filter_map(|part| self.link(part, frame)).collect()
    }

    /// All parts, drawn or not.
    pub(super) fn planned(&self) -> impl Iterator<Item = PlannedLink<'_>> {
        self.parts.iter().map(|part| PlannedLink {
            name: &part.name,
            kind: match part.form {
                Form::Pin { .. } => LinkKind::Pin,
                Form::Coil { turns, .. } => LinkKind::Coil { turns, wire: WIRE },
                Form::Rod { .. } | Form::Bar { .. } | Form::Wheel { .. } => LinkKind::Rod,
                Form::Rope { .. } | Form::OverWheels { .. } => LinkKind::Rope,
            },
            color: part.color,
        })
    }

    /// For each part, its link in a frame; `None` if it is not drawn.
    pub(super) fn each(&self, frame: &Frame) -> impl Iterator<Item = Option<Link<'_>>> {
        self.parts.iter().map(|part| self.link(part, frame))
    }

    /// A part in a frame. `None` while one of its ends is absent, or if touching bodies leave no room for it.
    fn link<'a>(&'a self, part: &'a Part, frame: &Frame) -> Option<Link<'a>> {
        // A point of the world is always present.
        let is_there = |end: Anchor| end.body().is_none_or(|id| frame.body(id.index()).is_some());
        if !part.between.into_iter().all(is_there) {
            return None;
        }
        let form = match part.form {
            Form::Pin { at, radius } => LinkForm::Pin { at: self.place(at, frame), radius },
            Form::Coil { radius, turns } => {
                let ends = self.span(part.between, frame, room_for(radius))?;
                LinkForm::Coil { ends, radius, wire: WIRE * radius, turns }
            }
            Form::Rod { between, radius } => LinkForm::Rod { ends: self.span(between, frame, 0.0)?, radius },
            Form::Bar { at, along, reach, radius } => {
                let middle = self.place(at, frame);
                let along = turn(at, frame) * along;
                LinkForm::Rod { ends: reach.map(|way| middle + way * along), radius }
            }
            Form::Rope { between, length, radius } => {
                let points = hanging(between.map(|end| self.place(end, frame)), length, self.down);
                LinkForm::Rope { points, radius }
            }
            Form::OverWheels { pulley, wheel, radius } => {
                let course = self.course(&pulley, wheel, frame);
                LinkForm::Rope { points: course.points(pulley.length, pulley.ratio, self.down), radius }
            }
            Form::Wheel { pulley, number, wheel, half_width } => {
                let Turn { centre, axis, .. } = *self.course(&pulley, wheel, frame).turns.get(number)?;
                LinkForm::Rod {
                    ends: [-half_width, half_width].map(|way| centre + way * axis),
                    radius: wheel,
                }
            }
        };
        Some(Link { name: &part.name, form, color: part.color })
    }

    /// The course of the rope of a pulley with wheels of the given radius, m.
    fn course(&self, pulley: &Pulley, wheel: f64, frame: &Frame) -> Course {
        let [from, to] = pulley.between.map(|end| self.place(end, frame));
        let [first, second] = pulley.over.map(|end| self.place(end, frame));
        Course::new([from, first, second, to], wheel)
    }

    /// The position at which an end is drawn, m. On a body drawn larger, it is farther from the centre in proportion.
    fn place(&self, end: Anchor, frame: &Frame) -> DVec3 {
        let drawn = match end {
            Anchor::Body { id, at } => Anchor::Body { id, at: at * self.scales[id.index()] },
            Anchor::Point(_) => end,
        };
        drawn.place(|id| {
            let body = frame.body(id.index());
            body.map_or((DVec3::ZERO, DQuat::IDENTITY), |body| (body.location, body.orientation))
        })
    }

    /// The visible part of a straight line between two ends, m. It begins at the surface of a body that holds it by its
    /// centre. `None` if less than `room` is left.
    fn span(&self, between: [Anchor; 2], frame: &Frame, room: f64) -> Option<[DVec3; 2]> {
        let [from, to] = between.map(|end| self.place(end, frame));
        let along = (to - from).normalize_or_zero();
        let depth = |end: Anchor, direction: DVec3| match end {
            // Start a little below the surface, so that no gap is seen where the surface is curved.
            Anchor::Body { id, .. } if end.is_centre() => {
                0.95 * surface(&self.shapes[id.index()], turn(end, frame), direction)
            }
            _ => 0.0,
        };
        let begin = from + along * depth(between[0], along);
        let end = to - along * depth(between[1], -along);
        ((end - begin).dot(along) > room).then_some([begin, end])
    }
}

/// The rotation that takes the axes of an end to those of the world.
fn turn(end: Anchor, frame: &Frame) -> DQuat {
    let body = end.body().and_then(|id| frame.body(id.index()));
    body.map_or(DQuat::IDENTITY, |body| body.orientation)
}

/// The least length of a coil of a given radius, m.
fn room_for(radius: f64) -> f64 {
    4.0 * WIRE * radius
}

#[cfg(test)]
mod tests;
