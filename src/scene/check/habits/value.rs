//! Values of a wrong type, or lists of a wrong length.

use super::super::Context;
use super::text::{raw, whole};
use super::{ends, table, vector};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::Color;
use crate::scene::grammar::{Collection, Kind, unit_of_key};
use crate::scene::source::{Entry, Node, Value};

/// Adds what belongs in the place of values of a wrong type or length, to what has been said since there were `before`
/// diagnostics.
pub(in crate::scene::check) fn mend_value(
    before: usize,
    node: &Node,
    kind: &'static Kind,
    entry: Option<&Entry>,
    context: &mut Context<'_>,
) {
    for at in before..context.diagnostics.len() {
        let diagnostic = &context.diagnostics[at];
        let is_of_it = matches!(diagnostic.code, Code::WrongType | Code::WrongLength)
            && diagnostic.span() == Some(node.span);
        if !is_of_it || diagnostic.fix.is_some() {
            continue;
        }
        let fix = better(node, kind, entry.map_or("", |entry| &entry.name.text), context)
            .map(|text| (node.span, text))
            .or_else(|| numbers_of_a_color(node, kind, entry?, context));
        if let Some((span, text)) = fix {
            context.diagnostics[at] = context.diagnostics[at].clone().fix(span, text);
        }
    }
}

/// The line that gives a material the color whose numbers stand in its place.
fn numbers_of_a_color(
    node: &Node,
    kind: &Kind,
    entry: &Entry,
    context: &Context<'_>,
) -> Option<(Span, String)> {
    let Value::Array(items) = &node.value else { return None };
    let is_material = kind.names(Collection::Material) && items.len() == 3;
    is_material.then(|| (whole(entry), format!("{}.color = {}", entry.name.text, raw(node.span, context))))
}

/// That a color stands where a material should.
pub(in crate::scene::check) fn color_for_material(
    error: Diagnostic,
    word: &str,
    node: &Node,
    entry: Option<&Entry>,
) -> Diagnostic {
    let Some(entry) = entry.filter(|_| Color::parse(word).is_some()) else { return error };
    let text = format!("{}.color = \"{word}\"", entry.name.text);
    Diagnostic { labels: Vec::new(), help: None, ..error }
        .at(node.span, format!("`{word}` is a color, which is one key of a material"))
        .fix(whole(entry), text)
}

/// A value of the right kind that says what a wrong one was meant to say.
fn better(node: &Node, kind: &'static Kind, key: &str, context: &Context<'_>) -> Option<String> {
    let raw = raw(node.span, context);
    match (kind, &node.value) {
        (Kind::Either(kinds), Value::Integer(_) | Value::Float(_)) => {
            // A number is a size more often than a switch.
            let switches = kinds.iter().filter(|kind| matches!(kind, Kind::Boolean));
            let others = kinds.iter().filter(|kind| !matches!(kind, Kind::Boolean));
            others.chain(switches).find_map(|kind| better(node, kind, key, context))
        }
        (Kind::Either(kinds), _) => kinds.iter().find_map(|kind| better(node, kind, key, context)),
        (Kind::Numbers(count, _) | Kind::TimedNumbers(count, _) | Kind::Direction(count), _) => {
            vector::list(node, key, unit_of_key(key).unwrap_or(""), *count, context)
        }
        (Kind::Table(spec), _) => table::as_table(spec, node, key, context),
        (Kind::List { min: 2, .. }, Value::Array(items)) if key == "between" && items.len() > 2 => None,
        (Kind::List { min: 2, .. }, _) if key == "between" => ends::with_other_end(node, context),
        (Kind::Number(_) | Kind::Timed(_), Value::Array(items)) => match items.as_slice() {
            [only] => {
                Some(raw.get(only.span.start - node.span.start..only.span.end - node.span.start)?.to_owned())
            }
            _ => None,
        },
        (Kind::Boolean, Value::String(text)) => match text.to_lowercase().as_str() {
            "true" | "yes" | "on" => Some("true".to_owned()),
            "false" | "no" | "off" => Some("false".to_owned()),
            _ => None,
        },
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
