//! Lines along the ways of bodies.

use glam::DVec3;

use super::super::materials::MaterialText;
use super::super::{sdl::Style, text};
use super::color;
use crate::scene::{Color, Scene};
use crate::simulate::{Frame, Way};

/// The color of the trail of a body that has no single color.
const AMBER: Color = Color([0.93, 0.55, 0.08]);
/// A trail bends by less than this from one piece to the next, radians, where pieces are long enough to be seen.
const BEND: f64 = 0.06;
/// The most pieces from one point of the way to the next.
const MOST_PIECES: f64 = 16.0;

/// The trails of a scene.
pub(super) struct Trails {
    style: Style,
    trails: Vec<Planned>,
}

struct Planned {
    body: usize,
    /// Half its width, m.
    radius: f64,
    /// Whether it becomes thin towards its end.
    tapers: bool,
    color: String,
    name: String,
}

impl Trails {
    pub(super) fn new(scene: &Scene, materials: &[MaterialText], stroke: f64, style: Style) -> Trails {
        let mut trails = Vec::new();
        for (number, body) in scene.bodies.iter().enumerate() {
            let Some(trail) = body.showing.trail else { continue };
            let of_body = body.material.and_then(|material| materials[material].color).map(Color);
            trails.push(Planned {
                body: number,
                radius: trail.width.unwrap_or(stroke) / 2.0,
                tapers: trail.duration.is_some(),
                color: color(trail.color.or(of_body).unwrap_or(AMBER), style),
                name: text::comment(&body.name),
            });
        }
        Trails { style, trails }
    }

    /// Appends the trails up to a frame.
    pub(super) fn write(&self, out: &mut String, frame: &Frame) {
        for way in &frame.past.trails {
            if let Some(trail) = self.trails.iter().find(|trail| trail.body == way.body) {
                self.trail(out, trail, way);
            }
        }
    }

    fn trail(&self, out: &mut String, trail: &Planned, way: &Way) {
        let line = line(way, trail.radius);
        if line.len() < 2 || !line.iter().all(|point| self.style.can_write(*point)) {
            return;
        }
        out.push_str(&format!("union {{ // {}, trail\n", trail.name));
        #[allow(clippy::cast_precision_loss, reason = "there are few points")]
        let radius = |number: usize| match trail.tapers {
            true => trail.radius * (0.15 + 0.85 * number as f64 / (line.len() - 1) as f64),
            false => trail.radius,
        };
        for (number, pair) in line.windows(2).enumerate() {
            let (from, to) = (radius(number), radius(number + 1));
            out.push_str(if trail.tapers { "  cone { " } else { "  cylinder { " });
            self.style.point(out, pair[0]);
            out.push_str(", ");
            if trail.tapers {
                self.style.length(out, from);
                out.push_str(", ");
            }
            self.style.point(out, pair[1]);
            out.push_str(", ");
            self.style.length(out, to);
            out.push_str(" open } sphere { ");
            self.style.point(out, pair[1]);
            out.push_str(", ");
            self.style.length(out, to);
            out.push_str(" }\n");
        }
        let color = &trail.color;
        out.push_str(&format!(
            "  pigment {{ color srgb {color} }} finish {{ ambient 0 emission 0.75 diffuse 0.25 }} no_shadow no_reflection\n}}\n"
        ));
    }
}

/// The points of a line along a way, none nearer to the next than a piece of it is wide.
fn line(way: &Way, radius: f64) -> Vec<DVec3> {
    let mut line: Vec<DVec3> = way.points.first().map(|point| point.location).into_iter().collect();
    let mut put = |point: DVec3| {
        if line.last().is_none_or(|last| last.distance(point) > radius) {
            line.push(point);
        }
    };
    for pair in way.points.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        let bend = from.velocity.angle_between(to.velocity);
        let pieces = if bend.is_finite() { (bend / BEND).ceil().clamp(1.0, MOST_PIECES) } else { 1.0 };
        let mut piece = 1.0;
        while piece <= pieces {
            put(from.towards(to, from.time + (to.time - from.time) * piece / pieces));
            piece += 1.0;
        }
    }
    line
}
