//! Chooses the part of a run that an automatic camera frames. Usually, this part is the whole run. If the bodies would then be too small,
//! the camera frames the start of the run or follows the only body.

use super::camera::{MovingCamera, half_width};
use super::followed::FollowedValues;
use super::framing::{Field, rounded_outward, towards_camera};
use super::sight::Sight;
use crate::scene::{Body, Camera, Follow, Projection, Quantity, Scene};
use crate::simulate::{Bounds, Reach, Span, Survey};

/// The width at which the largest body is clearly visible, relative to the width of the picture: 4 pixels of 1280.
const LEAST: f64 = 0.0031;
/// The preferred width of the largest body in a picture of the start of the run, relative to the width of the picture: 12 pixels of 1280.
const GOOD: f64 = 0.0094;

/// The width of a body that the camera follows, relative to the width of the picture.
const ALONG: f64 = 0.05;

/// The bounds that are framed in an empty scene, m.
const NOTHING: Bounds = Bounds { min: glam::DVec3::NEG_ONE, max: glam::DVec3::ONE };

/// The part of a run that a camera frames, with its bounds.
#[derive(Clone, Debug)]
pub(super) struct Scope {
    /// The camera. It follows the only body if the body would otherwise be too small.
    pub(super) camera: Camera,
    /// The space of the framed part of the run.
    pub(super) span: Span,
    /// The box around the whole run, m.
    pub(super) whole: Bounds,
    pub(super) part: Part,
}

/// The part of a run that a camera frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// The whole run, or the view that the scene gives.
    Whole,
    /// The start of the run up to this time, s.
    Start(f64),
    /// The surroundings of the body with this index: the camera follows the body.
    AroundBody(usize),
}

impl Scope {
    /// Chooses the part of a run that a camera of a scene frames.
    pub(super) fn new(scene: &Scene, camera: &Camera, survey: &Survey, followed: &FollowedValues) -> Scope {
        let Some((all, starts)) = survey.spans.split_last() else {
            let arrows: [Reach; Quantity::SCALE_COUNT] = Default::default();
            let span = Span { until: 0.0, bounds: NOTHING, moving: NOTHING, seen: NOTHING, arrows };
            return Scope { camera: camera.clone(), span, whole: NOTHING, part: Part::Whole };
        };
        let whole = all.bounds;
        let scope =
            |span: &Span, part: Part, camera: Camera| Scope { camera, span: span.clone(), whole, part };
        let Some(largest) = largest(scene).filter(|_| is_automatic(scene, camera)) else {
            return scope(all, Part::Whole, camera.clone());
        };
        let width = 2.0 * half_width(largest).unwrap_or(0.0);
        let seen = |span: &Span| {
            let bounds = rounded_outward(span.seen);
            let towards = towards_camera(span.moving, Sight::of(scene));
            let eye = MovingCamera::new(camera, bounds, towards, scene, followed);
            width / eye.placed().width_of_view(span.bounds)
        };
        // The camera ignores strays: a few bodies that fly far away from many others.
        let all = survey.without_strays.as_ref().unwrap_or(all);
        let in_whole = seen(all);
        let alone = alone_over_ground(scene).filter(|body| in_whole < least_alone(scene, *body, all));
        let along = alone.and_then(|body| Some((body, along_with(body, width / ALONG, camera, scene)?)));
        if let Some((body, camera)) = along {
            return scope(all, Part::AroundBody(body), camera);
        }
        if in_whole >= LEAST {
            return scope(all, Part::Whole, camera.clone());
        }
        let come = all_have_come(scene);
        let reaching =
            |least: f64| starts.iter().rev().find(|span| span.until >= come && seen(span) >= least);
        match reaching(GOOD).or_else(|| reaching(LEAST)) {
            Some(start) => scope(start, Part::Start(start.until), camera.clone()),
            None => scope(all, Part::Whole, camera.clone()),
        }
    }
}

/// The time by which all bodies of the run have appeared, s. A framed start lasts at least until this time.
fn all_have_come(scene: &Scene) -> f64 {
    let come = scene.bodies.iter().filter_map(|body| body.presence.first_from(0.0));
    come.filter(|time| *time <= scene.simulation.timeline.end()).fold(0.0, f64::max)
}

/// The index of the only body besides planes. `None` if there are several, if the body is sometimes absent, or if no ground or plane makes
/// its motion visible.
fn alone_over_ground(scene: &Scene) -> Option<usize> {
    let is_plane = |body: &usize| scene.bodies[*body].shape.is_unbounded();
    let has_ground = scene.environment.ground.is_some() && !scene.output.transparent;
    let (planes, bodies): (Vec<usize>, Vec<usize>) = (0..scene.bodies.len()).partition(is_plane);
    let [body] = bodies[..] else { return None };
    if !scene.bodies[body].presence.is_always() {
        return None;
    }
    (has_ground || !planes.is_empty()).then_some(body)
}

/// The smallest width of a single body, relative to the picture's width, at which the camera does not follow it. The value is larger for a
/// fall without ghosts, since a picture of the whole fall would be nearly empty.
fn least_alone(scene: &Scene, body: usize, whole: &Span) -> f64 {
    let extent = whole.moving.max - whole.moving.min;
    let is_fall = extent.y > 2.0 * extent.x.max(extent.z);
    let has_ghosts = scene.bodies[body].showing.ghosts.is_some();
    if is_fall && !has_ghosts { GOOD } else { LEAST }
}

/// A camera that follows a body with a width in view of `view` (m). `None` if the scene moves or aims the camera.
fn along_with(body: usize, view: f64, camera: &Camera, scene: &Scene) -> Option<Camera> {
    let mut camera = camera.clone();
    if camera.look_at.is_some() || camera.motion.moves() {
        return None;
    }
    let distance = match &mut camera.projection {
        Projection::Perspective { angle } => view / (2.0 * Field::new(*angle, scene.output).horizontal),
        Projection::Orthographic { width: Some(_) } => return None,
        Projection::Orthographic { width } => *width.insert(view),
    };
    camera.motion.follow = Some(Follow { body, distance: Some(distance), lag: None });
    Some(camera)
}

/// True if the scene does not place the camera and shows no trails. A trail makes even a tiny body visible, so with trails the whole run
/// is framed.
fn is_automatic(scene: &Scene, camera: &Camera) -> bool {
    let motion = &camera.motion;
    let is_placed = camera.location.is_some() || motion.location.is_some() || motion.follow.is_some();
    !is_placed && !scene.bodies.iter().any(|body| body.showing.trail.is_some())
}

/// The largest body in its drawn size. `None` if all bodies are planes.
pub(super) fn largest(scene: &Scene) -> Option<&Body> {
    let sized = scene.bodies.iter().filter_map(|body| Some((half_width(body)?, body)));
    sized
        .fold(None, |largest: Option<(f64, &Body)>, one| match largest {
            Some(largest) if largest.0 >= one.0 => Some(largest),
            _ => Some(one),
        })
        .map(|(_, body)| body)
}
