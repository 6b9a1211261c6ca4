//! Chooses the part of a run that an automatic camera frames. Usually, this part is the whole run. If the bodies would then be too small,
//! the camera goes along with the motion, or frames the start of the run.

use std::sync::Arc;

use super::camera::{MovingCamera, half_width};
use super::direction_hints::DirectionHints;
use super::followed::FollowedValues;
use super::framing::{rounded_outward, towards_camera};
use super::track::Track;
use crate::scene::{Auto, Body, Camera, Projection, Quantity, Scene};
use crate::simulate::{Bounds, Reach, Span, Survey};

/// The width at which the largest body is clearly visible, relative to the width of the picture: 4 pixels of 1280.
const MIN_VISIBLE_WIDTH: f64 = 0.0031;
/// The preferred width of the largest body in a picture of the start of the run, relative to the width of the picture: 12 pixels of 1280.
const PREFERRED_WIDTH_AT_START: f64 = 0.0094;

/// The width below which the largest body is so small that the camera goes along with the motion, relative to the width of the picture: 25
/// pixels of 1280.
const MIN_WIDTH_IN_WHOLE: f64 = 0.02;
/// The largest width of the largest body in the pictures of a camera that goes along with the motion, relative to the width of the picture. More
/// would hide where the motion goes.
const MAX_WIDTH_ALONG: f64 = 0.1;
/// A camera goes along with the motion only if bodies then are usually at least so many times as large as in a picture of the whole run.
const MIN_USUAL_GAIN: f64 = 2.0;
/// If they would be too small to be seen in a picture of the whole run, they are at least so many times as large in the best picture.
const MIN_GAIN_AT_BEST: f64 = 3.0;

/// The bounds that are framed in an empty scene, m.
const BOUNDS_OF_NOTHING: Bounds = Bounds { min: glam::DVec3::NEG_ONE, max: glam::DVec3::ONE };

/// The part of a run that a camera frames, with its bounds.
#[derive(Clone, Debug)]
pub(super) struct FramedRun {
    /// The space of the framed part of the run.
    pub(super) span: Span,
    /// The box around the whole run, m.
    pub(super) whole: Bounds,
    pub(super) part: FramedPart,
    /// The track of a camera that goes along with the motion.
    pub(super) track: Option<Arc<Track>>,
    /// The indices of the bodies that fly out of the picture: outliers of the run.
    pub(super) left_out: Vec<usize>,
}

/// The part of a run that a camera frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FramedPart {
    /// The whole run, or the view that the scene gives.
    Whole,
    /// The start of the run up to this time, s.
    Start(f64),
    /// What moves at each time: the camera goes along with the motion.
    Along,
}

impl FramedRun {
    /// Chooses the part of a run that a camera of a scene frames.
    pub(super) fn new(
        scene: &Scene,
        camera: &Camera,
        survey: &Survey,
        followed: &FollowedValues,
    ) -> FramedRun {
        let Some((all, starts)) = survey.spans.split_last() else {
            let arrows: [Reach; Quantity::SCALE_COUNT] = Default::default();
            let span = Span {
                until: 0.0,
                bounds: BOUNDS_OF_NOTHING,
                moving: BOUNDS_OF_NOTHING,
                seen: BOUNDS_OF_NOTHING,
                subject: BOUNDS_OF_NOTHING,
                shown: BOUNDS_OF_NOTHING,
                arrows,
            };
            return FramedRun {
                span,
                whole: BOUNDS_OF_NOTHING,
                part: FramedPart::Whole,
                track: None,
                left_out: Vec::new(),
            };
        };
        let whole = all.bounds;
        let framed = |span: &Span, part: FramedPart| FramedRun {
            span: span.clone(),
            whole,
            part,
            track: None,
            left_out: Vec::new(),
        };
        if camera.auto == Some(Auto::Whole) || !is_automatic(camera) {
            return framed(all, FramedPart::Whole);
        }
        let all = &all.framed();
        let width = largest(scene).map_or(0.0, |largest| 2.0 * half_width(largest).unwrap_or(0.0));
        let eye = |span: &Span| {
            let bounds = rounded_outward(span.seen);
            let towards = towards_camera(span.moving, DirectionHints::of(scene));
            MovingCamera::new(camera, bounds, towards, scene, followed)
        };
        let seen = |span: &Span| width / eye(span).placed().width_of_view(span.bounds);
        let along = |span: &Span| {
            let placed = *eye(span).placed();
            let least = (width / MAX_WIDTH_ALONG).min(placed.width_of_view(span.bounds));
            let track = Arc::new(Track::new(&survey.course, &placed, least)?);
            Some(FramedRun { track: Some(track), ..framed(span, FramedPart::Along) })
        };
        if camera.auto == Some(Auto::Track) {
            return along(all).unwrap_or(framed(all, FramedPart::Whole));
        }
        // Without bodies, there are only particles.
        if width == 0.0 {
            return framed(all, FramedPart::Whole);
        }
        // A trail makes even a tiny body visible, so with trails the whole run is framed.
        if scene.bodies.iter().any(|body| body.showing.trail.is_some()) {
            return framed(all, FramedPart::Whole);
        }
        // The camera ignores outliers: a few bodies that fly far away from many others.
        let outliers = survey.outliers.as_ref();
        let all = &outliers.map_or(all.clone(), |outliers| outliers.without.framed());
        let in_whole = seen(all);
        let is_closer = |framed: &FramedRun| {
            let views = framed.track.as_ref().map(|track| track.views().map(|view| width / view / in_whole));
            views.is_some_and(|[best, usual]| {
                usual > MIN_USUAL_GAIN || in_whole < MIN_VISIBLE_WIDTH && best > MIN_GAIN_AT_BEST
            })
        };
        if in_whole < MIN_WIDTH_IN_WHOLE
            && shows_motion(scene, camera)
            && shows_bodies_alone(all, width)
            && let Some(along) = along(all).filter(is_closer)
        {
            return along;
        }
        let framed_whole = || {
            let left_out = outliers.map(|outliers| outliers.bodies.clone()).unwrap_or_default();
            FramedRun { left_out, ..framed(all, FramedPart::Whole) }
        };
        if in_whole >= MIN_VISIBLE_WIDTH {
            return framed_whole();
        }
        let come = all_have_come(scene);
        let reaching = |least: f64| {
            starts.iter().rev().map(Span::framed).find(|span| span.until >= come && seen(span) >= least)
        };
        match reaching(PREFERRED_WIDTH_AT_START).or_else(|| reaching(MIN_VISIBLE_WIDTH)) {
            Some(start) => framed(&start, FramedPart::Start(start.until)),
            None => framed_whole(),
        }
    }
}

/// The time by which all bodies of the run have appeared, s. A framed start lasts at least until this time.
fn all_have_come(scene: &Scene) -> f64 {
    let come = scene.bodies.iter().filter_map(|body| body.presence.first_from(0.0));
    come.filter(|time| *time <= scene.simulation.timeline.end()).fold(0.0, f64::max)
}

/// True if a camera that goes along with the motion shows that there is motion: the ground or other bodies are seen to pass by. False if the
/// scene itself moves the camera. False also if ghosts or a grid already show the way of the bodies: a camera that stands still shows them best.
fn shows_motion(scene: &Scene, camera: &Camera) -> bool {
    let has_ground = scene.environment.ground.is_some() && !scene.output.transparent;
    let is_given = matches!(camera.projection, Projection::Orthographic { width: Some(_) });
    let has_ghosts = scene.bodies.iter().any(|body| body.showing.ghosts.is_some());
    (has_ground || scene.bodies.len() > 1)
        && !is_given
        && !has_ghosts
        && scene.grid.is_none()
        && !camera.motion.moves()
        && camera.look_at.is_none()
}

/// True if the moving bodies are nearly all that there is to see. A camera that goes along with them does not show fixed bodies far from their
/// motion, the fixed ends of springs, or long arrows.
fn shows_bodies_alone(span: &Span, width: f64) -> bool {
    /// The largest size of all that is seen, relative to that of the motion.
    const MAX_SIZE_OF_ALL: f64 = 2.0;
    let beyond = 2.0 * width;
    let Span { subject, moving, seen, .. } = span;
    let is_most = seen.diagonal() <= MAX_SIZE_OF_ALL * moving.diagonal();
    is_most && subject.min.cmpge(moving.min - beyond).all() && subject.max.cmple(moving.max + beyond).all()
}

/// True if the scene does not place the camera.
fn is_automatic(camera: &Camera) -> bool {
    let motion = &camera.motion;
    camera.location.is_none() && motion.location.is_none() && motion.follow.is_none()
}

/// The largest body in its drawn size, of those that move, if any does. `None` if all bodies are planes.
pub(super) fn largest(scene: &Scene) -> Option<&Body> {
    let does_move = scene.bodies.iter().any(|body| !body.start.fixed && half_width(body).is_some());
    let bodies = scene.bodies.iter().filter(|body| !does_move || !body.start.fixed);
    bodies
        .filter_map(|body| Some((half_width(body)?, body)))
        .fold(None, |largest: Option<(f64, &Body)>, one| match largest {
            Some(largest) if largest.0 >= one.0 => Some(largest),
            _ => Some(one),
        })
        .map(|(_, body)| body)
}
