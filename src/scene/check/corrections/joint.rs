//! Corrects common mistakes in joints.

use super::super::Context;
use super::key_group::{KeyGroup, joined};
use super::launch::find;
use super::text::{header_end, raw, removal, whole};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::{Collection, Kind, SCENE, TableSpec};
use crate::scene::source::{Entry, Node, Table, Value};

/// The words that other programs use for an end of a joint that is fixed in the world.
const WORLD_NAMES: [&str; 10] =
    ["world", "ground", "origin", "ceiling", "wall", "space", "fixed", "static", "anchor", "none"];

/// Corrects the limits of a joint: `limits = 45` or `limits = { min = -45, max = 45 }` becomes `[-45, 45]`.
pub(super) fn limits(node: &Node, context: &Context<'_>) -> Option<String> {
    /// The keys that other programs use for the lower limit.
    const LOWER_LIMIT_KEYS: [&str; 6] = ["min", "low", "lower", "minimum", "from", "lo"];
    /// The keys that other programs use for the upper limit.
    const UPPER_LIMIT_KEYS: [&str; 6] = ["max", "high", "upper", "maximum", "to", "hi"];
    let both = |one: &Node| {
        let size = raw(one.span, context).trim_start_matches(['-', '+']);
        one.as_number().map(|_| format!("[-{size}, {size}]"))
    };
    match &node.value {
        Value::Array(items) => match items.as_slice() {
            [only] => both(only),
            _ => None,
        },
        // A fix at this span cannot replace a table that has its own header, so require an inline table.
        Value::Table(table) if raw(node.span, context).starts_with('{') => {
            let [low, high] = [find(table, &LOWER_LIMIT_KEYS)?, find(table, &UPPER_LIMIT_KEYS)?];
            Some(format!("[{}, {}]", raw(low.node.span, context), raw(high.node.span, context)))
        }
        _ => both(node),
    }
}

/// Corrects the value of the key `over` of a pulley, if the value is a point instead of a list of points.
pub(super) fn in_list(node: &Node, context: &Context<'_>) -> Option<String> {
    let point = match &node.value {
        Value::Array(items) => match items.as_slice() {
            [_, _, _] if items.iter().all(|item| item.as_number().is_some()) => node,
            _ => return None,
        },
        Value::String(_) => node,
        _ => return None,
    };
    Some(format!("[{}]", raw(point.span, context)))
}

/// Corrects a hinge or a slider with a `stiffness` of its own: moves the stiffness and the damping into a new `motor` of the joint.
pub(super) fn spring(table: &Table, spec: &TableSpec, path: &str, context: &Context<'_>) -> Option<KeyGroup> {
    let motor = spec.key("motor").filter(|motor| table.get(motor.name).is_none())?;
    let [value, _] = values(motor.kind.table()?)?;
    let is_value = |entry: &&Entry| entry.node.as_number().is_some();
    let stiffness = find(table, &["stiffness", "spring", "spring_constant", "k"]).filter(is_value)?;
    let damping = find(table, &["damping", "damper", "damping_constant", "d"]).filter(is_value);
    let mut line = format!("motor = {{ {value} = 0, stiffness = {}", raw(stiffness.node.span, context));
    if let Some(damping) = damping {
        line += &format!(", damping = {}", raw(damping.node.span, context));
    }
    let mut entries: Vec<&Entry> = std::iter::once(stiffness).chain(damping).collect();
    entries.sort_by_key(|entry| entry.name.span);
    let label = format!("a spring at {} is a motor that gives way", spec.noun);
    joined(&entries, motor.name, &label, line + " }", path, context)
}

/// Returns the two keys that can give the target of a motor: the key `angle` or `position`, and the key `speed`.
fn values(spec: &TableSpec) -> Option<[&'static str; 2]> {
    let key = |name: &str| spec.key(name).map(|key| key.name);
    Some([key("angle").or_else(|| key("position"))?, key("speed")?])
}

/// Returns the line that is missing in the table of a motor. The line gives a target value if the motor has a stiffness or a damping, and a
/// speed if the motor has a maximum torque or force.
pub(super) fn motor_value(table: &Table, spec: &TableSpec) -> Option<String> {
    let [value, speed] = values(spec)?;
    let has = |names: [&str; 2]| names.iter().any(|name| table.get(name).is_some());
    if has(["stiffness", "damping"]) {
        Some(format!("{value} = 0"))
    } else {
        has(["torque", "force"]).then(|| format!("{speed} = 1"))
    }
}

/// Corrects an end that names the world, such as `"ground"`: replaces it by the point `[0, 0, 0]` of the world.
pub(super) fn world(error: &Diagnostic, node: &Node, kind: &Kind) -> Option<Diagnostic> {
    let Kind::Either(kinds) = kind else { return None };
    let is_point = |kind: &Kind| matches!(kind, Kind::Numbers(3, _));
    let is_world = WORLD_NAMES.contains(&node.as_str()?.to_lowercase().as_str());
    let takes_points = kind.names(Collection::Body) && kinds.iter().any(is_point);
    (is_world && takes_points && error.code == Code::UnknownName).then(|| {
        Diagnostic { labels: Vec::new(), help: None, fix: None, ..error.clone() }
            .at(node.span, "a point of the world is a list of its coordinates, in metres")
            .fix(node.span, "[0, 0, 0]")
    })
}

/// Recognizes a joint that stands in `[force.NAME]`, or a force that stands in `[joint.NAME]`. Returns the text of a label that shows the
/// right table header, and the edit that corrects the header.
pub(super) fn other_section(
    entry: &Entry,
    table: &Table,
    spec: &TableSpec,
    path: &str,
    context: &Context<'_>,
) -> Option<(String, Option<(Span, String)>)> {
    let (own, other) = match spec.noun {
        "a force" => ("force", "joint"),
        "a joint" => ("joint", "force"),
        _ => return None,
    };
    let Kind::Named(others) = SCENE.key(other)?.kind else { return None };
    let kind = others.key(&entry.name.text).filter(|key| key.kind.table().is_some())?.name;
    let name = path.strip_prefix(&format!("[{own}."))?.strip_suffix(']')?;
    let label = format!("this is {}: `[{other}.{name}.{kind}]`", others.noun);
    let line = context.sources.line_before(entry.name.span);
    let is_header = table.entries.len() == 1 && line.starts_with(&format!("[{own}."));
    let place = entry.name.span.place_before(line.len().saturating_sub(1)).grown(0, own.len());
    Some((label, is_header.then(|| (place, other.to_owned()))))
}

/// A fix for `type = "hinge"` below `[joint.knee]`: the header becomes `[joint.knee.hinge]`. All other keys of the table must be keys of
/// the hinge.
pub(super) struct KindInHeader {
    /// The edits that add the kind to the header and remove the line with the kind.
    pub(super) edits: [(Span, String); 2],
    /// The spans of the keys that are valid after the fix.
    pub(super) keys: Vec<Span>,
}

/// Returns the fix that moves the kind of a joint from a line, such as `type = "hinge"`, into the header of the table. `None` if the table
/// has no header or has keys of another kind.
pub(super) fn kind_in_header(
    word: &Entry,
    kind: &str,
    inner: &TableSpec,
    table: &Table,
    at: Option<Span>,
    context: &Context<'_>,
) -> Option<KindInHeader> {
    let others: Vec<&Entry> =
        table.entries.iter().filter(|entry| entry.name.span != word.name.span).collect();
    if others.is_empty() || others.iter().any(|entry| inner.key(&entry.name.text).is_none()) {
        return None;
    }
    let at = at?;
    let rest = context.sources.raw(at.place_after(0).to(header_end(at, context)?)?);
    let place = rest.find(']').filter(|place| rest[..*place].trim_matches('"').is_empty())?;
    let header = (at.place_after(place), format!(".{kind}"));
    let line = (removal(whole(word)?, context)?, String::new());
    Some(KindInHeader { edits: [header, line], keys: others.iter().map(|entry| entry.name.span).collect() })
}
