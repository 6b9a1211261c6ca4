//! How much of a run an automatic camera frames: all of it, or its start where all of it would leave the bodies too
//! small to be seen.

use super::camera::{Eye, half_width};
use super::framing::{rounded_outward, towards_camera};
use super::plan::reads_ground;
use crate::scene::{Body, Camera, Scene};
use crate::simulate::{Bounds, Reach, Span, Survey};

/// The largest body is well seen if it is as wide as this part of the picture: 4 pixels of 1280.
const LEAST: f64 = 0.0031;
/// Where the whole run would leave it smaller, so much of the start is framed that it is as wide as this: 12 pixels.
const GOOD: f64 = 0.0094;

/// Where there is nothing to see, this is looked at.
const NOTHING: Bounds = Bounds { min: glam::DVec3::NEG_ONE, max: glam::DVec3::ONE };

/// The part of a run that a camera frames.
#[derive(Clone, Debug)]
pub(super) struct Scope {
    pub(super) span: Span,
    /// The box of the whole run.
    pub(super) whole: Bounds,
    /// Whether this is only the start of the run.
    pub(super) is_start: bool,
}

impl Scope {
    /// What a camera of a scene frames.
    pub(super) fn new(scene: &Scene, camera: &Camera, survey: &Survey) -> Scope {
        let Some(all) = survey.spans.last() else {
            let arrows: [Reach; 3] = Default::default();
            let span = Span { until: 0.0, bounds: NOTHING, moving: NOTHING, seen: NOTHING, arrows };
            return Scope { span, whole: NOTHING, is_start: false };
        };
        let start = if is_automatic(scene, camera) { start(scene, camera, &survey.spans) } else { None };
        let is_start = start.is_some();
        Scope { span: start.unwrap_or(all).clone(), whole: all.bounds, is_start }
    }
}

/// Whether the whole picture follows from the motion. A trail shows where a body is, however small that is, so with
/// trails all of the run is framed.
fn is_automatic(scene: &Scene, camera: &Camera) -> bool {
    let motion = &camera.motion;
    let is_placed = camera.location.is_some() || motion.location.is_some() || motion.follow.is_some();
    !is_placed && !scene.bodies.iter().any(|body| body.showing.trail.is_some())
}

/// The start of a run, if all of it would leave the bodies too small, and the start does not.
fn start<'a>(scene: &Scene, camera: &Camera, spans: &'a [Span]) -> Option<&'a Span> {
    let largest = largest(scene)?;
    let part = |span: &Span| {
        let bounds = rounded_outward(span.seen);
        let eye = Eye::new(camera, bounds, towards_camera(span.moving, reads_ground(scene)), scene);
        2.0 * half_width(largest).unwrap_or(0.0) / eye.placed().width_of_view(span.bounds)
    };
    let (all, starts) = spans.split_last()?;
    if part(all) >= LEAST {
        return None;
    }
    let reaching = |least: f64| starts.iter().rev().find(|span| part(span) >= least);
    reaching(GOOD).or_else(|| reaching(LEAST))
}

/// The body that is drawn largest; none if there is no body but planes.
pub(super) fn largest(scene: &Scene) -> Option<&Body> {
    let sized = scene.bodies.iter().filter_map(|body| Some((half_width(body)?, body)));
    sized
        .fold(None, |largest: Option<(f64, &Body)>, one| match largest {
            Some(largest) if largest.0 >= one.0 => Some(largest),
            _ => Some(one),
        })
        .map(|(_, body)| body)
}
