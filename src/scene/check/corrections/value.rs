//! Corrects values of a wrong type and lists of a wrong length.

use super::super::Context;
use super::text::{raw, whole};
use super::{ends, joint, table, vector};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::Color;
use crate::scene::grammar::{Bound, Collection, Kind, unit_of_key};
use crate::scene::source::{Entry, Node, Value};

/// Adds fixes for a value of a wrong type or length to the diagnostics from index `before` on.
pub(in crate::scene::check) fn correct_value(
    before: usize,
    node: &Node,
    kind: &'static Kind,
    entry: Option<&Entry>,
    context: &mut Context<'_>,
) {
    for at in before..context.diagnostics.len() {
        let diagnostic = &context.diagnostics[at];
        if diagnostic.span() == Some(node.span)
            && let Some(error) = joint::world(diagnostic, node, kind)
        {
            context.diagnostics[at] = error;
            continue;
        }
        let is_of_it = matches!(diagnostic.code, Code::WrongType | Code::WrongLength)
            && diagnostic.span() == Some(node.span);
        if !is_of_it || diagnostic.fix.is_some() {
            continue;
        }
        let fix = better(node, kind, entry.map_or("", |entry| &entry.name.text), context)
            .map(|text| (node.span, text))
            .or_else(|| numbers_of_a_color(node, kind, entry?, context))
            .or_else(|| body_to_look_at(node, entry?, context))
            .or_else(|| file_of_a_motion(node, entry?, context));
        if let Some((span, text)) = fix {
            context.diagnostics[at] = context.diagnostics[at].clone().fix(span, text);
        }
    }
}

/// Corrects a list of three numbers where a material is expected. Returns the span of the entry, and a line that gives the material this
/// color.
fn numbers_of_a_color(
    node: &Node,
    kind: &Kind,
    entry: &Entry,
    context: &Context<'_>,
) -> Option<(Span, String)> {
    let Value::Array(items) = &node.value else { return None };
    let is_material = kind.names(Collection::Material) && items.len() == 3;
    is_material
        .then(|| Some((whole(entry)?, format!("{}.color = {}", entry.name.text, raw(node.span, context)))))?
}

/// Corrects the name of a body in the camera's `look_at`. Returns the span of the entry, and a line that makes the camera follow this
/// body.
fn body_to_look_at(node: &Node, entry: &Entry, context: &Context<'_>) -> Option<(Span, String)> {
    let name = node.as_str().filter(|name| context.names.bodies.contains_key(*name))?;
    let is_it = &*entry.name.text == "look_at" && !name.contains(['"', '\\']);
    is_it.then(|| Some((whole(entry)?, format!("follow.body = \"{name}\""))))?
}

/// Corrects the name of a file where a body's motion is expected. Returns the span of the entry, and a line that reads the trajectory from
/// this file.
fn file_of_a_motion(node: &Node, entry: &Entry, context: &Context<'_>) -> Option<(Span, String)> {
    let is_file = |name: &str| {
        let name = name.to_lowercase();
        [".csv", ".txt", ".dat"].iter().any(|end| name.ends_with(end))
    };
    let is_it = &*entry.name.text == "motion" && node.as_str().is_some_and(is_file);
    is_it.then(|| Some((whole(entry)?, format!("motion.trajectory.file = {}", raw(node.span, context)))))?
}

/// Reads `count` whole numbers from a text such as `1920x1080`, and returns them as a TOML list.
fn numbers_of(text: &str, count: usize) -> Option<String> {
    let numbers = text.split(['x', 'X', '×', '*', ',', ';', ' ', ':']).map(str::trim);
    let numbers: Vec<&str> = numbers.filter(|number| !number.is_empty()).collect();
    let are_whole = numbers.iter().all(|number| number.parse::<u32>().is_ok());
    (are_whole && numbers.len() == count).then(|| format!("[{}]", numbers.join(", ")))
}

/// Replaces the error for an unknown material by a better error if the word is a color.
pub(in crate::scene::check) fn color_for_material(
    error: Diagnostic,
    word: &str,
    node: &Node,
    entry: Option<&Entry>,
) -> Diagnostic {
    let Some(entry) = entry.filter(|_| Color::parse(word).is_some()) else { return error };
    let text = format!("{}.color = \"{word}\"", entry.name.text);
    let error = Diagnostic { labels: Vec::new(), help: None, ..error }
        .at(node.span, format!("`{word}` is a color, which is one key of a material"));
    match whole(entry) {
        Some(whole) => error.fix(whole, text),
        None => error,
    }
}

/// Returns the TOML text of a value of the right type that the user probably meant. `None` if there is no good guess.
fn better(node: &Node, kind: &'static Kind, key: &str, context: &Context<'_>) -> Option<String> {
    let raw = raw(node.span, context);
    match (kind, &node.value) {
        (Kind::Either(kinds), Value::Integer(_) | Value::Float(_)) => {
            // Try booleans last: a number rarely stands for a boolean.
            let switches = kinds.iter().filter(|kind| matches!(kind, Kind::Boolean));
            let others = kinds.iter().filter(|kind| !matches!(kind, Kind::Boolean));
            others.chain(switches).find_map(|kind| better(node, kind, key, context))
        }
        (Kind::Either(kinds), _) => kinds.iter().find_map(|kind| better(node, kind, key, context)),
        (Kind::Numbers(3, Bound::Positive), Value::Integer(_) | Value::Float(_)) => {
            Some(format!("[{raw}, {raw}, {raw}]"))
        }
        (Kind::Numbers(3, Bound::Positive), Value::Array(items)) if items.len() < 3 => match items.as_slice()
        {
            [only] if only.as_number().is_some() => {
                let only = super::text::raw(only.span, context);
                Some(format!("[{only}, {only}, {only}]"))
            }
            _ => None,
        },
        (Kind::Direction(3), Value::String(text)) if vector::axis(text).is_some() => vector::axis(text),
        (
            Kind::Numbers(count, _)
            | Kind::TimedNumbers(count, _)
            | Kind::VaryingNumbers(count, _)
            | Kind::Direction(count),
            _,
        ) => vector::list(node, key, unit_of_key(key).unwrap_or(""), *count, context),
        (Kind::Table(spec), _) => table::as_table(spec, node, key, context),
        (Kind::List { min: 2, .. }, _) if key == "limits" => joint::limits(node, context),
        (Kind::List { .. }, _) if key == "over" => joint::in_list(node, context),
        (Kind::List { min: 2, .. }, Value::Array(items)) if key == "between" && items.len() > 2 => None,
        (Kind::List { min: 2, .. }, _) if key == "between" => ends::with_other_end(node, context),
        (Kind::List { of: Kind::Integer(..), min, max }, Value::String(text)) if min == max => {
            numbers_of(text, *min)
        }
        (Kind::Number(_) | Kind::Timed(_) | Kind::Varying(_), Value::Array(items)) => {
            match items.as_slice() {
                [only] => Some(super::text::raw(only.span, context).to_owned()),
                _ => None,
            }
        }
        (Kind::Boolean, Value::String(text)) => match text.to_lowercase().as_str() {
            "true" | "yes" | "on" => Some("true".to_owned()),
            "false" | "no" | "off" => Some("false".to_owned()),
            _ => None,
        },
        (Kind::Choice(words), Value::Boolean(true)) if key == "contacts" => {
            words().first().map(|word| format!("\"{word}\""))
        }
        (Kind::Boolean, Value::Integer(number @ (0 | 1))) => Some((*number == 1).to_string()),
        (Kind::Integer(..), Value::Float(number)) if number.fract() == 0.0 => Some(format!("{number:.0}")),
        (Kind::Text, Value::Integer(_) | Value::Float(_) | Value::Boolean(_) | Value::Datetime) => {
            Some(format!("\"{raw}\""))
        }
        (Kind::List { of, min: 0 | 1, .. }, value)
            if of.takes(value) && !matches!(value, Value::Array(_) | Value::Table(_)) =>
        {
            Some(format!("[{raw}]"))
        }
        _ => None,
    }
}
