//! Adds fixes to errors about missing keys. Each fix inserts the key with an example value.

use super::super::Context;
use super::text::{header_end, is_file};
use super::{ends, joint, key_of};
use crate::diagnostic::{Diagnostic, Span};
use crate::scene::grammar::{KeySpec, Kind, Rule, TableSpec};
use crate::scene::source::Table;

/// Adds a fix that inserts the missing key `key` with an example value into the table whose name is at the span `at`.
pub(in crate::scene::check) fn correct_missing(
    error: Diagnostic,
    key: &KeySpec,
    at: Option<Span>,
    context: &Context<'_>,
) -> Diagnostic {
    // A body that only `--set` names is probably misspelled.
    if let Some(at) = at.filter(|at| !is_file(at.source(), &context.sources)) {
        let word = super::text::raw(at, context);
        let others = context.names.bodies.keys().map(AsRef::as_ref).filter(|name| *name != word);
        return match super::super::suggest::nearest(word, others) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error,
        };
    }
    let text = match &key.kind {
        Kind::Table(spec) => match &spec.rule {
            Rule::ExactlyOne(names) => match spec.key(names[0]) {
                Some(first) => {
                    first.kind.table().and_then(|inner| example(&[key.name, first.name], inner, context))
                }
                None => None,
            },
            _ => None,
        },
        _ => example_of(key, context).map(|value| format!("{} = {value}", key.name)),
    };
    inserted(error, text, at, context)
}

/// Adds a fix to the error for a table that does not give its kind, such as a `shape` without `sphere` or any other kind. If the table has
/// the name of a kind, as `[joint.hinge]` has, the fix inserts an example of this kind.
pub(in crate::scene::check) fn correct_kind(
    error: Diagnostic,
    table: &Table,
    spec: &'static TableSpec,
    at: Option<Span>,
    path: &str,
    context: &Context<'_>,
) -> Diagnostic {
    if let Some(text) = joint::motor_value(table, spec) {
        return inserted(error, Some(text), at, context);
    }
    let name = path.rsplit(['.', '[']).next().unwrap_or_default().trim_matches([']', '"']);
    let Some(key) = key_of(name, spec) else { return error };
    let text = key.kind.table().and_then(|inner| example(&[key.name], inner, context));
    inserted(error, text, at, context)
}

fn inserted(error: Diagnostic, text: Option<String>, at: Option<Span>, context: &Context<'_>) -> Diagnostic {
    match at.zip(text).and_then(|(at, text)| insertion(at, &text, context)) {
        Some((span, text)) => error.fix(span, text),
        None => error,
    }
}

/// Returns the TOML text of an example of a kind of shape, force or joint, such as `shape.sphere.radius = 0.5`. `None` if a required key
/// has no example value.
pub(super) fn example(way: &[&str], spec: &'static TableSpec, context: &Context<'_>) -> Option<String> {
    let mut keys: Vec<&KeySpec> = spec.keys().filter(|key| key.required).collect();
    if keys.is_empty() {
        // Add one optional key: an empty drag or Lorentz force would have no effect.
        keys.extend(spec.keys().find(|key| matches!(key.name, "linear" | "magnetic")));
    }
    let values: Vec<(&str, String)> =
        keys.iter().map(|key| Some((key.name, example_of(key, context)?))).collect::<Option<_>>()?;
    let way = way.join(".");
    Some(match values.as_slice() {
        [] => format!("{way} = {{}}"),
        [(key, value)] => format!("{way}.{key} = {value}"),
        values => {
            let entries: Vec<String> = values.iter().map(|(key, value)| format!("{key} = {value}")).collect();
            format!("{way} = {{ {} }}", entries.join(", "))
        }
    })
}

/// Returns the TOML text of an example value for a key. `None` if there is no example for this kind of value.
pub(super) fn example_of(key: &KeySpec, context: &Context<'_>) -> Option<String> {
    let text = match (&key.kind, key.name) {
        (Kind::List { .. }, "between") => return ends::example(context),
        (Kind::Number(_), "radius" | "every") => "0.5",
        (Kind::Number(_), "tube_radius" | "linear") => "0.1",
        (Kind::Number(_), "stiffness" | "period") => "10",
        (Kind::Number(_), _) => "1",
        (Kind::Integer(..), "count") => "5",
        (Kind::Numbers(3, _), "size") => "[1, 1, 1]",
        (Kind::Numbers(3, _), "magnetic") => "[0, 0, 1]",
        (Kind::Numbers(3, _), "to") => "[4, 0, 0]",
        (Kind::TimedNumbers(3, _) | Kind::VaryingNumbers(3, _), "location") => "[3, 5, 4]",
        (Kind::Direction(3), "direction") => "[-1, -2, -1]",
        (Kind::Direction(3), "axis") => "[0, 0, 1]",
        (Kind::Text, "text") => "\"t = ${t:.2} s\"",
        _ => return None,
    };
    Some(text.to_owned())
}

/// Returns the source position at which a missing line of a named table is to be inserted, and the text to insert. `at` is the span of the
/// table's name.
pub(in crate::scene::check) fn insertion(
    at: Span,
    line: &str,
    context: &Context<'_>,
) -> Option<(Span, String)> {
    if !is_file(at.source(), &context.sources) {
        return None;
    }
    let (before, rest) = (context.sources.line_before(at), context.sources.after(at));
    if let Some(end) = header_end(at, context) {
        let is_last = context.sources.line_after(at).trim_start_matches('"').starts_with(']');
        return is_last.then(|| (end, format!("\n{line}")));
    }
    let name = context.sources.raw(at);
    if rest.starts_with('.') && !before.contains(['{', '[', '=']) && !name.contains(['{', '[', '=']) {
        let end = at.place_after(context.sources.line_after(at).len());
        return Some((end, format!("\n{before}{name}.{line}")));
    }
    let brace = rest.trim_start().strip_prefix('=')?.trim_start().strip_prefix('{')?;
    let comma = if brace.trim_start().starts_with('}') { " " } else { "," };
    Some((at.place_after(rest.len() - brace.len()), format!(" {line}{comma}")))
}
