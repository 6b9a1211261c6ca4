//! Springs, as coils between the surfaces of what they are fastened to.

use glam::DVec3;

use super::super::{sdl::Style, text};
use super::color;
use crate::dynamics::Shape;
use crate::scene::{Body, Coil, Color, ForceKind, Scene, SpringEnd, SpringLink};
use crate::simulate::{Frame, surface};

/// The usual color of the wire.
const STEEL: Color = Color([0.62, 0.64, 0.67]);
/// The radius of the wire, as part of that of the coil.
const WIRE: f64 = 0.14;

/// The springs of a scene that are drawn.
pub(super) struct Coils {
    style: Style,
    coils: Vec<Planned>,
    /// The drawn shapes of bodies, by their numbers.
    shapes: Vec<Shape>,
}

struct Planned {
    between: [SpringEnd; 2],
    /// The radius of the coil, m.
    radius: f64,
    turns: u32,
    color: String,
    name: String,
}

impl Coils {
    pub(super) fn new(scene: &Scene, style: Style) -> Coils {
        let mut coils = Vec::new();
        for force in &scene.forces {
            let ForceKind::Spring { links, coil: Some(coil), .. } = &force.kind else { continue };
            coils.extend(links.iter().map(|link| plan(scene, &force.name, link, coil, style)));
        }
        let shapes =
            if coils.is_empty() { Vec::new() } else { scene.bodies.iter().map(Body::drawn).collect() };
        Coils { style, coils, shapes }
    }

    /// Appends the coils as they are in a frame.
    pub(super) fn write(&self, out: &mut String, frame: &Frame) {
        for coil in &self.coils {
            let centre = |end: SpringEnd| match end {
                SpringEnd::Body(body) => frame.bodies[body].location,
                SpringEnd::Point(point) => point,
            };
            let [from, to] = coil.between.map(centre);
            let along = (to - from).normalize_or_zero();
            let reach = |end: SpringEnd, direction: DVec3| match end {
                SpringEnd::Body(body) => {
                    // A little below the surface, so that no gap is seen where that is not flat.
                    0.95 * surface(&self.shapes[body], frame.bodies[body].orientation, direction)
                }
                SpringEnd::Point(_) => 0.0,
            };
            let (begin, end) =
                (from + along * reach(coil.between[0], along), to - along * reach(coil.between[1], -along));
            let name = text::comment(&coil.name);
            for point in coil.between {
                if let SpringEnd::Point(point) = point {
                    out.push_str("sphere { ");
                    self.style.point(out, point);
                    out.push_str(", ");
                    self.style.length(out, 0.6 * coil.radius);
                    let color = &coil.color;
                    out.push_str(&format!(" pigment {{ color srgb {color} }} }} // {name}, its end\n"));
                }
            }
            // Bodies that touch leave no room for a spring.
            let is_room = (end - begin).dot(along) > 4.0 * WIRE * coil.radius;
            if !is_room || !self.style.can_write(begin) || !self.style.can_write(end) {
                continue;
            }
            out.push_str("Coil(");
            self.style.point(out, begin);
            out.push_str(", ");
            self.style.point(out, end);
            for length in [coil.radius, WIRE * coil.radius] {
                out.push_str(", ");
                self.style.length(out, length);
            }
            out.push_str(&format!(", {}, {}) // {name}\n", coil.turns, coil.color));
        }
    }
}

/// How a spring looks: about as wide as half the smaller of the bodies at its ends, and with as many turns as keep
/// their wires apart.
fn plan(scene: &Scene, name: &str, link: &SpringLink, coil: &Coil, style: Style) -> Planned {
    let place = |end: SpringEnd| match end {
        SpringEnd::Body(body) => scene.bodies[body].start.location,
        SpringEnd::Point(point) => point,
    };
    let along = place(link.between[1]) - place(link.between[0]);
    let length = link.rest_length.max(along.length());
    let towards = along.normalize_or(DVec3::Y);
    let reach = |end: SpringEnd, direction: DVec3| match end {
        SpringEnd::Body(body) => {
            let body = &scene.bodies[body];
            body.drawn().support(body.start.orientation, direction)
        }
        SpringEnd::Point(_) => None,
    };
    let widest =
        |end| [DVec3::X, DVec3::Y, DVec3::Z].into_iter().filter_map(|axis| reach(end, axis)).reduce(f64::max);
    let smallest = link.between.into_iter().filter_map(widest).fold(f64::MAX, f64::min);
    let depth = |end: SpringEnd| match end {
        SpringEnd::Body(body) => {
            surface(&scene.bodies[body].drawn(), scene.bodies[body].start.orientation, towards)
        }
        SpringEnd::Point(_) => 0.0,
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
        color: color(coil.color.unwrap_or(STEEL), style),
        name: name.to_owned(),
    }
}

/// A number of turns near to what would be usual.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is clamped before")]
fn turns(usual: f64) -> u32 {
    usual.round().clamp(4.0, 24.0) as u32
}
