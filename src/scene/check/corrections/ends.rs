//! Corrects springs and joints that give each end by a key of its own, as other programs do.

use super::super::Context;
use super::key_group::{KeyGroup, joined};
use super::key_of;
use super::kind::MeantKind;
use super::text::raw;
use crate::scene::grammar::TableSpec;
use crate::scene::source::{Entry, Node, Table, Value};

/// The keys that other programs use for an end of a spring or a joint.
const END_KEYS: [&str; 34] = [
    "from",
    "to",
    "start",
    "end",
    "a",
    "b",
    "first",
    "second",
    "body",
    "other",
    "anchor",
    "body1",
    "body2",
    "body_1",
    "body_2",
    "body_a",
    "body_b",
    "object",
    "object1",
    "object2",
    "end1",
    "end2",
    "p1",
    "p2",
    "parent",
    "child",
    "fixed_point",
    "fixed_end",
    "pivot",
    "point",
    "attached_to",
    "on",
    "source",
    "target",
];

/// Returns whether other programs use this key for an end of a spring or a joint.
pub(super) fn is_end(entry: &Entry) -> bool {
    END_KEYS.contains(&entry.name.text.to_lowercase().as_str())
}

/// Reports keys that give the ends one by one, with a fix that replaces them by `between`. `None` if there are no such keys.
pub(super) fn correct_ends(
    table: &Table,
    spec: &'static TableSpec,
    meant: Option<&MeantKind>,
    path: &str,
    context: &Context<'_>,
) -> Option<KeyGroup> {
    let (way, inner) = match meant {
        Some(meant) => (meant.way.as_slice(), meant.spec),
        None => (&[][..], spec),
    };
    let between = inner.key("between")?;
    if table.get(between.name).is_some() {
        return None;
    }
    let is_end = |entry: &&Entry| {
        let word = &entry.name.text;
        self::is_end(entry) && spec.key(word).is_none() && inner.key(word).is_none()
    };
    let mut entries: Vec<&Entry> = table.entries.iter().filter(is_end).collect();
    entries.sort_by_key(|entry| entry.name.span);
    if entries.len() > 2 {
        // Skip a key that has another meaning in this table, such as the `anchor` of a hinge.
        entries.retain(|entry| key_of(&entry.name.text, inner).is_none_or(|key| key.name == between.name));
    }
    let (first, second) = match entries.as_slice() {
        [only] => (*only, None),
        [first, second] => (*first, Some(*second)),
        _ => return None,
    };
    let list = match second {
        Some(second) => {
            format!("[{}, {}]", end(&first.node, context), end(&second.node, context))
        }
        None => with_other_end(&first.node, context)?,
    };
    let key = way.iter().copied().chain([between.name]).collect::<Vec<_>>().join(".");
    let line = format!("{key} = {list}");
    let entries: Vec<&Entry> = std::iter::once(first).chain(second).collect();
    let meant = way.first().copied().unwrap_or(between.name);
    joined(&entries, meant, "`between` lists both ends", line, path, context)
}

/// Returns the text of one end for the list `between`. A list with a single name becomes that name.
fn end<'a>(node: &Node, context: &'a Context<'_>) -> &'a str {
    match &node.value {
        Value::Array(items) => match items.as_slice() {
            [only] => raw(only.span, context),
            _ => raw(node.span, context),
        },
        _ => raw(node.span, context),
    }
}

/// Returns the text of the list `between` if the user has given only one end. The other end becomes another body, or a point of the world
/// if there is no other body.
pub(super) fn with_other_end(node: &Node, context: &Context<'_>) -> Option<String> {
    let (one, name) = match &node.value {
        Value::Array(items) => match items.as_slice() {
            [only] => (raw(only.span, context), only.as_str()),
            [first, second] if first.as_str().is_some() && second.as_str().is_some() => {
                return Some(raw(node.span, context).to_owned());
            }
            [_, _, _] => (raw(node.span, context), None),
            _ => return None,
        },
        Value::String(name) => (raw(node.span, context), Some(&**name)),
        _ => return None,
    };
    let other = bodies(context).into_iter().find(|body| Some(*body) != name);
    let other = other.map_or_else(|| "[0, 0, 0]".to_owned(), |body| format!("\"{body}\""));
    Some(format!("[{one}, {other}]"))
}

/// Returns an example of the list `between` with bodies of the scene. `None` if the scene has no bodies.
pub(super) fn example(context: &Context<'_>) -> Option<String> {
    match bodies(context).as_slice() {
        [] => None,
        [only] => Some(format!("[\"{only}\", [0, 0, 0]]")),
        [first, second, ..] => Some(format!("[\"{first}\", \"{second}\"]")),
    }
}

/// Returns the names of up to three bodies for an example, in the order of the file. Copies of a body count as one name.
fn bodies<'a>(context: &'a Context<'_>) -> Vec<&'a str> {
    let mut names: Vec<(&str, usize)> = context
        .names
        .bodies
        .iter()
        .map(|(name, number)| (context.groups.original(name).unwrap_or(name), *number))
        .filter(|(name, _)| !name.contains(['"', '\\']))
        .collect();
    names.sort_unstable_by_key(|(_, number)| *number);
    names.dedup_by_key(|(name, _)| *name);
    names.truncate(3);
    names.into_iter().map(|(name, _)| name).collect()
}
