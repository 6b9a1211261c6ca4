//! The surfaces of liquids: a rectangle across the picture at the level of each, with a thin line around it.

use std::sync::Arc;

use glam::DVec3;

use super::{FrameView, HELPING_LINE_RADIUS, Mark, Sketch};
use crate::picture::camera::Placed;
use crate::picture::thing::{Form, Line, Thing};
use crate::scene::{Color, ForceKind, Scene};

/// Half of the sides of the rectangle across the view and along it, relative to the width in view.
const HALF_SIDES: [f64; 2] = [0.48, 0.3];
const SURFACE_OPACITY: f64 = 0.55;

#[derive(Debug)]
struct SurfaceMark {
    name: String,
    color: Color,
    /// The corners of the surface in the picture, in order around it, m.
    corners: [DVec3; 4],
}

/// Plans the surfaces of the liquids of a scene, as a camera with this width of view (m) sees the start of the run.
pub(super) fn marks(scene: &Scene, camera: &Placed, view: f64) -> Vec<Arc<dyn Mark>> {
    let mut marks: Vec<Arc<dyn Mark>> = Vec::new();
    for force in &scene.forces {
        let ForceKind::Buoyancy { liquid, surface: Some(color) } = &force.kind else { continue };
        let Some(up) = liquid.up() else { continue };
        let middle = camera.look_at() + up * (liquid.level - camera.look_at().dot(up));
        // A camera that looks straight down sees no direction along its view.
        let right = camera.screen().right();
        let across = (right - up * right.dot(up)).normalize_or(up.any_orthonormal_vector());
        let [across, along] = [across * (HALF_SIDES[0] * view), across.cross(up) * (HALF_SIDES[1] * view)];
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let corners = corners.map(|[a, b]| middle + across * a + along * b);
        marks.push(Arc::new(SurfaceMark {
            name: format!("surface of {}", force.name),
            color: *color,
            corners,
        }));
    }
    marks
}

impl Mark for SurfaceMark {
    fn draw<'a>(&'a self, scale: &FrameView<'_>, sketch: &mut Sketch<'a>) {
        let radius = HELPING_LINE_RADIUS * scale.stroke;
        let line =
            |number: usize| Line { from: self.corners[number], to: self.corners[(number + 1) % 4], radius };
        let area = Form::Area { points: self.corners.to_vec(), opacity: SURFACE_OPACITY, is_liquid: true };
        for form in [area, Form::Lines { lines: (0..4).map(line).collect() }] {
            sketch.things.push(Thing { name: self.name.as_str().into(), form, color: self.color });
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::picture::{Form, Plan, Thing};
    use crate::scene::Scene;
    use crate::simulate::{Frames, survey};

    /// The surface lies at its level, measured against gravity, and has a line around it. Without `surface`, nothing is drawn.
    #[test]
    fn a_surface_is_level_and_at_its_level() {
        let things = |gravity: [f64; 3], surface: &str| {
            let text = format!(
                "simulation = {{ duration = 1, gravity = {gravity:?} }}
                [body.block]\nshape.box.size = [1, 1, 1]\nmass = 500
                [force.water.buoyancy]\ndensity = 1000\nlevel = 0.3\n{surface}"
            );
            let scene = Scene::parse(&text).unwrap_or_else(|report| panic!("{report}"));
            let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
            let frame = Frames::new(&scene).next().unwrap().unwrap();
            plan.marks(&frame).into_iter().map(|thing: Thing<'_>| thing.form).collect::<Vec<_>>()
        };
        for (gravity, axis) in [([0.0, -10.0, 0.0], 1), ([-10.0, 0.0, 0.0], 0)] {
            let forms = things(gravity, "surface = true");
            let [Form::Area { points, .. }, Form::Lines { lines }] = &forms[..] else { panic!("{forms:?}") };
            assert_eq!((points.len(), lines.len()), (4, 4));
            for point in points {
                assert!((point[axis] - 0.3).abs() < 1e-9, "{point}");
            }
            // It is larger than the block.
            let extent = (points[0] - points[2]).length();
            assert!(extent > 2.0, "{extent}");
        }
        assert_eq!(things([0.0, -10.0, 0.0], ""), []);
    }
}
