//! Checks for differences too small for POV-Ray: it would refuse the script, or draw nothing.
//!
//! POV-Ray's parser takes everything below 10⁻¹⁰ of its units for zero. Its tracer takes two places for the same if they are less
//! than one step of single precision apart. Both are errors here, before a script is written.

use super::EmitError;
use super::unit::{Reach, reach};
use crate::diagnostic::{Code, Diagnostic, Report, Span};
use crate::picture::{Placed, Plan, number};
use crate::scene::{Camera, Scene};

/// A step of single precision, relative to the number.
const STEP: f64 = 1.0 / 16_777_216.0;

/// Lengths below this count as zero, in POV-Ray's units. The limit of POV-Ray's parser is 10⁻¹⁰.
const NOTHING: f64 = 1e-8;

/// A camera that is nearer to the point that it looks at has no direction, in POV-Ray's units: the square is compared
/// with 10⁻¹⁰.
const NEAREST: f64 = 2e-5;

/// How many of POV-Ray's units a scene may reach, from the first to the second.
const UNITS: [f64; 2] = [1e-3, 1e9];

/// Checks that POV-Ray can tell apart what a camera of the scene sees. `unit` is in metres.
///
/// # Errors
/// [`EmitError::Indistinct`], at the body, the camera, or the unit.
pub(super) fn check(scene: &Scene, camera: &Camera, plan: &Plan, unit: f64) -> Result<(), EmitError> {
    let reach = reach(plan);
    if !(reach.metres / unit).is_finite() || reach.metres == f64::INFINITY {
        // The bodies present are checked when their frame is written.
        return Ok(());
    }
    let error = unit_of(scene, &reach, unit)
        .or_else(|| body(scene, &reach, unit))
        .or_else(|| sight(scene, camera, plan.placed(), unit));
    let Some(error) = error else { return Ok(()) };
    let sources = scene.warnings.sources.clone();
    Err(EmitError::Indistinct(Report { sources, diagnostics: vec![error] }))
}

/// Whether POV-Ray can tell a moving camera from the point that it looks at.
pub(super) fn sees(camera: &Placed, unit: f64, digits: usize) -> bool {
    let [from, to] = [camera.location(), camera.look_at()].map(|point| point / unit);
    let farthest = from.abs().max_element().max(to.abs().max_element());
    let written = |number: f64| {
        let mut text = String::new();
        number::write(&mut text, number, digits);
        text
    };
    from.distance(to) > NEAREST.max(STEP * farthest)
        && from.to_array().map(written) != to.to_array().map(written)
}

fn indistinct(message: String, place: Option<Span>, label: &str) -> Diagnostic {
    let error = Diagnostic::error(Code::Indistinct, message);
    match place {
        Some(place) => error.at(place, label),
        None => error,
    }
}

/// The error for a `unit` in the scene that is too large or too small for it.
fn unit_of(scene: &Scene, reach: &Reach, unit: f64) -> Option<Diagnostic> {
    scene.povray.unit?;
    let units = reach.metres / unit;
    if (UNITS[0]..UNITS[1]).contains(&units) {
        return None;
    }
    let message = format!("POV-Ray cannot draw a scene that is {units:.0e} of its units large");
    let label = format!("the scene reaches {}", metres(reach.metres));
    let help = format!("leave `unit` out, or take one near {:.0e}", reach.metres / 100.0);
    Some(indistinct(message, scene.places.unit, &label).help(help))
}

/// The error for a body that POV-Ray takes for a point, or for thinner than nothing. It names the smallest such body.
fn body(scene: &Scene, reach: &Reach, unit: f64) -> Option<Diagnostic> {
    let bodies = scene.bodies.iter().enumerate();
    let too_small = bodies.filter_map(|(id, body)| {
        let shape = body.drawn();
        let half = shape.half_thickness()?;
        let extent = shape.extent()?;
        let is_point = 2.0 * extent < STEP * reach.metres;
        (is_point || half / unit < NOTHING).then_some((id, if is_point { extent } else { half }, is_point))
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

/// The error for a camera that has no direction, or whose picture has no size.
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
    let flat = screen.iter().any(|axis| *axis < NOTHING) && crate::picture::has_texts(scene);
    if width / unit > 1e3 * NOTHING && !flat {
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

/// A length with two digits.
fn metres(length: f64) -> String {
    let mut text = String::new();
    number::write(&mut text, length, 2);
    text + " m"
}
