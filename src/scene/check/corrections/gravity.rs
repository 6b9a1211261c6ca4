//! Corrects a force that means the uniform gravity of the scene, such as `[force.g]` with `gravity = true`.

use super::super::Context;
use super::missing::insertion;
use super::text::{header_end, is_file, raw, whole};
use super::vector::along_an_axis;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::TableSpec;
use crate::scene::source::{Entry, Table, Value};

/// The keys that other programs use for the acceleration of gravity.
const GRAVITY_KEYS: [&str; 4] = ["gravity", "g", "gravitational_acceleration", "weight"];
/// Further keys that people give to a force of gravity.
const OTHER_GRAVITY_KEYS: [&str; 12] = [
    "type",
    "kind",
    "on",
    "body",
    "bodies",
    "value",
    "acceleration",
    "strength",
    "magnitude",
    "enabled",
    "direction",
    "constant",
];
/// The smallest number that counts as an acceleration, m/s². Newton's constant is far smaller.
const MIN_ACCELERATION: f64 = 1e-3;

/// Returns the error for a force whose keys describe uniform gravity. `None` for other forces. `at` is the span of the force's name.
pub(in crate::scene::check) fn gravity(
    table: &Table,
    spec: &TableSpec,
    at: Option<Span>,
    path: &str,
    context: &Context<'_>,
) -> Option<Diagnostic> {
    let at = at.filter(|_| spec.noun == "a force")?;
    let name = |entry: &Entry| entry.name.text.to_lowercase();
    let is_number =
        |entry: &Entry| entry.node.as_number().is_some_and(|number| number.abs() >= MIN_ACCELERATION);
    let is_value = |entry: &Entry| match &entry.node.value {
        Value::Boolean(is_on) => *is_on,
        Value::Array(items) => items.iter().all(|item| item.as_number().is_some()),
        _ => is_number(entry),
    };
    let is_gravity = |entry: &Entry| GRAVITY_KEYS.contains(&name(entry).as_str()) && is_value(entry);
    let is_word = |entry: &Entry| {
        let word = entry.node.as_str().map(str::to_lowercase);
        matches!(name(entry).as_str(), "type" | "kind")
            && matches!(word.as_deref(), Some("gravity" | "uniform_gravity" | "uniform-gravity" | "weight"))
    };
    let is_beside =
        |entry: &Entry| OTHER_GRAVITY_KEYS.contains(&name(entry).as_str()) && entry.node.as_table().is_none();
    let marks = |entry: &&Entry| is_gravity(entry) || is_word(entry);
    let mark = table.entries.iter().find(marks)?;
    if !table.entries.iter().all(|entry| is_gravity(entry) || is_beside(entry)) {
        return None;
    }
    // A force between bodies that names several of them is Newton's gravitation.
    let is_list = |entry: &Entry| matches!(&entry.node.value, Value::Array(items) if items.len() > 1);
    let has_several =
        table.entries.iter().any(|entry| matches!(name(entry).as_str(), "on" | "bodies") && is_list(entry));
    let vector = table.entries.iter().find_map(|entry| match &entry.node.value {
        Value::Array(items) if items.len() == 3 && !name(entry).contains("bod") && is_value(entry) => {
            Some(raw(entry.node.span, context).to_owned())
        }
        _ => is_number(entry).then(|| {
            along_an_axis(
                raw(entry.node.span, context),
                entry.node.as_number().unwrap_or_default(),
                "gravity",
            )
        }),
    });
    if vector.is_none() && has_several {
        return None;
    }
    let line = format!("gravity = {}", vector.unwrap_or_else(|| "[0, -9.81, 0]".to_owned()));
    let error =
        Diagnostic::error(Code::UnknownKey, format!("the gravity of {path} is a key of the simulation"));
    let error = error.at(mark.name.span, format!("write `{line}` in [simulation]"));
    Some(match edits(table, at, &line, context) {
        Some(edits) => edits.into_iter().fold(error, |error, (span, text)| error.fix(span, text)),
        None => error,
    })
}

/// Returns the edits that remove the force, and that add `line` to the table `[simulation]`. `None` if the force has no header of its own.
fn edits(table: &Table, at: Span, line: &str, context: &Context<'_>) -> Option<Vec<(Span, String)>> {
    let header = header_end(at, context).filter(|_| is_file(at.source(), &context.sources))?;
    let wholes = table.entries.iter().filter_map(whole);
    // The last entry is the one that ends furthest from the header.
    let last = wholes.filter_map(|entry| header.to(entry)).max_by_key(|span| span.len())?;
    let before = context.sources.line_before(at).len();
    let rest = context.sources.after(last);
    let after = rest.find('\n').map_or(rest.len(), |newline| newline + 1);
    let force = at.to(last)?.grown(before, after);
    // Another table between the lines of the force would be removed, too.
    if raw(last.grown(0, after), context).lines().any(|line| line.trim_start().starts_with('[')) {
        return None;
    }
    let has_gravity = ["gravity =", "gravity="].iter().any(|key| {
        let (text_before, text_after) = (context.sources.before(at), context.sources.after(last));
        text_before.contains(key) || text_after.contains(key)
    });
    match context.tables.get("simulation") {
        None => Some(vec![(force, format!("[simulation]\n{line}\n"))]),
        Some(simulation) if simulation.source() == at.source() && !has_gravity => {
            Some(vec![(force, String::new()), insertion(*simulation, line, context)?])
        }
        Some(_) => Some(vec![(force, String::new())]),
    }
}
