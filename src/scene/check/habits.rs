//! What should have been written in the place of a key or a value, as text that can be pasted.

use super::Context;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::Color;
use crate::scene::grammar::{Collection, Key, Kind, Rule, TableSpec};
use crate::scene::source::{Entry, Node, Table, Value, habits};

/// What bodies of other programs have and those of a scene have not.
const OF_CONTACT: [&str; 11] = [
    "restitution",
    "bounciness",
    "bounce",
    "elasticity",
    "friction",
    "rolling_friction",
    "static_friction",
    "collision",
    "collider",
    "collides",
    "contact",
];

/// A kind that somebody has named by a word instead of a table: `shape = "sphere"`, `type = "point"`.
pub(super) struct Hint {
    /// The key with that word.
    entry: Span,
    /// The way from the table to the kind: `shape.sphere`.
    pub(super) way: Vec<&'static str>,
    /// The keys of the kind.
    pub(super) spec: &'static TableSpec,
    /// Whether keys of the kind stand beside the word.
    has_keys: bool,
}

/// The kind that a table names by a word.
pub(super) fn hint(table: &Table, spec: &'static TableSpec) -> Option<Hint> {
    let found = table.entries.iter().find_map(|entry| {
        let word = entry.node.as_str()?.to_lowercase();
        let name = &*entry.name.text;
        let (mut way, kinds) = match spec.key(name) {
            Some(Key { kind: Kind::Table(kinds), name, .. }) => (vec![*name], *kinds),
            None if matches!(name, "type" | "kind") => match spec.key("shape").map(|key| &key.kind) {
                Some(Kind::Table(kinds)) => (vec!["shape"], *kinds),
                _ => (Vec::new(), spec),
            },
            _ => return None,
        };
        let Rule::ExactlyOne(names) = &kinds.rule else { return None };
        let is_it =
            |key: &&Key| names.contains(&key.name) && (key.name == word || key.also.contains(&word.as_str()));
        let key = kinds.keys.iter().find(is_it)?;
        way.push(key.name);
        Some((entry.name.span, way, key.kind.table()?))
    });
    let (entry, way, spec) = found?;
    let has_keys = table.entries.iter().any(|entry| key_of(&entry.name.text, spec).is_some());
    Some(Hint { entry, way, spec, has_keys })
}

/// The way to a key of the kind that is named by a word.
pub(super) fn way_by_hint(hint: Option<&Hint>, word: &str) -> Option<Vec<&'static str>> {
    let hint = hint?;
    let key = key_of(word, hint.spec)?;
    Some(hint.way.iter().copied().chain([key]).collect())
}

fn key_of(word: &str, spec: &'static TableSpec) -> Option<&'static str> {
    let folded = word.to_lowercase();
    spec.keys.iter().find(|key| key.name == folded || key.also.contains(&folded.as_str())).map(|key| key.name)
}

/// Adds what belongs in the place of the word of a hint.
pub(super) fn mend_hint(hint: &Hint, table: &Table, before: usize, context: &mut Context<'_>) {
    let Some(entry) = table.entries.iter().find(|entry| entry.name.span == hint.entry) else { return };
    let whole = Span { end: entry.node.span.end, ..entry.name.span };
    let example = if hint.has_keys {
        whole_line(whole, context).map(|line| (line, String::new()))
    } else {
        example(&hint.way, hint.spec).map(|text| (whole, text))
    };
    let is_of_it = |diagnostic: &&mut Diagnostic| {
        diagnostic.span().is_some_and(|span| span == entry.name.span || span == entry.node.span)
    };
    if let (Some(diagnostic), Some((span, text))) =
        (context.diagnostics[before..].iter_mut().find(is_of_it), example)
    {
        *diagnostic = Diagnostic { fix: None, ..diagnostic.clone() }.fix(span, text);
    }
}

/// A key that is unknown, with what belongs in its place: another key, or nothing.
pub(super) fn mend_unknown(
    error: Diagnostic,
    entry: &Entry,
    way: Option<&[&'static str]>,
    table: &Table,
    spec: &TableSpec,
    context: &Context<'_>,
) -> Diagnostic {
    let whole = Span { end: entry.node.span.end, ..entry.name.span };
    let Some(way) = way else {
        if spec.key("shape").is_some() && OF_CONTACT.contains(&entry.name.text.to_lowercase().as_str()) {
            let error =
                error.help("bodies do not touch each other yet: nothing bounces or rubs; leave the line out");
            return match whole_line(whole, context) {
                Some(line) => error.fix(line, ""),
                None => error,
            };
        }
        return error;
    };
    match table.get(way[0]) {
        None => error.fix(entry.name.span, way.join(".")).fix_is_said(),
        Some(_) if way.len() == 1 && header_end(entry.name.span, context).is_none() => error,
        Some(_) if way.len() == 1 => error.fix(entry.name.span, way[0]).fix_is_said(),
        Some(first) => {
            match (&first.node.value, header_end(first.name.span, context), whole_line(whole, context)) {
                // The table has a header of its own, below which the key belongs.
                (Value::Table(_), Some(end), Some(line)) => {
                    let text = format!("\n{} = {}", way[1..].join("."), raw(entry.node.span, context));
                    error.fix(line, "").fix(Span { start: end, end, ..line }, text)
                }
                // The word that names the kind goes: see `mend_hint`.
                (Value::String(_), ..) if way[0] == "shape" => {
                    error.fix(entry.name.span, way.join(".")).fix_is_said()
                }
                (Value::Table(_), None, _) => error.fix(entry.name.span, way.join(".")).fix_is_said(),
                // A color beside a material of the library tints it.
                (Value::String(like), _, Some(line)) if way == ["material", "color"] => {
                    let text = format!("{{ like = \"{like}\", color = {} }}", raw(entry.node.span, context));
                    error.fix(line, "").fix(first.node.span, text)
                }
                _ => error,
            }
        }
    }
}

/// A key that is missing, with an example of it at its place.
pub(super) fn mend_missing(
    error: Diagnostic,
    key: &Key,
    at: Option<Span>,
    context: &Context<'_>,
) -> Diagnostic {
    let text = match &key.kind {
        Kind::Table(spec) => match &spec.rule {
            Rule::ExactlyOne(names) => match spec.key(names[0]) {
                Some(first) => first.kind.table().and_then(|inner| example(&[key.name, first.name], inner)),
                None => None,
            },
            _ => None,
        },
        _ => example_of(key).map(|value| format!("{} = {value}", key.name)),
    };
    match at.zip(text).and_then(|(at, text)| insertion(at, &text, context)) {
        Some((span, text)) => error.fix(span, text),
        None => error,
    }
}

/// Adds what belongs in the place of values of a wrong type or length, to what has been said since there were `before`
/// diagnostics.
pub(super) fn mend_value(
    before: usize,
    node: &Node,
    kind: &Kind,
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
        let raw = raw(node.span, context);
        if let Some(text) = better(node, raw, kind, entry.map_or("", |entry| &entry.name.text)) {
            context.diagnostics[at] = diagnostic.clone().fix(node.span, text);
        } else if let (Kind::Either(kinds), Value::Array(items), Some(entry)) = (kind, &node.value, entry)
            && kinds.iter().any(|kind| kind.names(Collection::Material))
            && items.len() == 3
        {
            let whole = Span { end: node.span.end, ..entry.name.span };
            let text = format!("{}.color = {raw}", entry.name.text);
            context.diagnostics[at] = diagnostic.clone().fix(whole, text);
        }
    }
}

/// That a color stands where a material should.
pub(super) fn color_for_material(
    error: Diagnostic,
    word: &str,
    node: &Node,
    entry: Option<&Entry>,
) -> Diagnostic {
    let Some(entry) = entry.filter(|_| Color::parse(word).is_some()) else { return error };
    let whole = Span { end: node.span.end, ..entry.name.span };
    let text = format!("{}.color = \"{word}\"", entry.name.text);
    Diagnostic { labels: Vec::new(), help: None, ..error }
        .at(node.span, format!("`{word}` is a color, which is one key of a material"))
        .fix(whole, text)
}

/// A value of the right kind that says what a wrong one was meant to say.
fn better(node: &Node, raw: &str, kind: &Kind, key: &str) -> Option<String> {
    match (kind, &node.value) {
        (Kind::Either(kinds), _) => kinds.iter().find_map(|kind| better(node, raw, kind, key)),
        (Kind::Numbers(3, _) | Kind::TimedNumbers(3, _), Value::Integer(_) | Value::Float(_)) => {
            Some(along_an_axis(raw, node.as_number()?, key))
        }
        (
            Kind::Numbers(count, _) | Kind::TimedNumbers(count, _) | Kind::Direction(count),
            Value::String(text),
        ) => {
            let inner = text.trim().trim_matches(['(', ')', '[', ']', '<', '>', '{', '}']);
            listed(inner, key, *count)
        }
        (
            Kind::Numbers(count, _) | Kind::TimedNumbers(count, _) | Kind::Direction(count),
            Value::Array(items),
        ) => {
            if items.len() + 1 == *count && *count == 3 {
                return Some(format!("{}, 0]", raw.strip_suffix(']')?.trim_end().trim_end_matches(',')));
            }
            listed(raw.strip_prefix('[')?.strip_suffix(']')?, key, *count)
        }
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
        (Kind::List { of, .. }, value)
            if of.takes(value) && !matches!(value, Value::Array(_) | Value::Table(_)) =>
        {
            Some(format!("[{raw}]"))
        }
        _ => None,
    }
}

/// A vector for a number that somebody has given in its place: along the axis that is most likely meant.
fn along_an_axis(raw: &str, number: f64, key: &str) -> String {
    match key {
        "gravity" if number > 0.0 => format!("[0, -{raw}, 0]"),
        "gravity" | "angular_velocity" | "torque" => format!("[0, {raw}, 0]"),
        "size" => format!("[{raw}, {raw}, {raw}]"),
        "orientation" | "euler" => format!("[0, 0, {raw}]"),
        _ => format!("[{raw}, 0, 0]"),
    }
}

/// So many numbers of a text, whatever stands between them.
fn listed(inner: &str, key: &str, count: usize) -> Option<String> {
    let (text, _) = habits::list(inner, key)?;
    let numbers =
        text.trim_matches(['[', ']']).split(", ").filter(|item| item.parse::<f64>().is_ok()).count();
    (numbers == count && habits::items(&text) == count).then_some(text)
}

/// A whole table of a kind as a line: `shape.sphere.radius = 0.5`.
fn example(way: &[&str], spec: &TableSpec) -> Option<String> {
    let required: Vec<&Key> = spec.keys.iter().filter(|key| key.required).collect();
    let values = required.iter().map(|key| Some((key.name, example_of(key)?))).collect::<Option<Vec<_>>>()?;
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

/// A value of a key to begin with.
fn example_of(key: &Key) -> Option<&'static str> {
    Some(match (&key.kind, key.name) {
        (Kind::Number(_), "radius") => "0.5",
        (Kind::Number(_), "tube_radius") => "0.1",
        (Kind::Number(_), "stiffness") => "10",
        (Kind::Number(_), _) => "1",
        (Kind::Numbers(3, _), "size") => "[1, 1, 1]",
        (Kind::TimedNumbers(3, _), "location") => "[3, 5, 4]",
        (Kind::Direction(3), "direction") => "[-1, -2, -1]",
        (Kind::Text, _) => "\"t = ${t:.2} s\"",
        _ => return None,
    })
}

/// Where a line belongs that is to stand in a table which is named at a place, and the text that does it.
fn insertion(at: Span, line: &str, context: &Context<'_>) -> Option<(Span, String)> {
    let text = &context.sources.get(at.source).text;
    let insert = |place: usize, text: String| Some((Span { start: place, end: place, ..at }, text));
    if let Some(end) = header_end(at, context) {
        return text[at.end..end]
            .trim_start_matches('"')
            .starts_with(']')
            .then(|| insert(end, format!("\n{line}")))?;
    }
    let start = text[..at.start].rfind('\n').map_or(0, |newline| newline + 1);
    let rest = &text[at.end..];
    if rest.starts_with('.') && !text[start..at.end].contains(['{', '[', '=']) {
        let end = rest.find('\n').map_or(text.len(), |newline| at.end + newline);
        return insert(end, format!("\n{}.{line}", &text[start..at.end]));
    }
    let brace = rest.trim_start().strip_prefix('=')?.trim_start().strip_prefix('{')?;
    let comma = if brace.trim_start().starts_with('}') { " " } else { "," };
    insert(text.len() - brace.len(), format!(" {line}{comma}"))
}

/// The end of the line, if the name at a place stands in the header of a table.
fn header_end(at: Span, context: &Context<'_>) -> Option<usize> {
    let text = &context.sources.get(at.source).text;
    let start = text[..at.start].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[at.end..].find('\n').map_or(text.len(), |newline| at.end + newline);
    text[start..end].trim_start().starts_with('[').then_some(end)
}

/// The line of an entry with its end, if nothing else stands there.
fn whole_line(entry: Span, context: &Context<'_>) -> Option<Span> {
    let text = &context.sources.get(entry.source).text;
    let start = text[..entry.start].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[entry.end..].find('\n').map_or(text.len(), |newline| entry.end + newline + 1);
    let after = text[entry.end..end].trim();
    let is_key = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.' | '"' | ' ' | '\t');
    let alone = text[start..entry.start].chars().all(is_key) && (after.is_empty() || after.starts_with('#'));
    alone.then_some(Span { start, end, ..entry })
}

fn raw<'a>(span: Span, context: &'a Context<'_>) -> &'a str {
    context.sources.get(span.source).text.get(span.start..span.end).unwrap_or_default()
}
