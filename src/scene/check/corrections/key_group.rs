//! Corrects groups of keys that stand for a single key of jabuka, such as `x`, `y` and `z` for `location`.

use super::super::Context;
use super::kind::MeantKind;
use super::launch::{ANGLE_KEYS, SPEED_KEYS, by_angle, find};
use super::text::{operand, raw, removal, whole, whole_line};
use super::{ends, joint, key_of, quoted_and};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::{KeySpec, Rule, TableSpec};
use crate::scene::source::{Entry, Table};
use crate::scene::units;

/// A group of unknown keys that together stand for one key of the scene language, such as `x`, `y` and `z` for `location`.
pub(in crate::scene::check) struct KeyGroup {
    /// The error that reports all unknown keys of the group, with its fix.
    pub(in crate::scene::check) error: Diagnostic,
    /// The source spans of the unknown keys in the group.
    pub(in crate::scene::check) spans: Vec<Span>,
    /// The key of the scene language that the user meant, such as `location` for `x`, `y` and `z`.
    pub(in crate::scene::check) key: &'static str,
}

/// Finds groups of unknown keys in a table that each stand for one key of the scene language, such as `x`, `y` and `z` for `location`.
pub(in crate::scene::check) fn key_groups(
    table: &Table,
    spec: &'static TableSpec,
    meant: Option<&MeantKind>,
    path: &str,
    context: &Context<'_>,
) -> Vec<KeyGroup> {
    let ends = ends::correct_ends(table, spec, meant, path, context);
    let launch = launch(table, spec, path, context);
    let drag = drag(table, spec, path, context);
    let spring = joint::spring(table, spec, path, context);
    let parts = [("location", ["x", "y", "z"]), ("velocity", ["vx", "vy", "vz"])];
    let parts =
        parts.into_iter().filter_map(|(key, names)| components(table, spec, key, &names, path, context));
    let counted = counted(table, spec, path);
    let size = size(table, spec, path, context);
    let rates = rates(table, spec, path, context);
    ends.into_iter()
        .chain(size)
        .chain(rates)
        .chain(counted)
        .chain(launch)
        .chain(drag)
        .chain(spring)
        .chain(parts)
        .collect()
}

/// Returns one error for several entries. Its fix replaces the first entry by `line` and removes the other entries.
pub(super) fn joined(
    entries: &[&Entry],
    key: &'static str,
    label: &str,
    line: String,
    path: &str,
    context: &Context<'_>,
) -> Option<KeyGroup> {
    let (first, rest) = entries.split_first()?;
    let s = if rest.is_empty() { "" } else { "s" };
    let names: Vec<&str> = entries.iter().map(|entry| &*entry.name.text).collect();
    let message = format!("unknown key{s} {} in {path}", quoted_and(&names));
    let error = Diagnostic::error(Code::UnknownKey, message).at(first.name.span, label);
    let mut error = error.fix(whole(first)?, line);
    for entry in rest {
        // Remove the line break before the entry rather than the one after it. Otherwise, the edits of adjacent lines would overlap.
        let line =
            whole_line(whole(entry)?, context).filter(|line| !context.sources.before(*line).is_empty());
        let gone = match line {
            Some(line) => {
                let content = raw(line, context).trim_end_matches('\n').len();
                line.part(0..content).grown(1, 0)
            }
            None => removal(whole(entry)?, context)?,
        };
        error = error.at(entry.name.span, "").fix(gone, "");
    }
    Some(KeyGroup { error, spans: entries.iter().map(|entry| entry.name.span).collect(), key })
}

/// Replaces the speed and the launch angle of a body by the key `velocity`.
fn launch(table: &Table, spec: &TableSpec, path: &str, context: &Context<'_>) -> Option<KeyGroup> {
    let key = spec.key("velocity").filter(|_| spec.key("angular_velocity").is_some())?.name;
    if table.get(key).is_some() {
        return None;
    }
    let (speed, angle) = (find(table, &SPEED_KEYS)?, find(table, &ANGLE_KEYS)?);
    let line = format!("{key} = {}", by_angle(table, context)?);
    joined(&[speed, angle], key, "`velocity` is a vector", line, path, context)
}

/// Corrects coordinates that are given one by one, such as `x`, `y` and `z`, to a single vector.
fn components(
    table: &Table,
    spec: &TableSpec,
    key: &str,
    names: &[&str; 3],
    path: &str,
    context: &Context<'_>,
) -> Option<KeyGroup> {
    let key = spec.key(key)?.name;
    if table.get(key).is_some() || names.iter().any(|name| spec.key(name).is_some()) {
        return None;
    }
    let entries: Vec<&Entry> =
        table.entries.iter().filter(|entry| names.contains(&&*entry.name.text)).collect();
    let part = |name: &str| match table.get(name) {
        Some(entry) => value(entry, context),
        None => Some("0".to_owned()),
    };
    let parts = names.iter().map(|name| part(name)).collect::<Option<Vec<_>>>()?;
    let line = format!("{key} = [{}]", parts.join(", "));
    joined(&entries, key, &format!("`{key}` is a list"), line, path, context)
}

/// Replaces the `width` and the `height` of images by the key `size`.
fn size(table: &Table, spec: &TableSpec, path: &str, context: &Context<'_>) -> Option<KeyGroup> {
    let key = spec.key("size").filter(|_| spec.key("layout").is_some())?.name;
    let (width, height) = (table.get("width")?, table.get("height")?);
    let line = format!("{key} = [{}, {}]", value(width, context)?, value(height, context)?);
    joined(&[width, height], key, "`size` is width and height", line, path, context)
}

/// Corrects a number of timesteps or frames: computes the timestep or the frame rate from that number and the duration.
fn rates(table: &Table, spec: &'static TableSpec, path: &str, context: &Context<'_>) -> Option<KeyGroup> {
    /// The keys that other programs use for the number of timesteps.
    const STEP_COUNT_KEYS: [&str; 5] = ["steps", "n_steps", "num_steps", "nsteps", "number_of_steps"];
    /// The keys that other programs use for the number of frames.
    const FRAME_COUNT_KEYS: [&str; 5] =
        ["frames", "n_frames", "num_frames", "frame_count", "number_of_frames"];
    let duration = spec.key("duration").filter(|_| spec.key("integrator").is_some())?.name;
    let number = |entry: &Entry| entry.node.as_number().filter(|number| *number > 0.0);
    let duration = match table
        .entries
        .iter()
        .find(|it| key_of(&it.name.text, spec).is_some_and(|key| key.name == duration))
    {
        Some(entry) => number(entry)?,
        None => 10.0,
    };
    let (entry, key, rate) = match (find(table, &STEP_COUNT_KEYS), find(table, &FRAME_COUNT_KEYS)) {
        (Some(steps), _) => (steps, "step", duration / number(steps)?),
        (None, Some(frames)) if duration > 0.0 => (frames, "frame_rate", number(frames)? / duration),
        _ => return None,
    };
    if table.get(key).is_some() {
        return None;
    }
    let label =
        if key == "step" { "`step` is duration / steps" } else { "`frame_rate` is frames / duration" };
    joined(&[entry], key, label, format!("{key} = {}", units::written(rate)), path, context)
}

/// Corrects `ring = 12, radius = 2` to `ring.count = 12, ring.radius = 2`: the user gave the count as the value of the kind.
fn counted(table: &Table, spec: &'static TableSpec, path: &str) -> Option<KeyGroup> {
    let Rule::ExactlyOne(names) = &spec.rule else { return None };
    let kind = table
        .entries
        .iter()
        .find(|entry| names.contains(&&*entry.name.text) && entry.node.as_number().is_some())?;
    let key = spec.key(&kind.name.text)?;
    let inner = key.kind.table().filter(|inner| inner.key("count").is_some())?;
    let others: Vec<(&Entry, &KeySpec)> = table
        .entries
        .iter()
        .filter(|entry| spec.key(&entry.name.text).is_none())
        .filter_map(|entry| Some((entry, key_of(&entry.name.text, inner)?)))
        .collect();
    let (first, _) = others.first()?;
    let message = format!("unknown key `{}` in {path}", first.name.text);
    let error = Diagnostic::error(Code::UnknownKey, message)
        .at(first.name.span, format!("this is a key of {}", inner.noun))
        .fix(kind.name.span, format!("{}.count", key.name));
    let fix = |error: Diagnostic, (entry, it): &(&Entry, &KeySpec)| {
        error.fix(entry.name.span, format!("{}.{}", key.name, it.name))
    };
    let spans = others.iter().map(|(entry, _)| entry.name.span).chain([kind.name.span]).collect();
    Some(KeyGroup { error: others.iter().fold(error, fix), spans, key: key.name })
}

/// Returns the source text of a number or a formula. `None` for other values.
fn value(entry: &Entry, context: &Context<'_>) -> Option<String> {
    let is_value = entry.node.as_number().is_some() || entry.node.as_str().is_some();
    is_value.then(|| raw(entry.node.span, context).to_owned())
}

/// Replaces a drag coefficient, an area and a density of the air by the key `quadratic` of a drag force.
fn drag(table: &Table, spec: &TableSpec, path: &str, context: &Context<'_>) -> Option<KeyGroup> {
    /// The keys that other programs use for the drag coefficient.
    const COEFFICIENT_KEYS: [&str; 5] = ["Cd", "cd", "cw", "C_d", "drag_coefficient"];
    /// The keys that other programs use for the area of the cross section.
    const AREA_KEYS: [&str; 4] = ["area", "A", "cross_section", "S"];
    /// The keys that other programs use for the density of the air.
    const DENSITY_KEYS: [&str; 4] = ["density", "rho", "air_density", "fluid_density"];
    let key = spec.key("quadratic").filter(|key| table.get(key.name).is_none())?.name;
    let (coefficient, area) = (find(table, &COEFFICIENT_KEYS)?, find(table, &AREA_KEYS)?);
    let density = find(table, &DENSITY_KEYS);
    let mut entries = vec![coefficient, area];
    entries.extend(density);
    entries.sort_by_key(|entry| entry.name.span);
    // If the user gives no density, use the density of air at 20 °C and sea level, 1.2 kg/m³.
    let of_air = match density {
        Some(entry) => operand(entry, "kg/m³", context)?,
        None => "1.2".to_owned(),
    };
    let line = format!(
        "{key} = \"0.5*{of_air}*{}*{}\"",
        operand(coefficient, "", context)?,
        operand(area, "m²", context)?
    );
    joined(&entries, key, "`quadratic` is ½ density × drag coefficient × area", line, path, context)
}
