//! Reads the main camera from `[camera]` and the other cameras from `[view.NAME]`.

use glam::DVec3;

use super::marks::Known;
use super::read::figure;
use super::view::View as Keys;
use super::{Context, motion};
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::grammar::camera::{camera, follow, orbit};
use crate::scene::grammar::scene::{output as output_keys, scene};
use crate::scene::grammar::{Key, KeySpec};
use crate::scene::{
    Auto, Blur, Camera, CameraMotion, Follow, Output, Projection, Shutter, SimulationSettings, Varying,
    VaryingPoint, View, value,
};

/// The value of `--view` that selects all views. No view can have this name.
const ALL_VIEWS: &str = "all";

/// The horizontal field of view of a camera before its first frame, degrees, if it follows measures.
const USUAL_ANGLE: f64 = 40.0;

/// Reads the main camera from `[camera]`.
pub(super) fn read(known: Known<'_, '_>, context: &mut Context<'_>) -> Camera {
    camera(&[known.root.table(&scene::CAMERA)], known, context)
}

/// Reads the part of the motion that a camera shows. Warns if the scene itself places or moves the camera.
fn auto(tables: &[Keys<'_>], moving: &CameraMotion, context: &mut Context<'_>) -> Option<Auto> {
    let word = tables.iter().find_map(|keys| keys.get(&camera::AUTO))?;
    let auto = Auto::ALL.into_iter().find(|auto| auto.name() == word)?;
    let mut others = vec![&camera::LOCATION.spec, &camera::KEYFRAMES.spec, &camera::FOLLOW.spec];
    if auto == Auto::Track {
        others.extend([&camera::LOOK_AT.spec, &camera::ORBIT.spec, &camera::WIDTH.spec]);
        others.extend(moving.angle.is_some().then_some(&camera::ANGLE.spec));
        others.extend(moving.roll.is_some().then_some(&camera::ROLL.spec));
    }
    let other = others.into_iter().find(|key| tables.iter().any(|keys| keys.has(key)));
    if let (Some(other), Some(span)) = (other, tables[0].span(&camera::AUTO)) {
        let message = format!("`auto` has no effect beside `{}`", other.name);
        context.diagnostics.push(Diagnostic::warning(Code::NoEffect, message).at(span, ""));
    }
    Some(auto).filter(|_| other.is_none())
}

/// Reads the cameras of all `[view.NAME]` tables. Each view inherits missing keys from the main camera, which has been read as `camera`.
/// The two eyes of a camera with `stereo` are views, too.
pub(super) fn views(known: Known<'_, '_>, main_camera: &Camera, context: &mut Context<'_>) -> Vec<View> {
    let main = known.root.table(&scene::CAMERA);
    let read = |(name, span, keys): (&str, _, Keys<'_>)| {
        let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
        if name.is_empty() || name == ALL_VIEWS || !name.chars().all(plain) {
            let message = format!("`{}` cannot be the name of a view", name.escape_debug());
            let help =
                format!("a view names a folder: use letters, digits, `-` and `_`, and not `{ALL_VIEWS}`");
            context.diagnostics.push(Diagnostic::error(Code::BadViewName, message).at(span, "").help(help));
        }
        View { name: name.to_owned(), camera: camera(&[keys, main], known, context) }
    };
    let named = known.root.named(&scene::VIEW);
    let mut views: Vec<View> = named.iter().copied().map(read).collect();
    let mut eyes = eyes("", main_camera, &[main]);
    for (view, (_, _, keys)) in views.iter().zip(&named) {
        eyes.extend(self::eyes(&format!("{}-", view.name), &view.camera, &[*keys, main]));
    }
    for (name, span, _) in &named {
        if eyes.iter().any(|eye| eye.name == *name) {
            let message = format!("`{name}` is already the name of the view of one eye");
            let error = Diagnostic::error(Code::BadViewName, message).at(*span, "needs another name");
            context.diagnostics.push(error.help("a camera with `stereo` has the views `left` and `right`"));
        }
    }
    views.extend(eyes);
    views
}

/// Warns of spherical pictures of another shape than 2:1. Viewers of 360° pictures would show everything too wide or too high.
pub(super) fn check_size(root: &Keys<'_>, output: Output, context: &mut Context<'_>) {
    let Output { width, height, .. } = output;
    if width == Projection::SPHERICAL_ASPECT * height {
        return;
    }
    let views = root.named(&scene::VIEW).into_iter().map(|(_, _, keys)| keys);
    for keys in std::iter::once(root.table(&scene::CAMERA)).chain(views) {
        if keys.get(&camera::PROJECTION) != Some("spherical") {
            continue;
        }
        let message = format!(
            "a spherical picture is twice as wide as high, and this one has {width} × {height} pixels"
        );
        let warning = Diagnostic::warning(Code::SphericalSize, message);
        let warning = warning.help(format!(
            "write `size = [{}, {height}]` in [output]",
            Projection::SPHERICAL_ASPECT * height
        ));
        let span =
            root.table(&scene::OUTPUT).span(&output_keys::SIZE).or_else(|| keys.span(&camera::PROJECTION));
        context.diagnostics.extend(span.map(|span| warning.at(span, "")));
        return;
    }
}

/// Returns the views of the two eyes of a camera, if it has `stereo`. `tables` are the tables from which it was read.
fn eyes(prefix: &str, camera: &Camera, tables: &[Keys<'_>]) -> Vec<View> {
    let stereo = tables.iter().find_map(|keys| keys.get(&camera::STEREO));
    let distance = stereo.filter(|_| matches!(camera.projection, Projection::Perspective { .. }));
    let eye = |side, distance| View {
        name: format!("{prefix}{side}"),
        camera: Camera { eye: distance / 2.0, ..camera.clone() },
    };
    distance.map_or(Vec::new(), |distance| vec![eye("left", -distance), eye("right", distance)])
}

/// Reads a camera from one or two tables. Each value comes from the first table that has its key.
fn camera(tables: &[Keys<'_>], known: Known<'_, '_>, context: &mut Context<'_>) -> Camera {
    let simulation = known.simulation;
    let vector = |key: &Key<Option<DVec3>>| tables.iter().find_map(|keys| keys.get(key));
    // Take the first table in which the user wrote the key. Otherwise, a default value of the view would hide the main camera's value.
    let of = |key: &KeySpec| tables.iter().find(|keys| keys.has(key)).unwrap_or(&tables[0]);
    for key in [&camera::LOCATION.spec, &camera::LOOK_AT.spec, &camera::ANGLE.spec, &camera::ROLL.spec] {
        motion::finite(tables[0].node(key), simulation, context);
    }
    let [location, look_at] =
        [&camera::LOCATION, &camera::LOOK_AT].map(|key| point(key, tables, known, context));
    let [angle, roll] = [&camera::ANGLE, &camera::ROLL].map(|key| {
        let before = context.diagnostics.len();
        let number = known.number("camera", of(&key.spec).get(key), context);
        if !tables[0].has(key) {
            context.diagnostics.truncate(before);
        }
        number
    });
    let up = tables.iter().find_map(|keys| keys.get(&camera::UP));
    // A view with its own location does not move with the main camera.
    let movers = if tables[0].has(&camera::LOCATION) { &tables[..1] } else { tables };
    let mut moving = CameraMotion {
        location: location.clone().filter(VaryingPoint::changes),
        look_at: look_at.clone().filter(VaryingPoint::changes),
        angle: Some(angle.clone()).filter(Varying::changes),
        roll: Some(roll.clone()).filter(Varying::changes),
        follow: movers.iter().find_map(|keys| follow(keys, context)),
        orbit: movers
            .iter()
            .find_map(|keys| keys.variant(&camera::ORBIT)?.get(&orbit::PERIOD))
            .filter(|period| *period != 0.0),
    };
    nobody(&tables[0], &moving, known, context);
    let [mut location, mut look_at] = [location, look_at].map(|point| point?.at_start());
    if let Some(keyframes) = movers.iter().find_map(|keys| keys.variant(&camera::KEYFRAMES)) {
        let [places, aims] = motion::camera_keyframes(&keyframes, look_at, context);
        location = places.as_ref().map(|track| track.at(0.0)).or(location);
        look_at = aims.as_ref().map(|track| track.at(0.0)).or(look_at);
        let [places, aims] = [places, aims].map(|track| track.map(VaryingPoint::Timed));
        (moving.location, moving.look_at) = (places.or(moving.location), aims.or(moving.look_at));
    }
    let number = |key: &Key<Option<f64>>| tables.iter().find_map(|keys| keys.get(key));
    // An angle that follows measures is known in each frame only.
    let perspective = Projection::Perspective { angle: angle.at(0.0, |_| USUAL_ANGLE).clamp(0.1, 179.9) };
    let projection = match tables.iter().find_map(|keys| keys.get(&camera::PROJECTION)) {
        Some("orthographic") => Projection::Orthographic { width: number(&camera::WIDTH) },
        Some("spherical") => Projection::Spherical,
        _ => perspective,
    };
    let open = number(&camera::SHUTTER).filter(|open| *open > 0.0);
    misplaced(&tables[0], projection, number(&camera::APERTURE).is_some(), open.is_some(), context);
    // Only check the camera's own `shutter`: an inherited one is reported for the main camera.
    if let (Some(open), Some(span)) = (tables[0].get(&camera::SHUTTER), tables[0].span(&camera::SHUTTER)) {
        context.diagnostics.extend(too_long(open, simulation).map(|error| error.at(span, "")));
    }

    let camera = Camera {
        location,
        look_at,
        up,
        roll: roll.at(0.0, |_| 0.0),
        auto: auto(tables, &moving, context),
        motion: moving,
        projection,
        eye: 0.0,
        blur: number(&camera::APERTURE).filter(|_| projection != Projection::Spherical).map(|aperture| {
            Blur {
                aperture,
                focus: vector(&camera::FOCUS),
                samples: of(&camera::BLUR_SAMPLES.spec).get(&camera::BLUR_SAMPLES),
            }
        }),
        shutter: open.map(|open| Shutter { open, samples: of(&camera::SAMPLES.spec).get(&camera::SAMPLES) }),
    };
    if let (Some(location), Some(look_at)) = (camera.location, camera.look_at) {
        let near = camera.is_at_target();
        if near {
            let error =
                Diagnostic::error(Code::CameraAtLookAt, "the camera is at the point that it looks at");
            let span = |key| tables.iter().find_map(|keys: &Keys<'_>| keys.span(key));
            let spans = span(&camera::LOOK_AT.spec).into_iter().chain(span(&camera::LOCATION.spec));
            context.diagnostics.push(spans.fold(error, |error, span| error.at(span, "the same point")));
        }
        let is_along =
            up.is_some_and(|up| up.cross(look_at - location).length() <= 1e-6 * location.distance(look_at));
        let is_own = [&camera::UP.spec, &camera::LOCATION.spec, &camera::LOOK_AT.spec]
            .iter()
            .any(|key| tables[0].has(*key));
        let span = tables.iter().find_map(|keys| keys.span(&camera::UP));
        if let Some(span) = span.filter(|_| is_along && is_own && !near) {
            let error = Diagnostic::error(Code::CameraAtLookAt, "the camera looks along its `up`");
            let help = "give a direction across the line of sight, such as that of the picture's upper edge";
            context.diagnostics.push(error.at(span, "needs another direction").help(help));
        }
    }
    camera
}

/// Reads a point from the first table that has its key. Reports its errors only if this is the camera's own table: the errors of an
/// inherited point are reported for the main camera.
fn point(
    key: &Key<Option<value::VaryingPoint>>,
    tables: &[Keys<'_>],
    known: Known<'_, '_>,
    context: &mut Context<'_>,
) -> Option<VaryingPoint> {
    let written = tables.iter().find_map(|keys| keys.get(key))?;
    let before = context.diagnostics.len();
    let point = known.point("camera", written, context);
    if !tables[0].has(key) {
        context.diagnostics.truncate(before);
    }
    Some(point)
}

/// Reads the body that the camera follows. `None` if the camera follows no body.
fn follow(keys: &Keys<'_>, context: &Context<'_>) -> Option<Follow> {
    let follow = keys.variant(&camera::FOLLOW)?;
    let body = *context.names.bodies.get(follow.get(&follow::BODY)?)?;
    Some(Follow {
        body,
        distance: follow.get(&follow::DISTANCE),
        lag: Some(follow.get(&follow::LAG)).filter(|lag| *lag > 0.0),
    })
}

/// Warns of a camera that follows a body which is never present. Ignores an inherited `follow`, which is reported for the main camera.
fn nobody(keys: &Keys<'_>, motion: &CameraMotion, known: Known<'_, '_>, context: &mut Context<'_>) {
    let Some(body) = motion.follow.and_then(|follow| known.things.bodies.get(follow.body)) else { return };
    let span = keys.variant(&camera::FOLLOW).and_then(|follow| follow.span(&follow::BODY));
    if let Some(span) = span.filter(|_| !body.presence.overlaps(0.0, known.simulation.timeline.end())) {
        let message = format!("the camera follows `{}`, which is never there", body.name);
        let warning = Diagnostic::warning(Code::NeverThere, message);
        context.diagnostics.push(warning.at(span, "it looks where the body would come"));
    }
}

/// Returns the error for a shutter that is still open when the next frame begins. `None` if the shutter closes in time. `open` is the time
/// for which the shutter is open, s.
fn too_long(open: f64, simulation: &SimulationSettings) -> Option<Diagnostic> {
    /// The relative tolerance for a rounded number. At 30 frames per second, for example, a user may write the interval as 0.0333 s.
    const SHUTTER_TOLERANCE: f64 = 0.01;
    let interval = simulation.timeline.interval();
    let short = |seconds: f64| figure(format!("{seconds:.2e}").parse().unwrap_or(seconds));
    let message = format!(
        "the shutter is open for {} s, and the next frame begins after {} s",
        figure(open),
        short(interval)
    );
    let help = format!("half the time between frames is usual: `shutter = {}`", short(interval / 2.0));
    (open > interval * (1.0 + SHUTTER_TOLERANCE))
        .then(|| Diagnostic::error(Code::LongShutter, message).help(help))
}

/// Warns of camera keys that have no effect without another key, such as `focus` without `aperture`.
fn misplaced(
    keys: &Keys<'_>,
    projection: Projection,
    aperture: bool,
    shutter: bool,
    context: &mut Context<'_>,
) {
    let mut report = |key: &KeySpec, needs: &str| {
        let message = format!("`{}` has no effect without {needs}", key.name);
        let warning = Diagnostic::warning(Code::NoEffect, message);
        context.diagnostics.extend(keys.key_span(key).map(|span| warning.at(span, "")));
    };
    if !matches!(projection, Projection::Perspective { .. }) {
        report(&camera::ANGLE.spec, "`projection = \"perspective\"`");
        report(&camera::STEREO.spec, "`projection = \"perspective\"`");
    }
    if !matches!(projection, Projection::Orthographic { .. }) {
        report(&camera::WIDTH.spec, "`projection = \"orthographic\"`");
    }
    if projection == Projection::Spherical {
        report(&camera::APERTURE.spec, "`projection = \"perspective\"`");
    }
    if !aperture {
        report(&camera::FOCUS.spec, "`aperture`");
        report(&camera::BLUR_SAMPLES.spec, "`aperture`");
    }
    if !shutter {
        report(&camera::SAMPLES.spec, "`shutter`");
    }
}
