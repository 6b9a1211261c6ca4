//! Checks that sizes and distances in a scene are not too small for POV-Ray. Otherwise, POV-Ray would refuse the script or draw nothing.
//!
//! POV-Ray's parser treats numbers below 10⁻¹⁰ POV-Ray units as zero. Its ray tracer treats two points as one if they are closer than the
//! resolution of single precision. This module reports both as errors before a script is written.

use super::EmitError;
use super::unit::{LargestCoordinate, reach};
use crate::diagnostic::{Code, Diagnostic, Report, Span};
use crate::picture::{Placed, Plan, number};
use crate::scene::{Camera, Scene};

/// The relative resolution of single-precision numbers, 2⁻²⁴.
const SINGLE_PRECISION: f64 = 1.0 / 16_777_216.0;

/// The smallest length that is not treated as zero, POV-Ray units. The limit of POV-Ray's parser is 10⁻¹⁰.
const MIN_LENGTH: f64 = 1e-8;

/// The smallest distance between a camera and the point that it looks at, POV-Ray units. POV-Ray compares the square of this distance with
/// 10⁻¹⁰.
const MIN_CAMERA_DISTANCE: f64 = 2e-5;

/// The smallest and the largest allowed coordinate range of a scene, POV-Ray units.
const ALLOWED_RANGE: [f64; 2] = [1e-3, 1e9];

/// Checks that POV-Ray can distinguish the points that a camera of the scene sees. `unit` is the length of one POV-Ray unit, m.
///
/// # Errors
/// [`EmitError::Indistinct`], which points to the body, the camera, or the unit in the scene.
pub(super) fn check(scene: &Scene, camera: &Camera, plan: &Plan, unit: f64) -> Result<(), EmitError> {
    let reach = reach(plan);
    if !(reach.metres / unit).is_finite() || reach.metres == f64::INFINITY {
        // Numbers of the scene overflow. When a frame is written, the body or camera whose position is not finite is reported.
        return Ok(());
    }
    let error = unit_of(scene, &reach, unit)
        .or_else(|| body(scene, &reach, unit))
        .or_else(|| sight(scene, camera, plan.placed(), unit));
    let Some(error) = error else { return Ok(()) };
    let sources = scene.warnings.sources.clone();
    Err(EmitError::Indistinct(Report { sources, diagnostics: vec![error] }))
}

/// Returns true if POV-Ray can distinguish a camera's position from the point that the camera looks at. `unit` is the length of one
/// POV-Ray unit, m.
pub(super) fn sees(camera: &Placed, unit: f64, digits: usize) -> bool {
    let [from, to] = [camera.location(), camera.look_at()].map(|point| point / unit);
    let farthest = from.abs().max_element().max(to.abs().max_element());
    let written = |number: f64| {
        let mut text = String::new();
        number::write(&mut text, number, digits);
        text
    };
    from.distance(to) > MIN_CAMERA_DISTANCE.max(SINGLE_PRECISION * farthest)
        && from.to_array().map(written) != to.to_array().map(written)
}

fn indistinct(message: String, place: Option<Span>, label: &str) -> Diagnostic {
    let error = Diagnostic::error(Code::Indistinct, message);
    match place {
        Some(place) => error.at(place, label),
        None => error,
    }
}

/// Returns the error for a `povray.unit` that is too large or too small for the scene. `None` if the unit is suitable.
fn unit_of(scene: &Scene, reach: &LargestCoordinate, unit: f64) -> Option<Diagnostic> {
    scene.povray.unit?;
    let units = reach.metres / unit;
    if (ALLOWED_RANGE[0]..ALLOWED_RANGE[1]).contains(&units) {
        return None;
    }
    let message = format!("POV-Ray cannot draw a scene that is {units:.0e} of its units large");
    let label = format!("the scene reaches {}", metres(reach.metres));
    let help = format!("leave `unit` out, or take one near {:.0e}", reach.metres / 100.0);
    Some(indistinct(message, scene.places.unit, &label).help(help))
}

/// Returns the error for the smallest of the bodies that POV-Ray would draw as a point or not at all. `None` if all bodies are large
/// enough.
fn body(scene: &Scene, reach: &LargestCoordinate, unit: f64) -> Option<Diagnostic> {
    let bodies = scene.bodies.iter().enumerate();
    let too_small = bodies.filter_map(|(id, body)| {
        let shape = body.drawn();
        let half = shape.half_thickness()?;
        let extent = shape.extent()?;
        let is_point = 2.0 * extent < SINGLE_PRECISION * reach.metres;
        (is_point || half / unit < MIN_LENGTH).then_some((id, if is_point { extent } else { half }, is_point))
    });
    let (id, size, is_point) = too_small.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let name = &scene.bodies[id].name;
    let what = if is_point { "large" } else { "thick" };
    let message = format!("POV-Ray cannot tell `{name}` from nothing: it is too small for the whole scene");
    let label = format!("it is {} {what}", metres(2.0 * size));
    let mut error = indistinct(message, scene.places.bodies.get(id).copied(), &label);
    let far = format!("the scene reaches {} from the origin", metres(reach.metres));
    if let Some(camera) = scene.places.camera.filter(|_| reach.by_camera) {
        error = error.at(camera, format!("with the view of this camera, {far}"));
    }
    let help =
        format!("{far}; draw the body larger by `look.scale`, or bring everything nearer to the origin");
    Some(error.help(help))
}

/// Returns the error for a camera that coincides with the point that it looks at, or whose view has no size. `None` if the camera is
/// usable.
fn sight(scene: &Scene, camera: &Camera, placed: &Placed, unit: f64) -> Option<Diagnostic> {
    let distance = placed.location().distance(placed.look_at());
    let place = scene.places.camera;
    if !sees(placed, unit, scene.povray.digits) {
        let message = "POV-Ray cannot tell the camera from the point that it looks at";
        let label = format!("they are {} apart", metres(distance));
        let help = "move them apart, or bring everything nearer to the origin";
        let place = place.or_else(|| scene.places.bodies.first().copied());
        return Some(indistinct(message.to_owned(), place, &label).help(help));
    }
    let width = placed.width_at(distance);
    let screen = placed.screen().axes().map(|axis| axis.length() / unit);
    let flat = screen.iter().any(|axis| *axis < MIN_LENGTH) && crate::picture::has_texts(scene);
    if width / unit > 1e3 * MIN_LENGTH && !flat {
        return None;
    }
    let message = "POV-Ray cannot tell what the camera sees from a point";
    let label = format!("it sees {}", metres(width));
    let help = match camera.blur {
        Some(_) => "take a wider `angle` or `width`, or move `focus` away from the camera",
        None => "take a wider `angle` or `width`",
    };
    Some(indistinct(message.to_owned(), place, &label).help(help))
}

/// Returns a length in meters as text, with two significant digits.
fn metres(length: f64) -> String {
    let mut text = String::new();
    number::write(&mut text, length, 2);
    text + " m"
}
