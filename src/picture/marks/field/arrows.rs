//! A field as arrows on a grid. An arrow that points along the view of the camera is the sign of textbooks: ⊙ towards the camera, ⊗ away from it.

use glam::DVec3;

use super::{FieldMark, FrameView, Sketch, Source};
use crate::picture::marks::HELPING_LINE_RADIUS;
use crate::picture::thing::{Form, Line, Thing};
use crate::simulate::FieldSampler;

/// The part of the grid's points at which arrows have the largest length, although the field differs there. Near its sources, a field can be
/// arbitrarily strong.
const PART_WITH_LONGEST_ARROWS: f64 = 0.15;
/// The length of the longest arrow, in distances between arrows.
const MAX_ARROW_LENGTH: f64 = 0.85;
/// The shortest arrow that is drawn, in distances between arrows.
const MIN_ARROW_LENGTH: f64 = 0.06;
/// The radius of an arrow's shaft, in strokes.
const SHAFT_RADIUS: f64 = 0.4;
/// The cosine of the angle between arrow and view from which on the arrow is a sign.
const MIN_COSINE_END_ON: f64 = 0.97;
/// The radius of a sign, in distances between arrows.
const SIGN_RADIUS: f64 = 0.16;

/// The strength of the field that has the longest arrow.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the index is that of a point")]
#[allow(clippy::cast_precision_loss, reason = "there are few points")]
pub(super) fn strongest(sampler: &mut FieldSampler, grid: &[DVec3]) -> f64 {
    let mut strengths: Vec<f64> = grid.iter().map(|point| sampler.at(*point).length()).collect();
    strengths.retain(|strength| strength.is_finite());
    strengths.sort_by(f64::total_cmp);
    let number = ((1.0 - PART_WITH_LONGEST_ARROWS) * strengths.len() as f64) as usize;
    strengths.get(number.min(strengths.len().saturating_sub(1))).copied().unwrap_or(0.0)
}

impl FieldMark {
    pub(super) fn draw_arrows<'a>(
        &'a self,
        sampler: &mut FieldSampler,
        sources: &[Source],
        scale: &FrameView<'_>,
        sketch: &mut Sketch<'a>,
    ) {
        let spacing = self.spacing();
        // The same for all arrows: in a uniform field, all are alike.
        let to_camera = (scale.camera.location() - scale.camera.look_at()).normalize_or(DVec3::Z);
        for point in self.grid() {
            if sources.iter().any(|source| source.at.distance(point) < source.radius) {
                continue;
            }
            let field = sampler.at(point);
            let strength = field.length();
            let length = match self.drawn.scale {
                Some(scale) => scale * strength,
                // The root shows weak parts of the field as well.
                None => MAX_ARROW_LENGTH * spacing * (strength / self.strongest).min(1.0).sqrt(),
            };
            let Some(direction) = field.try_normalize().filter(|_| length > MIN_ARROW_LENGTH * spacing)
            else {
                continue;
            };
            let along = direction.dot(to_camera);
            if along.abs() > MIN_COSINE_END_ON {
                sketch.things.extend(self.sign(point, along > 0.0, length / MAX_ARROW_LENGTH, scale));
            } else {
                let half = direction * (length / 2.0);
                sketch.things.push(self.arrow(point - half, point + half, SHAFT_RADIUS * scale.stroke));
            }
        }
    }

    /// A circle with a dot for an arrow towards the camera, or with a cross for one away from it.
    fn sign(&self, point: DVec3, is_towards: bool, size: f64, scale: &FrameView<'_>) -> Vec<Thing<'_>> {
        const CIRCLE_CORNERS: u32 = 20;
        let (right, up) = (scale.screen.right(), scale.screen.up());
        let (radius, thick) = (SIGN_RADIUS * size, HELPING_LINE_RADIUS * scale.stroke);
        let on_circle = |corner: u32| {
            let (sin, cos) =
                libm::sincos(std::f64::consts::TAU * f64::from(corner) / f64::from(CIRCLE_CORNERS));
            point + (right * cos + up * sin) * radius
        };
        let line = |from, to| Line { from, to, radius: thick };
        let mut lines: Vec<Line> =
            (0..CIRCLE_CORNERS).map(|corner| line(on_circle(corner), on_circle(corner + 1))).collect();
        if is_towards {
            let dot = Form::Ball { at: point, radius: radius / 3.0 };
            return vec![
                self.thing(lines),
                Thing { name: self.name.as_str().into(), form: dot, color: self.color },
            ];
        }
        let half = radius * std::f64::consts::FRAC_1_SQRT_2;
        for arm in [right + up, right - up] {
            lines.push(line(point - arm * half, point + arm * half));
        }
        vec![self.thing(lines)]
    }
}
