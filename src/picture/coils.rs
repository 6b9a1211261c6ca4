//! Springs, as coils between the surfaces of what they are fastened to; joints, as rods and pins.

use glam::{DQuat, DVec3};

use crate::dynamics::{Anchor, Shape, Spring};
use crate::scene::{self, Body, Color, ForceKind, Joint, JointLook, Scene};
use crate::simulate::{Frame, surface};

/// The usual color of the wire.
const STEEL: Color = Color([0.62, 0.64, 0.67]);
/// The radius of the wire, as part of that of the coil.
const WIRE: f64 = 0.14;

/// A spring or a joint that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Coil<'a> {
    /// The name of its force or its joint in the scene.
    pub name: &'a str,
    /// Where the coil begins and ends, m; none where bodies that touch leave no room for it.
    pub span: Option<[DVec3; 2]>,
    /// The points that it is fastened to, m, where that is no body: for the beginning and for the end.
    pub fixed: [Option<DVec3>; 2],
    /// The radius of the knobs at those points, m.
    pub knob: f64,
    /// The radius of the coil, m.
    pub radius: f64,
    /// The radius of the wire, m.
    pub wire: f64,
    /// The number of its turns; 0 for a straight rod.
    pub turns: u32,
    /// The color of the wire.
    pub color: Color,
}

impl Coil<'_> {
    /// How wide it is across, with its wire, m.
    pub(super) fn width(&self) -> f64 {
        2.0 * (self.radius + self.wire)
    }
}

/// The springs of a scene that are drawn.
#[derive(Clone, Debug)]
pub(super) struct Coils {
    coils: Vec<Planned>,
    /// The drawn shapes of bodies, by their numbers.
    shapes: Vec<Shape>,
    /// How many times larger bodies are drawn than they are, by their numbers.
    scales: Vec<f64>,
    /// The numbers of bodies with the numbers of the coils that are fastened to them, in order.
    of_bodies: Vec<(usize, usize)>,
}

#[derive(Clone, Debug)]
struct Planned {
    between: [Anchor; 2],
    /// The radius of the coil, m.
    radius: f64,
    turns: u32,
    /// Whether it is a pin at one place, and reaches from nowhere to nowhere.
    is_pin: bool,
    color: Color,
    name: String,
}

impl Coils {
    pub(super) fn new(scene: &Scene) -> Coils {
        let mut coils = Vec::new();
        for force in &scene.forces {
            let ForceKind::Spring { links, coil: Some(coil) } = &force.kind else { continue };
            coils.extend(links.iter().map(|link| plan(scene, &force.name, link, coil)));
        }
        for joint in &scene.joints {
            coils.extend(joint.look.map(|look| plan_joint(scene, joint, look)));
        }
        let bodies = if coils.is_empty() { &[] } else { scene.bodies.as_slice() };
        let shapes = bodies.iter().map(Body::drawn).collect();
        let scales = bodies.iter().map(|body| body.look.scale).collect();
        let ends = coils.iter().enumerate().flat_map(|(number, coil): (usize, &Planned)| {
            coil.between.into_iter().filter_map(Anchor::body).map(move |body| (body.index(), number))
        });
        let mut of_bodies: Vec<(usize, usize)> = ends.collect();
        of_bodies.sort_unstable();
        Coils { coils, shapes, scales, of_bodies }
    }

    /// The radii of all coils, m, in the order of the forces and their links.
    pub(super) fn radii(&self) -> impl Iterator<Item = f64> {
        self.coils.iter().map(|coil| coil.radius)
    }

    /// The coils that are fastened to a body, as they are in a frame.
    pub(super) fn of_body(&self, body: usize, frame: &Frame) -> impl Iterator<Item = Coil<'_>> {
        let first = self.of_bodies.partition_point(|(other, _)| *other < body);
        let its = self.of_bodies[first..].iter().take_while(move |(other, _)| *other == body);
        its.filter_map(|(_, number)| self.coil(&self.coils[*number], frame))
    }

    /// An end as it is drawn: a point of a body that is drawn larger is farther from its centre.
    fn drawn(&self, end: Anchor) -> Anchor {
        match end {
            Anchor::Body { id, at } => Anchor::Body { id, at: at * self.scales[id.index()] },
            Anchor::Point(_) => end,
        }
    }

    /// The coils of a frame: those whose ends are there.
    pub(super) fn at(&self, frame: &Frame) -> Vec<Coil<'_>> {
        self.coils.iter().filter_map(|coil| self.coil(coil, frame)).collect()
    }

    fn coil<'a>(&'a self, coil: &'a Planned, frame: &Frame) -> Option<Coil<'a>> {
        // A point of the world is always there.
        let turned = |end: Anchor| match end.body() {
            Some(id) => frame.body(id.index()).map(|body| (body.location, body.orientation)),
            None => Some((DVec3::ZERO, DQuat::IDENTITY)),
        };
        let [Some(one), Some(other)] = coil.between.map(turned) else { return None };
        let place = |end: Anchor, pose| self.drawn(end).place(|_| pose);
        let (from, to) = (place(coil.between[0], one), place(coil.between[1], other));
        if coil.is_pin {
            return Some(coil.drawn(None, [Some(from), None]));
        }
        let along = (to - from).normalize_or_zero();
        let reach = |end: Anchor, orientation: DQuat, direction: DVec3| match end {
            // A little below the surface, so that no gap is seen where that is not flat.
            Anchor::Body { id, .. } if end.is_centre() => {
                0.95 * surface(&self.shapes[id.index()], orientation, direction)
            }
            _ => 0.0,
        };
        let begin = from + along * reach(coil.between[0], one.1, along);
        let end = to - along * reach(coil.between[1], other.1, -along);
        let fixed = |end: Anchor| match end {
            Anchor::Body { .. } => None,
            Anchor::Point(point) => Some(point),
        };
        // Bodies that touch leave no room for a spring.
        let is_room = (end - begin).dot(along) > if coil.turns > 0 { room_for(coil.radius) } else { 0.0 };
        Some(coil.drawn(is_room.then_some([begin, end]), coil.between.map(fixed)))
    }
}

impl Planned {
    fn drawn(&self, span: Option<[DVec3; 2]>, fixed: [Option<DVec3>; 2]) -> Coil<'_> {
        let is_coil = self.turns > 0;
        Coil {
            name: &self.name,
            span,
            fixed,
            knob: if is_coil { 0.6 * self.radius } else { 1.6 * self.radius },
            radius: self.radius,
            wire: if is_coil { WIRE * self.radius } else { self.radius },
            turns: self.turns,
            color: self.color,
        }
    }
}

/// The least length of a coil with a radius, m.
pub(super) fn room_for(radius: f64) -> f64 {
    4.0 * WIRE * radius
}

/// How a spring looks: about as wide as half the smaller of the bodies at its ends, and with as many turns as keep
/// their wires apart.
fn plan(scene: &Scene, name: &str, link: &Spring, coil: &scene::Coil) -> Planned {
    let place = |end: Anchor| {
        end.place(|id| {
            let start = &scene.bodies[id.index()].start;
            (start.location, start.orientation)
        })
    };
    let along = place(link.between[1]) - place(link.between[0]);
    let length = link.rest_length.max(along.length());
    let towards = along.normalize_or(DVec3::Y);
    let reach = |end: Anchor, direction: DVec3| {
        let body = &scene.bodies[end.body()?.index()];
        body.drawn().support(body.start.orientation, direction)
    };
    let widest =
        |end| [DVec3::X, DVec3::Y, DVec3::Z].into_iter().filter_map(|axis| reach(end, axis)).reduce(f64::max);
    let smallest = link.between.into_iter().filter_map(widest).fold(f64::MAX, f64::min);
    let depth = |end: Anchor| match end {
        Anchor::Body { id, .. } if end.is_centre() => {
            let body = &scene.bodies[id.index()];
            surface(&body.drawn(), body.start.orientation, towards)
        }
        _ => 0.0,
    };
    let free = length - link.between.map(depth).iter().sum::<f64>();
    let free = if free > 0.0 { free } else { length };
    let radius = coil.radius.unwrap_or_else(|| (0.5 * smallest).min(0.12 * free));
    // Bodies at the same place, with a spring without length.
    let radius = if radius > 0.0 { radius } else { smallest.min(1.0) / 2.0 };
    Planned {
        between: link.between,
        radius,
        turns: coil.turns.unwrap_or_else(|| turns(free / (1.5 * radius))),
        is_pin: false,
        color: coil.color.unwrap_or(STEEL),
        name: name.to_owned(),
    }
}

/// How a joint looks: a rod is a fifth as thick as the smaller of the bodies at its ends, and never thicker than a
/// thirtieth of its length; a pin is as thick as a part of them.
fn plan_joint(scene: &Scene, joint: &Joint, look: JointLook) -> Planned {
    let between = joint.kind.between();
    let thickness = |end: Anchor| {
        let body = &scene.bodies[end.body()?.index()];
        body.drawn().half_thickness()
    };
    let smallest = between.into_iter().filter_map(thickness).fold(f64::MAX, f64::min);
    let [from, to] = between.map(|end| {
        end.place(|id| {
            let start = &scene.bodies[id.index()].start;
            (start.location, start.orientation)
        })
    });
    let is_long = joint.kind.is_long();
    let usual = if is_long { (0.2 * smallest).min(from.distance(to) / 30.0) } else { 0.35 * smallest };
    Planned {
        between,
        radius: look.radius.unwrap_or(usual),
        turns: 0,
        is_pin: !is_long,
        color: look.color.unwrap_or(STEEL),
        name: joint.name.clone(),
    }
}

/// A number of turns near to what would be usual.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is clamped before")]
fn turns(usual: f64) -> u32 {
    usual.round().clamp(4.0, 24.0) as u32
}
