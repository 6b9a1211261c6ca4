//! Moves arrows and marks towards the camera if the ground, a spring or a joint would hide them. Their position and size in the picture stay the
//! same.

use glam::DVec3;

use super::arrows::{Arrow, HEAD};
use super::camera::{Lens, Placed};
use super::stage::Stage;
use super::thing::{Form, Line};
use crate::physics::{BodySnapshot, Shape};
use crate::scene::{Body, Quantity, Scene};

/// A line that is moved towards the camera keeps at least this fraction of its distance from the camera.
const MIN_DISTANCE_FRACTION: f64 = 0.02;

/// The planes that may hide arrows and marks: the ground and plane bodies.
#[derive(Clone, Debug)]
pub(super) struct Planes {
    /// A point (m) and the unit normal of each plane.
    planes: Vec<(DVec3, DVec3)>,
}

impl Planes {
    pub(super) fn new(scene: &Scene, stage: &Stage) -> Planes {
        let ground = stage.ground.map(|ground| (DVec3::Y * ground.height, DVec3::Y));
        let bodies = scene.bodies.iter().filter_map(|body| match body.shape {
            Shape::Plane { normal } => Some((body.start.location, body.start.orientation * normal)),
            _ => None,
        });
        Planes { planes: ground.into_iter().chain(bodies).collect() }
    }

    /// Moves an arrow towards the camera if it would pass through one of the planes.
    pub(super) fn lift(&self, arrow: &mut Arrow, camera: &Placed) {
        let shaft = arrow.radius.min(arrow.from.distance(arrow.to) / 14.0);
        let mut line = arrow.line();
        self.lift_line(&mut line, [shaft, HEAD * shaft], camera);
        *arrow = arrow.along(line);
    }

    /// Moves a line towards the camera if it would pass through one of the planes. `room` is how far the line reaches from its middle at
    /// its two ends, m.
    pub(super) fn lift_line(&self, line: &mut Line, room: [f64; 2], camera: &Placed) {
        for (point, normal) in &self.planes {
            let above = |place: DVec3| (place - *point).dot(*normal);
            // The additional height that the line needs to be completely above the plane.
            let lacking = (room[1] - above(line.to)).max(room[0] - above(line.from));
            let eye = above(camera.location());
            if lacking > 0.0 && eye > 0.0 {
                let lowest = above(line.to).min(above(line.from));
                let part = (eye - lowest - lacking) / (eye - lowest);
                *line = match camera.lens() {
                    Lens::Perspective { .. } | Lens::Spherical => nearer(line, camera, part),
                    Lens::Orthographic { .. } => {
                        let towards = camera.towards(line.to);
                        shifted(line, towards * (lacking / towards.dot(*normal).max(0.05)))
                    }
                };
            }
        }
    }
}

impl Planes {
    /// Moves an area that lies in one of the planes towards the camera, to a height of `room` (m). Otherwise, it would be seen in part only, by
    /// rounding errors.
    pub(super) fn lift_area(&self, points: &mut [DVec3], room: f64, camera: &Placed) {
        for (point, normal) in &self.planes {
            let above = |place: &DVec3| (*place - *point).dot(*normal);
            let eye = above(&camera.location());
            if eye <= room || points.iter().any(|point| above(point).abs() >= room) {
                continue;
            }
            for point in &mut *points {
                let way = match camera.lens() {
                    Lens::Perspective { .. } | Lens::Spherical => camera.location() - *point,
                    Lens::Orthographic { .. } => camera.towards(*point),
                };
                *point += way * ((room - above(point)) / way.dot(*normal));
            }
        }
    }
}

/// Moves an arrow in front of a spring or joint if the arrow is inside it.
pub(super) fn lift_from_link(arrow: &mut Arrow, link: &Form, camera: &Placed) {
    let reach = link.reach() + HEAD * arrow.radius;
    let is_hidden = |line: &[DVec3; 2]| distance([arrow.from, arrow.to], *line) < reach;
    let Some([begin, end]) = link.middle_lines().find(is_hidden) else { return };
    let middle = (arrow.from + arrow.to) / 2.0;
    // If the line is seen nearly end-on, the arrow would have to move very far to get in front of it, so limit the way.
    let across = (end - begin).normalize_or_zero().cross(camera.towards(middle)).length().max(0.3);
    let way = 1.5 * reach / across;
    *arrow = arrow.along(match camera.lens() {
        Lens::Perspective { .. } | Lens::Spherical => {
            nearer(&arrow.line(), camera, 1.0 - way / camera.location().distance(middle))
        }
        Lens::Orthographic { .. } => shifted(&arrow.line(), camera.towards(middle) * way),
    });
}

/// Moves an arrow for a weight or contact force in front of its body. Friction is drawn in front of the normal force, and the normal force
/// in front of the weight.
pub(super) fn lift_from_body(arrow: &mut Arrow, body: &Body, at: &BodySnapshot, camera: &Placed) {
    let middle = (arrow.from + arrow.to) / 2.0;
    let towards = camera.towards(middle);
    let order = Quantity::OF_LOADS.iter().position(|quantity| *quantity == arrow.quantity).unwrap_or(0);
    #[allow(clippy::cast_precision_loss, reason = "there are three")]
    let room = HEAD * arrow.radius * (1.0 + 0.5 * order as f64);
    let reach = body.drawn().support(at.orientation, towards).unwrap_or(0.0) + room;
    let depth = |point: DVec3| (point - at.location).dot(towards);
    let way = reach - depth(arrow.from).min(depth(arrow.to));
    if way > 0.0 {
        *arrow = arrow.along(match camera.lens() {
            Lens::Perspective { .. } | Lens::Spherical => {
                nearer(&arrow.line(), camera, 1.0 - way / camera.location().distance(middle))
            }
            Lens::Orthographic { .. } => shifted(&arrow.line(), towards * way),
        });
    }
}

/// Moves a line to a fraction of its distance from the camera, and scales it by the same fraction. It then looks the same in the picture.
fn nearer(line: &Line, camera: &Placed, part: f64) -> Line {
    let eye = camera.location();
    let part = part.clamp(MIN_DISTANCE_FRACTION, 1.0);
    let place = |point: DVec3| eye + (point - eye) * part;
    Line { from: place(line.from), to: place(line.to), radius: line.radius * part }
}

fn shifted(line: &Line, way: DVec3) -> Line {
    Line { from: line.from + way, to: line.to + way, ..*line }
}

/// The smallest distance between two line segments.
///
/// Source: C. Ericson, *Real-Time Collision Detection* (2005), 5.1.9.
fn distance([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> f64 {
    let (one, other, between) = (b - a, d - c, a - c);
    let (ones, others) = (one.length_squared(), other.length_squared());
    let (on_one, on_other, cross) = (one.dot(between), other.dot(between), one.dot(other));
    let slope = ones * others - cross * cross;
    let along = |part: f64| if ones > 0.0 { (part / ones).clamp(0.0, 1.0) } else { 0.0 };
    let mut s = match slope > 0.0 {
        true => ((cross * on_other - on_one * others) / slope).clamp(0.0, 1.0),
        false => along(-on_one),
    };
    let t = if others > 0.0 { (cross * s + on_other) / others } else { 0.0 };
    let clamped = t.clamp(0.0, 1.0);
    if t != clamped {
        s = along(cross * clamped - on_one);
    }
    (a + one * s).distance(c + other * clamped)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_are_as_far_apart_as_their_nearest_points() {
        let segment = |from: [f64; 3], to: [f64; 3]| [from, to].map(DVec3::from_array);
        let unit = segment([0.0; 3], [1.0, 0.0, 0.0]);
        for (other, far) in [
            (segment([0.5, 1.0, -1.0], [0.5, 1.0, 1.0]), 1.0),
            (segment([2.0, 0.0, 0.0], [3.0, 0.0, 0.0]), 1.0),
            (segment([-1.0, 0.3, 0.0], [2.0, 0.3, 0.0]), 0.3),
            (segment([0.4, 0.0, 0.0], [0.6, 0.0, 0.0]), 0.0),
            (segment([4.0, 4.0, 0.0], [4.0, 9.0, 0.0]), 5.0),
            (segment([0.5, 2.0, 0.0], [0.5, 2.0, 0.0]), 2.0),
        ] {
            assert!((distance(unit, other) - far).abs() < 1e-12, "{other:?}");
            assert!((distance(other, unit) - far).abs() < 1e-12, "{other:?}");
        }
    }
}
