//! The size of the largest body in the picture, to warn if no body is large enough to be seen.

use super::super::camera::{MovingCamera, half_width};
use super::super::direction_hints::DirectionHints;
use super::super::followed::FollowedValues;
use super::super::framed_run::{FramedPart, largest};
use super::super::framing;
use crate::decimal::round_above;
use crate::scene::{Body, Camera, Scene};
use crate::simulate::{Bounds, Survey};

/// The width below which a body looks like a dot, pixels.
const SMALLEST_SEEN: f64 = 4.0;
/// The width of a body that is clearly visible, pixels, and as a part of the picture's width: 12 pixels of 1280.
const CLEARLY_SEEN: [f64; 2] = [12.0, 0.0094];
/// The largest value of `look.scale` that is worth a suggestion.
const MAX_SCALE: f64 = 1e6;

/// The largest body of those that move or, if none does, of all, and its size in the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Largest {
    /// The name of the body.
    pub name: String,
    /// Whether a fixed body is larger.
    pub is_below_fixed: bool,
    /// The largest width of the body in any picture, pixels.
    pub pixels: f64,
    /// The factor by which the body is drawn larger than it is.
    scale: f64,
    /// The width with which the body would be clearly visible, pixels.
    clear: f64,
    /// The width that the body would have if the camera framed the whole run, pixels.
    pub pixels_in_whole: f64,
}

impl Largest {
    /// Finds the largest body of a scene, and computes its size as seen by a camera. `None` without bodies other than planes.
    pub(super) fn seen(
        scene: &Scene,
        camera: &Camera,
        survey: &Survey,
        eye: &MovingCamera,
        followed: &FollowedValues,
    ) -> Option<Largest> {
        let body: &Body = largest(scene)?;
        let whole = survey.spans.last()?.framed();
        let pixels = |view: f64| 2.0 * half_width(body).unwrap_or(0.0) / view * f64::from(scene.output.width);
        let towards = framing::towards_camera(whole.moving, DirectionHints::of(scene));
        let seen = framing::rounded_outward(whole.seen);
        let on_whole = MovingCamera::new(camera, seen, towards, scene, followed);
        let pixels_in_whole = pixels(on_whole.placed().width_of_view(whole.bounds));
        Some(Largest {
            name: body.name.to_string(),
            is_below_fixed: scene.bodies.iter().any(|other| half_width(other) > half_width(body)),
            pixels: pixels(narrowest_view(scene, eye, whole.bounds)),
            scale: body.look.scale,
            clear: CLEARLY_SEEN[0].max(CLEARLY_SEEN[1] * f64::from(scene.output.width)),
            pixels_in_whole,
        })
    }

    /// Returns the value of `look.scale` with which the body is clearly visible in a picture of the whole run. `None` if no such value helps.
    pub fn fit(&self, part: FramedPart) -> Option<f64> {
        let pixels = if part == FramedPart::Whole { self.pixels } else { self.pixels_in_whole };
        let fit = round_above(self.scale * self.clear / pixels);
        (fit > self.scale && fit <= MAX_SCALE).then_some(fit)
    }

    /// Returns true if a warning must say that the body is too small. If the camera shows the whole run, this is so if the body is smaller
    /// than [`SMALLEST_SEEN`]. If the camera follows a body, the size that the body would have in a picture of the whole run decides. If the
    /// camera shows only the start of the run, it does so because the body would be too small otherwise.
    pub(super) fn is_too_small(&self, part: FramedPart) -> bool {
        match part {
            FramedPart::Whole => self.pixels < SMALLEST_SEEN,
            FramedPart::Start(_) => true,
            FramedPart::Along => self.pixels_in_whole < SMALLEST_SEEN,
        }
    }
}

/// The smallest width in view of a camera during the run, m. The view of a moving camera is computed at 33 moments.
pub(super) fn narrowest_view(scene: &Scene, eye: &MovingCamera, bounds: Bounds) -> f64 {
    let times = if eye.moves() { 32 } else { 0 };
    let views = (0..=times).map(|number| {
        let time = scene.simulation.timeline.duration * f64::from(number) / 32.0;
        eye.early(time).width_of_view(bounds)
    });
    views.fold(f64::MAX, f64::min)
}
