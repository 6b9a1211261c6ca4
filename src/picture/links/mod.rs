//! The drawn parts of springs and joints: coils, rods, ropes, pins and rails.
//!
//! The parts are planned once for a run (`plan`). For each frame, only their positions are computed.

mod plan;

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};

use super::catenary::hanging;
use super::pulley::{RopePath, RopePoint, WheelArc};
use super::thing::{Form, FormKind, PlannedThing, Thing};
use crate::physics::{Anchor, Pulley, Shape};
use crate::scene::{Body, Color, JointKind, Scene};
use crate::simulate::{Frame, Survey, surface};

/// The radius of a coil's wire, relative to the radius of the coil.
const WIRE_RADIUS: f64 = 0.14;

/// The drawn springs and joints of a scene.
#[derive(Clone, Debug)]
pub(super) struct Links {
    /// The drawn parts of all springs, in the order of the forces, and then of all joints. The parts of one spring or joint are adjacent.
    parts: Vec<LinkPart>,
    /// The drawn shape of each body, indexed by body. Empty without parts.
    shapes: Vec<Shape>,
    /// The factor by which each body is drawn larger, indexed by body.
    scales: Vec<f64>,
    /// The pulleys among the joints, by the index of the joint.
    pulleys: BTreeMap<usize, Pulley>,
    /// The direction of gravity, a unit vector in world axes. `None` without gravity.
    down: Option<DVec3>,
    /// All pairs of a body and a part fastened to it, sorted. Each pair has the index of the body and the index of the part.
    of_bodies: Vec<(usize, usize)>,
    /// The thickness of the drawn springs, in the order of the forces. A spring force may have several springs.
    springs: Vec<SpringSize>,
}

/// The thickness of a drawn spring.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpringSize {
    /// The radius of the spring, m.
    pub(super) radius: f64,
    /// The distance between the ends up to which the spring is not drawn, m.
    pub(super) room: f64,
    /// True for a coil, false for a straight line.
    pub(super) is_coil: bool,
}

/// A part of a spring or joint. It is drawn while the bodies at both ends of the spring or joint are present.
#[derive(Clone, Debug)]
struct LinkPart {
    name: String,
    between: [Anchor; 2],
    form: PlannedShape,
    color: Color,
}

/// The shape of a part, relative to the bodies that it is fastened to. Lengths are in meters.
#[derive(Clone, Copy, Debug)]
enum PlannedShape {
    /// A ball at a point.
    Pin { at: Anchor, radius: f64 },
    /// A coil between the two ends of the spring.
    Coil { radius: f64, turns: u32 },
    /// A rod between two points. If a point is the center of a body, the rod starts at the surface of the body.
    Rod { between: [Anchor; 2], radius: f64 },
    /// A rod through a point. `along` is its direction, a unit vector in the axes of the point's body. `reach` holds the positions of its
    /// two ends along this direction.
    Bar { at: Anchor, along: DVec3, reach: [f64; 2], radius: f64 },
    /// A rope of a given length between two points. A slack rope hangs in a curve.
    Rope { between: [Anchor; 2], length: f64, radius: f64 },
    /// The rope of the pulley with an index among joints, over wheels with the radius `wheel`.
    OverWheels { joint: usize, wheel: f64, radius: f64 },
    /// One of the wheels of a pulley, with its radius `wheel` and half of its width.
    Wheel { joint: usize, number: usize, wheel: f64, half_width: f64 },
}

impl Links {
    pub(super) fn new(scene: &Scene, survey: &Survey) -> Links {
        let parts = plan::parts(scene, &survey.requested);
        let bodies = if parts.is_empty() { &[] } else { scene.bodies.as_slice() };
        let shapes = bodies.iter().map(Body::drawn).collect();
        let scales = bodies.iter().map(|body| body.look.scale).collect();
        let pulleys = scene.joints.iter().enumerate().filter_map(|(number, joint)| match &joint.kind {
            JointKind::Pulley(pulley) => Some((number, pulley.clone())),
            _ => None,
        });
        let pulleys: BTreeMap<usize, Pulley> = pulleys.collect();
        let ends = |part: &LinkPart| match part.form {
            PlannedShape::OverWheels { joint, .. } | PlannedShape::Wheel { joint, .. } => {
                pulleys.get(&joint).map_or_else(Vec::new, |pulley| pulley.path().to_vec())
            }
            _ => part.between.to_vec(),
        };
        let bodies = parts.iter().enumerate().flat_map(|(number, part): (usize, &LinkPart)| {
            ends(part).into_iter().filter_map(Anchor::body).map(move |body| (body.index(), number))
        });
        let mut of_bodies: Vec<(usize, usize)> = bodies.collect();
        of_bodies.sort_unstable();
        of_bodies.dedup();
        let down = scene.simulation.gravity.try_normalize();
        Links { parts, shapes, scales, pulleys, down, of_bodies, springs: plan::springs(scene) }
    }

    /// Returns true if no spring and no joint is drawn.
    pub(super) fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// The thickness of the drawn springs, in the order of the forces. A spring force may have several springs.
    pub(super) fn springs(&self) -> &[SpringSize] {
        &self.springs
    }

    /// Returns the drawn parts of springs and joints that are fastened to a body, with their positions at the moment of `frame`.
    pub(super) fn of_body(&self, body: usize, frame: &Frame) -> impl Iterator<Item = Thing<'_>> {
        let first = self.of_bodies.partition_point(|(other, _)| *other < body);
        let its = self.of_bodies[first..].iter().take_while(move |(other, _)| *other == body);
        its.filter_map(|(_, number)| self.link(&self.parts[*number], frame, 0.0))
    }

    /// All parts of springs and joints that are visible in a frame, with their positions. Lines are at least `thinnest` wide, m.
    pub(super) fn at(&self, frame: &Frame, thinnest: f64) -> Vec<Thing<'_>> {
        self.parts.iter().filter_map(|part| self.link(part, frame, thinnest)).collect()
    }

    /// All parts of springs and joints, including those that are not drawn in some frames.
    pub(super) fn planned(&self) -> impl Iterator<Item = PlannedThing<'_>> {
        self.parts.iter().map(|part| PlannedThing {
            name: &part.name,
            kind: match part.form {
                PlannedShape::Pin { .. } => FormKind::Ball,
                PlannedShape::Coil { turns, .. } => FormKind::Coil { turns, wire: WIRE_RADIUS },
                PlannedShape::Rod { .. } | PlannedShape::Bar { .. } | PlannedShape::Wheel { .. } => {
                    FormKind::Rod
                }
                PlannedShape::Rope { .. } | PlannedShape::OverWheels { .. } => FormKind::Rope,
            },
            color: part.color,
        })
    }

    /// For each part, in the order of [`planned`](Self::planned), its shape in a frame. `None` if the part is not drawn. Lines are at least
    /// `thinnest` wide, m.
    pub(super) fn each(&self, frame: &Frame, thinnest: f64) -> impl Iterator<Item = Option<Thing<'_>>> {
        self.parts.iter().map(move |part| self.link(part, frame, thinnest))
    }

    /// Computes the shape of a part in a frame, as a line at least `thinnest` wide, m. `None` while one of its bodies is absent, or if the
    /// bodies at its ends leave no room.
    fn link<'a>(&'a self, part: &'a LinkPart, frame: &Frame, thinnest: f64) -> Option<Thing<'a>> {
        let clear = |radius: f64| radius.max(thinnest / 2.0);
        // A fixed point is always present.
        let is_there = |end: Anchor| end.body().is_none_or(|id| frame.body(id.index()).is_some());
        if !part.between.into_iter().all(is_there) {
            return None;
        }
        let form = match part.form {
            PlannedShape::Pin { at, radius } => Form::Ball { at: self.place(at, frame), radius },
            PlannedShape::Coil { radius, turns } => {
                let ends = self.span(part.between, frame, room_for(radius))?;
                Form::Coil { ends, radius, wire: clear(WIRE_RADIUS * radius), turns }
            }
            PlannedShape::Rod { between, radius } => {
                Form::Rod { ends: self.span(between, frame, 0.0)?, radius: clear(radius) }
            }
            PlannedShape::Bar { at, along, reach, radius } => {
                let middle = self.place(at, frame);
                let along = turn(at, frame) * along;
                Form::Rod { ends: reach.map(|way| middle + way * along), radius: clear(radius) }
            }
            PlannedShape::Rope { between, length, radius } => {
                let points = hanging(between.map(|end| self.place(end, frame)), length, self.down);
                Form::Rope { points, radius: clear(radius) }
            }
            PlannedShape::OverWheels { joint, wheel, radius } => {
                let pulley = self.pulleys.get(&joint)?;
                let course = self.course(pulley, wheel, frame)?;
                let points = course.points(pulley.length, pulley.ratio, self.down);
                Form::Rope { points, radius: clear(radius) }
            }
            PlannedShape::Wheel { joint, number, wheel, half_width } => {
                let course = self.course(self.pulleys.get(&joint)?, wheel, frame)?;
                let WheelArc { centre, axis, .. } = *course.turns.get(number)?;
                Form::Rod { ends: [-half_width, half_width].map(|way| centre + way * axis), radius: wheel }
            }
        };
        let name = match form {
            Form::Ball { .. } => format!("{}, its end", part.name).into(),
            _ => part.name.as_str().into(),
        };
        Some(Thing { name, form, color: part.color })
    }

    /// The path of a pulley's rope over wheels with the given radius, m. `None` while one of its bodies is absent.
    fn course(&self, pulley: &Pulley, wheel: f64, frame: &Frame) -> Option<RopePath> {
        let place = |end: &Anchor| {
            let is_there = end.body().is_none_or(|id| frame.body(id.index()).is_some());
            let is_on_body = end.body().is_some();
            is_there.then(|| RopePoint { place: self.place(*end, frame), is_on_body })
        };
        let path: Vec<RopePoint> = pulley.path().iter().map(place).collect::<Option<_>>()?;
        Some(RopePath::new(&path, wheel, pulley.ratio))
    }

    /// The drawn position of an anchor in the world, m. On a body that is drawn larger, the anchor is proportionally farther from the
    /// center.
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

    /// The visible part of a straight line between two anchors, m. At an anchor in the center of a body, it starts at the body's surface.
    /// `None` if the visible part is no longer than `room`.
    fn span(&self, between: [Anchor; 2], frame: &Frame, room: f64) -> Option<[DVec3; 2]> {
        let [from, to] = between.map(|end| self.place(end, frame));
        let along = (to - from).normalize_or_zero();
        let depth = |end: Anchor, direction: DVec3| match end {
            // Start slightly below the surface, so that there is no gap where the surface is curved.
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

/// The rotation from the axes of an anchor's body to world axes.
fn turn(end: Anchor, frame: &Frame) -> DQuat {
    let body = end.body().and_then(|id| frame.body(id.index()));
    body.map_or(DQuat::IDENTITY, |body| body.orientation)
}

/// The length that a coil of a given radius must exceed to be drawn, m.
fn room_for(radius: f64) -> f64 {
    4.0 * WIRE_RADIUS * radius
}

#[cfg(test)]
mod tests;
