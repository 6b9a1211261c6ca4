//! Arrows for velocity, acceleration and force, and the axes of bodies.

use glam::DVec3;

use super::super::{sdl::Style, text};
use super::color;
use crate::scene::{Body, Color, Quantity, Scene};
use crate::simulate::{BodyFrame, Frame, axis, root, shown};

/// The colors of arrows, in the order of [`Quantity::ALL`]: those of no usual body, and far apart for any eye.
const COLORS: [Color; 3] = [Color([0.03, 0.30, 0.70]), Color([0.93, 0.50, 0.04]), Color([0.76, 0.08, 0.48])];
/// The same before a dark background.
const LIGHT_COLORS: [Color; 3] =
    [Color([0.35, 0.72, 1.0]), Color([1.0, 0.70, 0.25]), Color([1.0, 0.45, 0.80])];

/// The arrows and axes of a scene.
pub(super) struct Arrows {
    style: Style,
    /// The radius of a shaft, m.
    radius: f64,
    /// The bodies that have any, by their numbers.
    bodies: Vec<(usize, Body)>,
    arrows: Vec<Planned>,
}

/// An arrow of one of the bodies.
struct Planned {
    /// The number of its body among those that have any.
    of: usize,
    quantity: Quantity,
    /// Its length for one unit of the quantity, m.
    scale: f64,
    color: String,
}

impl Arrows {
    pub(super) fn new(scene: &Scene, scales: [f64; 3], stroke: f64, style: Style) -> Arrows {
        let shows =
            |body: &Body| body.showing.axes.is_some() || body.showing.arrows.iter().any(Option::is_some);
        let bodies = scene.bodies.iter().enumerate().filter(|(_, body)| shows(body));
        let bodies: Vec<(usize, Body)> = bodies.map(|(number, body)| (number, body.clone())).collect();
        let colors = if scene.environment.is_dark() { LIGHT_COLORS } else { COLORS };
        let mut arrows = Vec::new();
        for (of, (_, body)) in bodies.iter().enumerate() {
            for (kind, quantity) in Quantity::ALL.into_iter().enumerate() {
                let Some(arrow) = body.showing.arrows[kind] else { continue };
                let (scale, own) = (arrow.scale.unwrap_or(scales[kind]), arrow.color.unwrap_or(colors[kind]));
                arrows.push(Planned { of, quantity, scale, color: color(own, style) });
            }
        }
        Arrows { style, radius: 0.6 * stroke, bodies, arrows }
    }

    /// Appends the arrows and axes of all bodies.
    pub(super) fn write(&self, out: &mut String, frame: &Frame) {
        for (of, (number, body)) in self.bodies.iter().enumerate() {
            let at = &frame.bodies[*number];
            self.arrows_of(out, of, at);
            if let Some(length) = axis(body) {
                out.push_str("object { Axes scale ");
                self.style.length(out, length);
                out.push(' ');
                self.style.matrix(out, at.orientation, at.location);
                out.push_str(&format!(" no_shadow }} // {}, axes\n", text::comment(&body.name)));
            }
        }
    }

    /// Appends the arrows of a body as it was, if its ghosts have any.
    pub(super) fn write_ghost(&self, out: &mut String, ghost: &BodyFrame) {
        let of = self.bodies.iter().position(|(number, _)| *number == ghost.id);
        let of = of.filter(|&of| self.bodies[of].1.showing.ghosts.is_some_and(|ghosts| ghosts.arrows));
        if let Some(of) = of {
            self.arrows_of(out, of, ghost);
        }
    }

    fn arrows_of(&self, out: &mut String, of: usize, at: &BodyFrame) {
        let body = &self.bodies[of].1;
        for arrow in self.arrows.iter().filter(|arrow| arrow.of == of) {
            let vector = shown(arrow.quantity, body, at);
            let from = root(body, at, vector);
            let to = from + vector * arrow.scale;
            // One that is shorter than it is wide says nothing.
            if !self.style.can_write(to) || from.distance(to) < self.radius {
                continue;
            }
            self.arrow(out, from, to, &arrow.color);
            out.push_str(&format!(" // {}, {}\n", text::comment(&body.name), arrow.quantity.name()));
        }
    }

    fn arrow(&self, out: &mut String, from: DVec3, to: DVec3, color: &str) {
        out.push_str("Arrow(");
        self.style.point(out, from);
        out.push_str(", ");
        self.style.point(out, to);
        out.push_str(", ");
        self.style.length(out, self.radius);
        out.push_str(&format!(", {color})"));
    }
}
