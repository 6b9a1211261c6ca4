//! Reads the prescribed motion of bodies from the key `motion`.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::trajectory::{self, Columns, Recording};
use super::view::View;
use super::{Context, asset, body, presence};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::{Interpolation, Keyframe, Presence, Track};
use crate::scene::expand::in_string;
use crate::scene::grammar::motion::trajectory as trajectory_keys;
use crate::scene::grammar::motion::{columns, formula, keyframe, keyframes, motion, turning};
use crate::scene::grammar::{bodies, camera};
use crate::scene::motion::{BodyMotion, TimedOrientation};
use crate::scene::source::{Node, Value};
use crate::scene::timed::{TimeFormula, TimedVector};
use crate::scene::value;
use crate::scene::{FileColumn, SimulationSettings};

/// The maximum number of keyframes in all tracks together. If bodies with different orientations share the rows of a file, the rows count
/// once for each orientation.
const MAX_PLACES: usize = 2_000_000;
/// The maximum number of formula operations for finding frames at which a formula has no finite value. If the limit is reached, the check
/// evaluates only some frames, and the run reports errors at the other frames.
pub(super) const MAX_OPERATIONS: u64 = 50_000_000;

/// Reads the prescribed motion of a body, and the times at which the body is present. `None` if the body has no prescribed motion.
/// `presence` comes from the body's keys `start` and `end`.
pub(super) fn read(
    name: &str,
    view: &View<'_>,
    place: (DVec3, DQuat),
    presence: &Presence,
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) -> Option<(BodyMotion, Presence)> {
    let motion = view.variant(&bodies::body::MOTION)?;
    if let Some(formula) = motion.variant(&motion::FORMULA) {
        if formula.has(&formula::LOCATION) {
            unused_location(name, view, context);
        }
        let motion = by_formula(name, &formula, place, presence, simulation, context);
        return Some((motion, presence.clone()));
    }
    if let Some(keyframes) = motion.variant(&motion::KEYFRAMES) {
        return Some((by_keyframes(name, &keyframes, place, context)?, presence.clone()));
    }
    unused_location(name, view, context);
    let (motion, of_file) =
        by_trajectory(name, &motion.variant(&motion::TRAJECTORY)?, place.1, simulation, context)?;
    Some((motion, of_file.and(presence)))
}

/// Warns that the `location` of a body has no effect because its motion gives the location.
fn unused_location(name: &str, view: &View<'_>, context: &mut Context<'_>) {
    let Some(span) = view.key_span(&bodies::body::LOCATION) else { return };
    // The copies of a body have their locations from the key `repeat`.
    let is_of_repeat = context.sources.raw(span) == "repeat";
    let key = if is_of_repeat { "the place that `repeat` gives" } else { "`location`" };
    let of = if is_of_repeat { "to" } else { "of" };
    let warning = Diagnostic::warning(Code::NoEffect, format!("{key} {of} `{name}` has no effect"));
    context.diagnostics.push(warning.at(span, "its motion says where it is"));
}

fn by_formula(
    name: &str,
    view: &View<'_>,
    place: (DVec3, DQuat),
    presence: &Presence,
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) -> BodyMotion {
    finite_while(presence, view.node(&formula::LOCATION), simulation, context);
    let orientation = if view.has(&formula::ORIENTATION) {
        let table = view.table(&formula::ORIENTATION);
        for node in
            [view.node(&formula::ORIENTATION), table.node(&turning::EULER), table.node(&turning::ANGLE)]
        {
            finite_while(presence, node, simulation, context);
        }
        turning(name, view, context)
    } else {
        TimedOrientation::Constant(place.1)
    };
    BodyMotion::Formula {
        location: view.get(&formula::LOCATION).unwrap_or_else(|| TimedVector::from(place.0)),
        orientation,
    }
}

fn turning(name: &str, view: &View<'_>, context: &mut Context<'_>) -> TimedOrientation {
    let table = view.table(&formula::ORIENTATION);
    if let Some(angles) =
        view.get_as::<value::TimedVector>(&formula::ORIENTATION).or_else(|| table.get(&turning::EULER))
    {
        return TimedOrientation::Euler(angles);
    }
    body::together(name, &table, [&turning::AXIS.spec, &turning::ANGLE.spec], context);
    match (table.get(&turning::AXIS), table.get(&turning::ANGLE)) {
        (Some(axis), Some(angle)) => TimedOrientation::Axis { axis, angle },
        _ => TimedOrientation::Constant(DQuat::IDENTITY),
    }
}

/// Reports the first frame at which a formula has no finite value. If `node` is a list, checks each formula in the list.
pub(super) fn finite(node: Option<&Node>, simulation: &SimulationSettings, context: &mut Context<'_>) {
    finite_while(&Presence::ALWAYS, node, simulation, context);
}

/// Like [`finite`], but checks only the frames at which the body is present.
fn finite_while(
    presence: &Presence,
    node: Option<&Node>,
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) {
    match node.map(|node| &node.value) {
        Some(Value::Array(items)) => {
            items.iter().for_each(|item| finite_while(presence, Some(item), simulation, context));
        }
        Some(Value::Formula(formula)) => {
            let span = node.map(|node| node.span);
            let wrong = some_frames(formula, simulation.timeline.frames(), context).find_map(|frame| {
                let t = Some(simulation.timeline.time(frame)).filter(|t| presence.at(*t))?;
                Some((t, formula.explain_non_finite(t)?))
            });
            if let (Some((t, error)), Some(span)) = (wrong, span) {
                let raw = context.sources.raw(span);
                let place = in_string(raw, formula.text(), &error.range, span);
                let message = format!("{}, at t = {t} s", error.message);
                let diagnostic = Diagnostic::error(error.code, message).at(place, error.label);
                context.diagnostics.push(match error.help {
                    Some(help) => diagnostic.help(help),
                    None => diagnostic,
                });
            }
        }
        _ => {}
    }
}

/// Returns the frames at which a formula is evaluated: all frames, or evenly spaced ones if too few operations are left.
fn some_frames(
    formula: &TimeFormula,
    frames: usize,
    context: &mut Context<'_>,
) -> impl Iterator<Item = usize> + use<> {
    let affordable = context.operations / formula.operations().max(1);
    let count = usize::try_from(affordable).unwrap_or(frames).max(2).min(frames);
    context.operations = context.operations.saturating_sub(formula.operations().saturating_mul(count as u64));
    let last = frames - 1;
    (0..count)
        .map(move |n| if count < 2 { n } else { (n as u128 * last as u128 / (count as u128 - 1)) as usize })
}

fn by_keyframes(
    name: &str,
    view: &View<'_>,
    (location, orientation): (DVec3, DQuat),
    context: &mut Context<'_>,
) -> Option<BodyMotion> {
    let mut keys: Vec<Keyframe> = Vec::new();
    let mut last: Option<(f64, Span)> = None;
    for frame in view.tables(&keyframes::AT) {
        let (Some(time), Some(span)) = (frame.get(&keyframe::TIME), frame.span(&keyframe::TIME)) else {
            continue;
        };
        if out_of_order("a keyframe", &mut last, time, span, context) {
            continue;
        }
        let before = keys.last();
        let turned = frame.has(&keyframe::ORIENTATION).then(|| body::orientation(name, &frame, context));
        keys.push(Keyframe {
            time,
            location: frame.get(&keyframe::LOCATION).or(before.map(|key| key.location)).unwrap_or(location),
            orientation: turned.or(before.map(|key| key.orientation)).unwrap_or(orientation),
            velocity: None,
            angular_velocity: None,
        });
    }
    let interpolation = interpolation(view.get(&keyframes::INTERPOLATION));
    if keys.is_empty() || !has_room(keys.len(), view.span(&keyframes::AT), context) {
        return None;
    }
    Some(BodyMotion::Track(Arc::new(Track::new(keys, interpolation, true))))
}

/// Adds a track with this many keyframes to the total. Returns false and reports an error if the total exceeds its limit.
fn has_room(places: usize, span: Option<Span>, context: &mut Context<'_>) -> bool {
    context.places = context.places.saturating_add(places);
    if context.places <= MAX_PLACES
        || span.is_some_and(|span| context.reported.contains(&(Code::TooManyCopies, span)))
    {
        return context.places <= MAX_PLACES;
    }
    let message = format!("the motions of this scene have more than {MAX_PLACES} places");
    let error = Diagnostic::error(Code::TooManyCopies, message);
    let label = "each body has places of its own here";
    context.diagnostics.extend(span.map(|span| error.at(span, label)));
    false
}

/// Reads the keyframes of a camera. Returns the track of its location and the track of its target. A track is `None` if the scene does not
/// give it.
pub(super) fn camera_keyframes(
    view: &View<'_>,
    look_at: Option<DVec3>,
    context: &mut Context<'_>,
) -> [Option<TimedVector>; 2] {
    let (mut places, mut aims): (Vec<Keyframe>, Vec<Keyframe>) = (Vec::new(), Vec::new());
    let mut last: Option<(f64, Span)> = None;
    let mut aim = look_at;
    for frame in view.tables(&camera::keyframes::AT) {
        let (Some(time), Some(span), Some(location)) = (
            frame.get(&camera::keyframe::TIME),
            frame.span(&camera::keyframe::TIME),
            frame.get(&camera::keyframe::LOCATION),
        ) else {
            continue;
        };
        if out_of_order("a keyframe", &mut last, time, span, context) {
            continue;
        }
        aim = frame.get(&camera::keyframe::LOOK_AT).or(aim);
        let key = |location: DVec3| Keyframe {
            time,
            location,
            orientation: DQuat::IDENTITY,
            velocity: None,
            angular_velocity: None,
        };
        places.push(key(location));
        aims.extend(aim.map(key));
    }
    [places, aims].map(|keys| {
        let track = Track::new(keys, interpolation(view.get(&camera::keyframes::INTERPOLATION)), true);
        track.span().is_some().then(|| TimedVector::Track(Arc::new(track)))
    })
}

/// Returns true and reports an error if `what`, such as a keyframe, is not later than the one before.
pub(super) fn out_of_order(
    what: &str,
    last: &mut Option<(f64, Span)>,
    time: f64,
    span: Span,
    context: &mut Context<'_>,
) -> bool {
    if let Some((before, other)) = last.filter(|(before, _)| *before >= time) {
        let message = format!("{what} at {time} s stands after one at {before} s");
        let error = Diagnostic::error(Code::KeyframeOrder, message).at(span, "this is not later");
        context.diagnostics.push(error.at(other, "the one before"));
        return true;
    }
    *last = Some((time, span));
    false
}

fn interpolation(word: &str) -> Interpolation {
    match word {
        "linear" => Interpolation::Linear,
        _ => Interpolation::Cubic,
    }
}

/// Notes the further columns in the rows of a body, so that formulas can name them. `rows_of` is the name of the body in the file.
fn note_columns(name: &str, recording: &Recording, rows_of: &Option<String>, context: &mut Context<'_>) {
    let (Some(keys), Some(values)) = (recording.rows.get(rows_of), recording.values.get(rows_of)) else {
        return;
    };
    let Some(&body) = context.names.bodies.get(name).filter(|_| !recording.further.is_empty()) else {
        return;
    };
    let times: Arc<[f64]> = keys.iter().map(|key| key.time).collect();
    for (number, (column, unit)) in recording.further.iter().enumerate() {
        let values = values.iter().map(|row| row[number]).collect();
        let times = Arc::clone(&times);
        context.file_columns.add(body, column, unit, FileColumn { times, values });
    }
}

fn by_trajectory(
    name: &str,
    view: &View<'_>,
    orientation: DQuat,
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) -> Option<(BodyMotion, Presence)> {
    let span = view.span(&trajectory_keys::FILE)?;
    let recording = match &context.last_recording {
        Some((last, recording)) if view.is_same(last.as_ref()) => recording.clone(),
        _ => recording(view, span, context),
    };
    context.last_recording = Some((view.to_table(), recording.clone()));
    let recording = recording?;
    let wanted = view.get(&trajectory_keys::BODY).unwrap_or(name);
    let Some(keys) = recording.rows.get(&Some(wanted.to_owned())).or_else(|| recording.rows.get(&None))
    else {
        let at = view.span(&trajectory_keys::BODY).unwrap_or(span);
        if context.reported.contains(&(Code::CsvBody, at)) {
            return None;
        }
        context.diagnostics.push(trajectory::no_rows(&recording, wanted, at));
        return None;
    };
    let rows_of = recording.rows.contains_key(&Some(wanted.to_owned())).then(|| wanted.to_owned());
    note_columns(name, &recording, &rows_of, context);
    if context.measured.insert(Arc::as_ptr(&recording).addr()) {
        presence::short(
            view.get(&trajectory_keys::FILE).unwrap_or_default(),
            &recording.times,
            span,
            simulation,
            context,
        );
    }
    let interpolation = interpolation(view.get(&trajectory_keys::INTERPOLATION));
    let same = Rows {
        address: keys.as_ptr().addr(),
        orientation: (!recording.is_turned).then(|| orientation.to_array().map(f64::to_bits)),
        is_linear: interpolation == Interpolation::Linear,
    };
    if let Some((track, presence)) = context.tracks.get(&same) {
        return Some((BodyMotion::Track(track.clone()), presence.clone()));
    }
    // The limit on the file's size already limits the first track that is made from these rows, so count only further tracks.
    let is_copied = !context.rows.insert(same.address);
    if is_copied && !has_room(keys.len(), Some(span), context) {
        return None;
    }
    let mut keys = keys.clone();
    if !recording.is_turned {
        keys.iter_mut().for_each(|key| key.orientation = orientation);
    }
    let (presence, gaps) = presence::of_rows(&keys, &recording.times, simulation);
    if interpolation == Interpolation::Cubic
        && let Some(node) = view.node(&trajectory_keys::FILE)
    {
        let asset = asset::asset(node, context.folder, context.trust).ok()?;
        let is_named = recording.rows.contains_key(&Some(wanted.to_owned()));
        let origin = trajectory::Origin {
            path: &asset.path,
            name: node.as_str().unwrap_or_default(),
            columns: &Columns::read(&view.table(&trajectory_keys::COLUMNS)),
            body: is_named.then_some(wanted),
            at: span,
        };
        let error = trajectory::contradiction(&keys, &gaps, recording.is_turned, &origin, context);
        if let Some(error) = error {
            if context.reported.insert((Code::CsvVelocity, span)) {
                context.diagnostics.push(error);
            }
            return None;
        }
    }
    let track = Arc::new(Track::with_gaps(keys, &gaps, interpolation, false));
    context.tracks.insert(same, (track.clone(), presence.clone()));
    Some((BodyMotion::Track(track), presence))
}

/// Identifies a track: the rows of a file, and the settings for making the track. Bodies with equal keys share one track.
#[derive(PartialEq, Eq, Hash)]
pub(super) struct Rows {
    /// The memory address of the body's rows. Files stay in memory, so the address identifies the rows.
    address: usize,
    /// The bits of the body's orientation quaternion. `None` if the rows give the orientation.
    orientation: Option<[u64; 4]>,
    is_linear: bool,
}

/// Returns the recording in the file that the table names. `None` if the file has errors, which have been reported.
fn recording(view: &View<'_>, span: Span, context: &mut Context<'_>) -> Option<Arc<Recording>> {
    let node = view.node(&trajectory_keys::FILE)?;
    // An error in the path has already been reported.
    let path = asset::asset(node, context.folder, context.trust).ok()?.path;
    let table = view.table(&trajectory_keys::COLUMNS);
    for key in [&columns::VELOCITY.spec, &columns::ANGULAR_VELOCITY.spec] {
        let names = table.list(key).map_or(0, <[_]>::len);
        if let (1 | 2, Some(at)) = (names, table.span(key)) {
            let message = format!("`{}` needs 3 columns, or none", key.name);
            let help = format!("`{} = []` leaves them out", key.name);
            context.diagnostics.push(Diagnostic::error(Code::CsvColumn, message).at(at, "").help(help));
            return None;
        }
    }
    let columns = Columns::read(&table);
    trajectory::read(&path, node.as_str().unwrap_or_default(), &columns, span, context)
}
