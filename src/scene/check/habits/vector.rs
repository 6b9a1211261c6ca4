//! Three numbers that somebody has given in another way.

use super::super::Context;
use super::launch;
use super::text::raw;
use crate::scene::source::{Node, Table, Value, habits};
use crate::scene::units;

/// A list of so many numbers for a value that is something else.
pub(super) fn list(
    node: &Node,
    key: &str,
    unit: &str,
    count: usize,
    context: &Context<'_>,
) -> Option<String> {
    let raw = raw(node.span, context);
    match &node.value {
        Value::Integer(_) | Value::Float(_) if count == 3 => Some(along_an_axis(raw, node.as_number()?, key)),
        Value::String(text) => {
            let inner = text.trim().trim_matches(['(', ')', '[', ']', '<', '>', '{', '}']);
            let number = || {
                let text = match units::quantity(inner) {
                    Some((number, of)) => units::converted(number, of, unit)?,
                    None => inner.to_owned(),
                };
                Some(along_an_axis(&text, text.parse().ok()?, key))
            };
            listed(inner, key, count).or_else(|| if count == 3 { number() } else { None })
        }
        Value::Array(items) if items.len() + 1 == count && count == 3 => {
            Some(format!("{}, 0]", raw.strip_suffix(']')?.trim_end().trim_end_matches(',')))
        }
        Value::Array(_) => listed(raw.strip_prefix('[')?.strip_suffix(']')?, key, count),
        // A table with a header of its own is not replaced where it stands.
        Value::Table(table) if count == 3 && raw.starts_with('{') => {
            by_component(table, context).or_else(|| launch::by_angle(table, context))
        }
        _ => None,
    }
}

/// A vector for a number that somebody has given in its place: along the axis that is most likely meant.
pub(super) fn along_an_axis(raw: &str, number: f64, key: &str) -> String {
    match key {
        "gravity" if number > 0.0 => format!("[0, -{raw}, 0]"),
        "gravity" | "angular_velocity" | "torque" => format!("[0, {raw}, 0]"),
        "size" => format!("[{raw}, {raw}, {raw}]"),
        "orientation" | "euler" => format!("[0, 0, {raw}]"),
        _ => format!("[{raw}, 0, 0]"),
    }
}

/// `{ x = 1, y = 2 }`
fn by_component(table: &Table, context: &Context<'_>) -> Option<String> {
    let place = |name: &str| match name.to_lowercase().as_str() {
        "x" => Some(0),
        "y" => Some(1),
        "z" => Some(2),
        _ => None,
    };
    let mut parts = ["0"; 3];
    for entry in &table.entries {
        *parts.get_mut(place(&entry.name.text)?)? = raw(entry.node.span, context);
    }
    (!table.entries.is_empty()).then(|| format!("[{}]", parts.join(", ")))
}

/// So many numbers of a text, whatever stands between them.
fn listed(inner: &str, key: &str, count: usize) -> Option<String> {
    let (text, _) = habits::list(inner, key)?;
    let numbers =
        text.trim_matches(['[', ']']).split(", ").filter(|item| item.parse::<f64>().is_ok()).count();
    (numbers == count && habits::items(&text) == count).then_some(text)
}
