//! Corrects vectors that are not written as a list of numbers.

use super::super::Context;
use super::launch;
use super::text::raw;
use crate::scene::source::{Node, Table, Value, corrections};
use crate::scene::units;

/// Returns the TOML list of `count` numbers that the user probably meant by a value of another type or length. `None` if there is no good
/// guess.
pub(super) fn list(
    node: &Node,
    key: &str,
    unit: &str,
    count: usize,
    context: &Context<'_>,
) -> Option<String> {
    let raw = raw(node.span, context);
    match &node.value {
        Value::Boolean(is_on) if key == "gravity" => {
            Some(if *is_on { "[0, -9.81, 0]" } else { "[0, 0, 0]" }.to_owned())
        }
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
        Value::Array(items) if items.len() == 1 && matches!(items[0].value, Value::Array(_)) => {
            Some(super::text::raw(items[0].span, context).to_owned())
        }
        Value::Array(items) if matches!(items.len(), 1 | 2) && count == 3 => {
            let zeros = if items.len() == 1 { ", 0, 0" } else { ", 0" };
            Some(format!("{}{zeros}]", raw.strip_suffix(']')?.trim_end().trim_end_matches(',')))
        }
        Value::Array(_) => listed(raw.strip_prefix('[')?.strip_suffix(']')?, key, count),
        // A fix at this span cannot replace a table that has its own header, so require an inline table.
        Value::Table(table) if count == 3 && raw.starts_with('{') => by_component(table, context)
            .or_else(|| launch::by_angle(table, context))
            .or_else(|| by_axis(table, unit)),
        _ => None,
    }
}

/// Returns the unit vector in a direction given by a letter or a word, such as `z`, `-y` or `up`.
pub(super) fn axis(text: &str) -> Option<String> {
    let word = text.trim().to_lowercase();
    let (sign, name) = match word.strip_prefix('-') {
        Some(name) => ("-", name),
        None => ("", word.strip_prefix('+').unwrap_or(&word)),
    };
    match name {
        "x" | "right" => Some(format!("[{sign}1, 0, 0]")),
        "y" | "up" => Some(format!("[0, {sign}1, 0]")),
        "z" => Some(format!("[0, 0, {sign}1]")),
        "down" if sign.is_empty() => Some("[0, -1, 0]".to_owned()),
        "left" if sign.is_empty() => Some("[-1, 0, 0]".to_owned()),
        _ => None,
    }
}

/// Returns the vector for a single number: along the axis that is most likely for this key, such as −y for `gravity`.
pub(super) fn along_an_axis(raw: &str, number: f64, key: &str) -> String {
    match key {
        "gravity" if number > 0.0 => format!("[0, -{raw}, 0]"),
        "gravity" | "angular_velocity" | "torque" => format!("[0, {raw}, 0]"),
        "orientation" | "euler" => format!("[0, 0, {raw}]"),
        _ => format!("[{raw}, 0, 0]"),
    }
}

/// Returns the vector of a table with components, such as `{ x = 1, y = 2 }`.
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

/// Returns the vector of a table with a direction and a magnitude, such as `{ axis = [0, 1, 0], rate = 100 }`.
fn by_axis(table: &Table, unit: &str) -> Option<String> {
    /// The keys for the magnitude.
    const MAGNITUDE_KEYS: [&str; 8] =
        ["rate", "speed", "omega", "magnitude", "value", "size", "w", "strength"];
    let [one, two] = table.entries.as_slice() else { return None };
    let (axis, size) = if &*one.name.text == "axis" { (one, two) } else { (two, one) };
    if !matches!(&*axis.name.text, "axis" | "direction") || !MAGNITUDE_KEYS.contains(&&*size.name.text) {
        return None;
    }
    let size = match size.node.as_str() {
        Some(text) => {
            let (number, of) = units::quantity(text)?;
            units::converted(number, of, unit)?.parse().ok()?
        }
        None => size.node.as_number()?,
    };
    let axis = match &axis.node.value {
        Value::Array(items) => items.iter().map(Node::as_number).collect::<Option<Vec<f64>>>()?,
        _ => return None,
    };
    let length = axis.iter().map(|part| part * part).sum::<f64>().sqrt();
    let is_direction = axis.len() == 3 && length > 0.0 && length.is_finite();
    let parts = axis.iter().map(|part| units::written(part / length * size));
    is_direction.then(|| format!("[{}]", parts.collect::<Vec<_>>().join(", ")))
}

/// Returns the TOML list of the numbers in a text with any separators. `None` if there are not exactly `count` numbers.
fn listed(inner: &str, key: &str, count: usize) -> Option<String> {
    let (text, _) = corrections::list(inner, key)?;
    let numbers =
        text.trim_matches(['[', ']']).split(", ").filter(|item| item.parse::<f64>().is_ok()).count();
    (numbers == count && corrections::items(&text) == count).then_some(text)
}
