//! The drawings of fields: arrows on a grid, field lines, and lines of equal potential, in a plane.

mod arrows;
mod levels;
mod lines;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::DVec3;

use self::levels::Levels;
use super::{FrameView, Mark, Sketch};
use crate::physics::BodySnapshot;
use crate::picture::camera::Placed;
use crate::picture::stage::Stage;
use crate::picture::thing::{Form, Line, Thing};
use crate::scene::{Color, DrawnField, FieldStyle, Scene};
use crate::simulate::FieldSampler;

/// The radius of field lines and levels, in strokes.
const LINE_RADIUS: f64 = 0.4;
/// The number of arrows across the picture.
const ARROWS_ACROSS_PICTURE: f64 = 18.0;
/// The part of the picture that drawings fill.
const FILLED_PART_OF_PICTURE: f64 = 0.96;
/// The smallest cosine between the view of the camera and the normal of a plane. A flatter plane is drawn as if it had this one.
const MIN_COSINE_OF_TILT: f64 = 0.3;
/// The size of a region that fills the picture, relative to what the camera sees of its plane: its edges are outside of the picture.
const SIZE_BEYOND_PICTURE: f64 = 1.05;
/// The smallest part of the plane that a picture must show to be filled, relative to half of the region.
const MIN_SEEN: f64 = 0.1;
/// How far a region that fills the picture reaches at most, relative to one that does not. A camera that looks from aside sees far.
const MAX_REACH: f64 = 3.0;

/// The part of a plane in which a field is drawn.
#[derive(Clone, Copy, Debug)]
struct Region {
    /// The middle of the region, m.
    middle: DVec3,
    /// The directions across and up, unit vectors.
    axes: [DVec3; 2],
    /// Half the width and half the height, m.
    half: [f64; 2],
}

/// A field of the scene.
#[derive(Debug)]
struct FieldMark {
    drawn: DrawnField,
    name: String,
    color: Color,
    sampler: FieldSampler,
    region: Region,
    /// The radius of each body, m, by its index in the scene. Lines begin and end at the bodies that cause the field.
    radii: Vec<f64>,
    /// The strength of the field at which arrows are longest.
    strongest: f64,
    /// The levels of the potential.
    levels: Levels,
    /// The height of the ground, m. What is below is not drawn.
    ground: f64,
}

/// Plans the fields of a scene, as a camera with this width of view (m) sees the start of the run, above a ground.
pub(super) fn marks(scene: &Scene, stage: &Stage, (camera, view): (&Placed, f64)) -> Vec<Arc<dyn Mark>> {
    let ground = stage.ground.map_or(f64::NEG_INFINITY, |ground| ground.height);
    let start: Vec<BodySnapshot> =
        scene.bodies.iter().enumerate().map(|(id, body)| at_start(id, &body.start)).collect();
    let mark = |(number, drawn): (usize, &DrawnField)| {
        let mut sampler = FieldSampler::new(scene, drawn)?;
        sampler.follow(0.0, &start);
        let mut region = Region::new(drawn, &sampler, &start, (camera, view));
        if drawn.style != FieldStyle::Arrows {
            region = region.filling(camera).unwrap_or(region);
        }
        let radius = |body: &crate::scene::Body| body.drawn().bounding_radius().unwrap_or(0.0);
        let mut mark = FieldMark {
            drawn: drawn.clone(),
            name: format!("field {}", drawn.name),
            color: drawn.color.unwrap_or(Color::OF_CURVES[number % Color::OF_CURVES.len()]),
            region,
            radii: scene.bodies.iter().map(radius).collect(),
            strongest: 0.0,
            levels: Levels::default(),
            ground,
            sampler,
        };
        match drawn.style {
            FieldStyle::Arrows => mark.strongest = arrows::strongest(&mut mark.sampler.clone(), &mark.grid()),
            FieldStyle::Levels => mark.levels = levels::levels(&mut mark.sampler.clone(), &region),
            FieldStyle::Lines => {}
        }
        Some(Arc::new(mark) as Arc<dyn Mark>)
    };
    scene.fields.iter().enumerate().filter_map(mark).collect()
}

/// The snapshot of a body at the start of the run.
fn at_start(id: usize, body: &crate::physics::RigidBody) -> BodySnapshot {
    BodySnapshot {
        id,
        location: body.location,
        orientation: body.orientation,
        velocity: body.velocity,
        angular_velocity: body.angular_velocity,
        force: DVec3::ZERO,
    }
}

impl Region {
    /// Chooses the part of the plane that the camera sees.
    fn new(
        drawn: &DrawnField,
        sampler: &FieldSampler,
        start: &[BodySnapshot],
        (camera, view): (&Placed, f64),
    ) -> Region {
        let towards = (camera.location() - camera.look_at()).normalize_or(DVec3::Z);
        let normal = drawn.normal.unwrap_or_else(|| nearest_axis(towards));
        let sources: Vec<DVec3> =
            sampler.sources().iter().map(|source| start[source.body].location).collect();
        #[allow(clippy::cast_precision_loss, reason = "there are few sources")]
        let of_sources = (!sources.is_empty()).then(|| sources.iter().sum::<DVec3>() / sources.len() as f64);
        let at = drawn.at.or(of_sources).unwrap_or(camera.look_at());
        // The camera looks at a point in front of the plane or behind it.
        let along = (camera.look_at() - at).dot(normal) / towards.dot(normal);
        let middle = match along.is_finite() && towards.dot(normal).abs() > MIN_COSINE_OF_TILT {
            true => camera.look_at() - towards * along,
            false => camera.look_at() - normal * (camera.look_at() - at).dot(normal),
        };
        let right = camera.screen().right();
        let across = (right - normal * right.dot(normal)).normalize_or(normal.any_orthonormal_vector());
        let up = normal.cross(across);
        let aspect = camera.height_to_width();
        let tilt = towards.dot(normal).abs().max(MIN_COSINE_OF_TILT);
        let half = [FILLED_PART_OF_PICTURE * view / 2.0, FILLED_PART_OF_PICTURE * view / 2.0 * aspect / tilt];
        Region { middle, axes: [across, up], half }
    }

    /// Returns the region that fills the picture of a camera. `None` if a corner of the picture shows nothing of the plane.
    fn filling(self, camera: &Placed) -> Option<Region> {
        let (screen, aspect) = (camera.screen(), camera.height_to_width());
        let normal = self.axes[0].cross(self.axes[1]);
        let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for corner in [[-1.0, -aspect], [-1.0, aspect], [1.0, -aspect], [1.0, aspect]] {
            let (origin, direction) = screen.ray(corner[0], corner[1]);
            let distance = (self.middle - origin).dot(normal) / direction.dot(normal);
            if !distance.is_finite() || distance <= 0.0 {
                return None;
            }
            for (ends, position) in ends.iter_mut().zip(self.position(origin + direction * distance)) {
                let position = position.clamp(-MAX_REACH, MAX_REACH);
                *ends = [ends[0].min(position), ends[1].max(position)];
            }
        }
        // A camera that looks along the plane may see it only far away.
        if ends.iter().any(|[low, high]| high - low < MIN_SEEN) {
            return None;
        }
        let middle = self.point(ends.map(|[low, high]| (low + high) / 2.0));
        let half = [0, 1].map(|k| self.half[k] * SIZE_BEYOND_PICTURE * (ends[k][1] - ends[k][0]) / 2.0);
        Some(Region { middle, half, ..self })
    }

    /// The point at a position in the region: from −1 to 1 across and up.
    fn point(&self, [across, up]: [f64; 2]) -> DVec3 {
        self.middle + self.axes[0] * (across * self.half[0]) + self.axes[1] * (up * self.half[1])
    }

    /// The position of a point: from −1 to 1 inside of the region.
    fn position(&self, point: DVec3) -> [f64; 2] {
        [0, 1].map(|k| (point - self.middle).dot(self.axes[k]) / self.half[k])
    }

    /// The part of a vector in the plane.
    fn within(&self, vector: DVec3) -> DVec3 {
        self.axes[0] * vector.dot(self.axes[0]) + self.axes[1] * vector.dot(self.axes[1])
    }
}

/// The axis of the world that is nearest to a direction.
fn nearest_axis(direction: DVec3) -> DVec3 {
    let [x, y, z] = direction.abs().to_array();
    if z >= x && z >= y {
        DVec3::Z
    } else if x >= y {
        DVec3::X
    } else {
        DVec3::Y
    }
}

impl FieldMark {
    /// The distance between two arrows, m.
    fn spacing(&self) -> f64 {
        self.drawn.spacing.unwrap_or(2.0 * self.region.half[0] / ARROWS_ACROSS_PICTURE)
    }

    /// The points of a grid that fills the region, symmetric about its middle.
    #[allow(clippy::cast_possible_truncation, reason = "the number of arrows is limited")]
    fn grid(&self) -> Vec<DVec3> {
        /// The largest number of arrows from the middle to an edge.
        const MAX_ARROWS: f64 = 100.0;
        let spacing = self.spacing();
        let count = |half: f64| (half / spacing).min(MAX_ARROWS).floor() as i32;
        let [across, up] = self.region.half.map(count);
        let axes = self.region.axes;
        let point = |i: i32, k: i32| {
            self.region.middle + axes[0] * (f64::from(i) * spacing) + axes[1] * (f64::from(k) * spacing)
        };
        let points = (-up..=up).flat_map(|k| (-across..=across).map(move |i| point(i, k)));
        points.filter(|point| point.y >= self.ground).collect()
    }

    /// The sources with their places at a frame, and their radii, m. Absent ones are left out.
    fn sources(&self, bodies: &[BodySnapshot]) -> Vec<Source> {
        let source = |source: &crate::simulate::FieldSource| {
            let at = crate::physics::find(bodies, source.body)?;
            Some(Source { at: at.location, radius: self.radii[source.body], strength: source.strength })
        };
        self.sampler.sources().iter().filter_map(source).collect()
    }

    fn thing(&self, lines: Vec<Line>) -> Thing<'_> {
        Thing { name: self.name.as_str().into(), form: Form::Lines { lines }, color: self.color }
    }

    fn arrow(&self, from: DVec3, to: DVec3, radius: f64) -> Thing<'_> {
        Thing { name: self.name.as_str().into(), form: Form::Arrow { from, to, radius }, color: self.color }
    }
}

/// A body that causes the field, at a frame.
#[derive(Clone, Copy, Debug)]
struct Source {
    at: DVec3,
    radius: f64,
    strength: f64,
}

impl Mark for FieldMark {
    fn draw<'a>(&'a self, scale: &FrameView<'_>, sketch: &mut Sketch<'a>) {
        let mut sampler = self.sampler.clone();
        sampler.follow(scale.frame.time, &scale.frame.bodies);
        let sources = self.sources(&scale.frame.bodies);
        match self.drawn.style {
            FieldStyle::Arrows => self.draw_arrows(&mut sampler, &sources, scale, sketch),
            FieldStyle::Lines => self.draw_lines(&mut sampler, &sources, scale, sketch),
            FieldStyle::Levels => {
                let radius = LINE_RADIUS * scale.stroke;
                let mut lines = levels::lines(&mut sampler, &self.region, self.levels, radius);
                lines.retain(|line| line.from.y.min(line.to.y) >= self.ground);
                sketch.things.push(self.thing(lines));
            }
        }
    }
}
