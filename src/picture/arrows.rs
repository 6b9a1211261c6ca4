//! Arrows for velocity, acceleration and force, and the axes of bodies.

use glam::{DQuat, DVec3};

use crate::scene::{Body, Color, Quantity, Scene};
use crate::simulate::{BodyFrame, Frame, axis, root, shown};

/// The colors of arrows, in the order of [`Quantity::ALL`]: those of no usual body, and far apart for any eye.
const COLORS: [Color; 3] = [Color([0.03, 0.30, 0.70]), Color([0.93, 0.50, 0.04]), Color([0.76, 0.08, 0.48])];
/// The same before a dark background.
const LIGHT_COLORS: [Color; 3] =
    [Color([0.35, 0.72, 1.0]), Color([1.0, 0.70, 0.25]), Color([1.0, 0.45, 0.80])];

/// An arrow for a vector of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrow {
    /// The number of the body.
    pub body: usize,
    /// What it shows.
    pub quantity: Quantity,
    /// Where it begins, m.
    pub from: DVec3,
    /// Its tip, m.
    pub to: DVec3,
    /// The radius of its shaft, m.
    pub radius: f64,
    /// Its color.
    pub color: Color,
}

/// The axes of a body, as three arrows from its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// The number of the body.
    pub body: usize,
    /// The centre of the body, m.
    pub location: DVec3,
    /// The rotation that takes its own axes to the world's.
    pub orientation: DQuat,
    /// The length of each, m.
    pub length: f64,
}

/// The arrows and axes of a scene.
#[derive(Clone, Debug)]
pub(super) struct Arrows {
    /// The radius of a shaft, m.
    radius: f64,
    /// The bodies that have any, in the order of their numbers.
    bodies: Vec<(usize, Body)>,
    /// Their arrows, in the order of the bodies.
    arrows: Vec<Planned>,
}

/// An arrow of one of the bodies.
#[derive(Clone, Debug)]
struct Planned {
    /// The number of its body among those that have any.
    of: usize,
    quantity: Quantity,
    /// Its length for one unit of the quantity, m.
    scale: f64,
    color: Color,
}

impl Arrows {
    pub(super) fn new(scene: &Scene, scales: [f64; 3], stroke: f64) -> Arrows {
        let shows =
            |body: &Body| body.showing.axes.is_some() || body.showing.arrows.iter().any(Option::is_some);
        let bodies = scene.bodies.iter().enumerate().filter(|(_, body)| shows(body));
        let bodies: Vec<(usize, Body)> = bodies.map(|(number, body)| (number, body.clone())).collect();
        let colors = if scene.environment.is_dark() { LIGHT_COLORS } else { COLORS };
        let mut arrows = Vec::new();
        for (of, (_, body)) in bodies.iter().enumerate() {
            for (kind, quantity) in Quantity::ALL.into_iter().enumerate() {
                let Some(arrow) = body.showing.arrows[kind] else { continue };
                let scale = arrow.scale.unwrap_or(scales[kind]);
                arrows.push(Planned { of, quantity, scale, color: arrow.color.unwrap_or(colors[kind]) });
            }
        }
        Arrows { radius: 0.6 * stroke, bodies, arrows }
    }

    /// The arrows of a frame.
    pub(super) fn arrows(&self, frame: &Frame) -> Vec<Arrow> {
        let arrow = |arrow: &Planned| self.arrow(arrow, &frame.bodies[self.bodies[arrow.of].0]);
        self.arrows.iter().filter_map(arrow).collect()
    }

    /// The axes of a frame.
    pub(super) fn axes(&self, frame: &Frame) -> Vec<Axes> {
        let axes = |(number, body): &(usize, Body)| {
            let (length, at) = (axis(body)?, &frame.bodies[*number]);
            Some(Axes { body: *number, location: at.location, orientation: at.orientation, length })
        };
        self.bodies.iter().filter_map(axes).collect()
    }

    /// The arrows of a body as it was, if its ghosts have any.
    pub(super) fn of_ghost(&self, ghost: &BodyFrame) -> Vec<Arrow> {
        let Ok(of) = self.bodies.binary_search_by_key(&ghost.id, |(number, _)| *number) else {
            return Vec::new();
        };
        if !self.bodies[of].1.showing.ghosts.is_some_and(|ghosts| ghosts.arrows) {
            return Vec::new();
        }
        let first = self.arrows.partition_point(|arrow| arrow.of < of);
        let its = self.arrows[first..].iter().take_while(|arrow| arrow.of == of);
        its.filter_map(|arrow| self.arrow(arrow, ghost)).collect()
    }

    fn arrow(&self, arrow: &Planned, at: &BodyFrame) -> Option<Arrow> {
        let (number, body) = &self.bodies[arrow.of];
        let vector = shown(arrow.quantity, body, at);
        let from = root(body, at, vector);
        let to = from + vector * arrow.scale;
        // One that is shorter than it is wide says nothing.
        let is_seen = to.is_finite() && from.distance(to) >= self.radius;
        let (quantity, color) = (arrow.quantity, arrow.color);
        is_seen.then_some(Arrow { body: *number, quantity, from, to, radius: self.radius, color })
    }
}
