//! Reports unknown keys of a table, with suggestions.

use super::super::Context;
use super::kind::MeantKind;
use super::nameless::view;
use super::text::{header_end, raw, removal, whole, whole_line};
use super::way::{key_in_other_table, way};
use super::{joint, not_built};
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::grammar::{Rule, TableSpec, quoted};
use crate::scene::source::{Entry, Node, Table, Value};
use crate::scene::units;

/// Returns the error for an unknown key, with a fix if the correction is clear. Also returns the key that was probably meant. It is `None`
/// if the table has no such key.
pub(in crate::scene::check) fn unknown(
    entry: &Entry,
    meant: Option<&MeantKind>,
    table: &Table,
    spec: &'static TableSpec,
    path: &str,
    context: &Context<'_>,
) -> (Diagnostic, Option<&'static str>) {
    let word = &*entry.name.text;
    let error = Diagnostic::error(Code::UnknownKey, format!("unknown key `{word}` in {path}"));
    if let Some((label, fix)) = joint::other_section(entry, table, spec, path, context) {
        let error = error.at(entry.name.span, label);
        return (fix.into_iter().fold(error, |error, (span, text)| error.fix(span, text)), None);
    }
    if let Some(thing) = not_built(word, spec) {
        let label = if thing.comes_with.is_empty() {
            format!("not a key of {}", spec.noun)
        } else {
            "not built yet".to_owned()
        };
        let error = error.at(entry.name.span, label).help(thing.help);
        let line = whole(entry).and_then(|it| removal(it, context)).filter(|_| thing.is_removable);
        return (line.into_iter().fold(error, |error, line| error.fix(line, "")), None);
    }
    if let Some(edits) = view(entry, spec, context) {
        let error = error.at(entry.name.span, "cameras with names are views");
        return (edits.into_iter().fold(error, |error, (span, text)| error.fix(span, text)), None);
    }
    let Some(way) = way(entry, meant, table, spec) else {
        let error = match key_in_other_table(entry, context) {
            Some((way, fix)) if path.starts_with('[') => {
                let error = error.at(entry.name.span, format!("did you mean `{way}`?"));
                fix.into_iter().fold(error, |error, (span, text)| error.fix(span, text))
            }
            _ => error.at(entry.name.span, format!("not a key of {}", spec.noun)).help(known_keys(spec)),
        };
        return (error, None);
    };
    let error = error.at(entry.name.span, format!("did you mean `{}`?", way.join(".")));
    let error = match way.as_slice() {
        ["collides"] if spec.noun == "a body" => {
            error.help("bodies collide anyway if [simulation] has `contacts = \"event-driven\"`")
        }
        ["video_rate"] => error.help("the scene itself has `simulation.frame_rate` frames per second"),
        _ => error,
    };
    let error = corrected(error, entry, &way, table, context);
    let error = rescaled(error, entry);
    (beside(error, meant, &way, table, spec), Some(way[0]))
}

/// Returns a sentence that lists the keys of a table.
pub(in crate::scene::check) fn known_keys(spec: &TableSpec) -> String {
    let names: Vec<&str> = spec.keys().map(|key| key.name).collect();
    let s = if names.len() == 1 { "" } else { "s" };
    format!("the key{s} of {}: {}", spec.noun, quoted(&names))
}

/// Adds a fix that replaces the unknown key by the path `way`, or that moves its line into the table to which the key belongs.
fn corrected(
    error: Diagnostic,
    entry: &Entry,
    way: &[&'static str],
    table: &Table,
    context: &Context<'_>,
) -> Diagnostic {
    match table.get(way[0]) {
        None => error.fix(entry.name.span, way.join(".")).fix_is_said(),
        Some(_) if way.len() == 1 && header_end(entry.name.span, context).is_none() => error,
        Some(_) if way.len() == 1 => error.fix(entry.name.span, way[0]).fix_is_said(),
        Some(first) => {
            let line = whole(entry).and_then(|it| whole_line(it, context));
            match (&first.node.value, header_end(first.name.span, context), line) {
                // The table `first` has its own header: insert the key below that header.
                (Value::Table(_), Some(end), Some(line)) => {
                    let text = format!("\n{} = {}", way[1..].join("."), raw(entry.node.span, context));
                    error.fix(line, "").fix(end, text)
                }
                // This fix only replaces the key. `correct_word` handles the word that names the shape.
                (Value::String(_), ..) if way[0] == "shape" => {
                    error.fix(entry.name.span, way.join(".")).fix_is_said()
                }
                (Value::Table(_), None, _) => error.fix(entry.name.span, way.join(".")).fix_is_said(),
                // The scene names a library material and a color: give the material this color.
                (Value::String(like), _, Some(line)) if way == ["material", "color"] => {
                    let text = format!("{{ like = \"{like}\", color = {} }}", raw(entry.node.span, context));
                    error.fix(line, "").fix(first.node.span, text)
                }
                _ => error,
            }
        }
    }
}

/// Extends the fix by a conversion of the value, if the unknown key means another measure of the same quantity. For example, a diameter is
/// multiplied by 0.5 to give the radius.
fn rescaled(error: Diagnostic, entry: &Entry) -> Diagnostic {
    let factor = match &*entry.name.text {
        "diameter" => "0.5",
        "half_extents" | "half_size" => "2",
        _ => return error,
    };
    let is_one = error.fix.as_ref().is_some_and(|fix| fix.edits.len() == 1);
    let times = |node: &Node| {
        let formula = node.as_str().map(str::to_owned).filter(|text| units::quantity(text).is_none());
        match node.as_number() {
            Some(number) => Some(units::written(number * factor.parse::<f64>().ok()?)),
            None => Some(format!("\"{factor}*({})\"", formula?)),
        }
    };
    let value = match &entry.node.value {
        Value::Array(items) => {
            items.iter().map(times).collect::<Option<Vec<_>>>().map(|items| format!("[{}]", items.join(", ")))
        }
        _ => times(&entry.node),
    };
    match value.filter(|_| is_one) {
        Some(value) => {
            let mut error = error.fix(entry.node.span, value);
            error.fix.iter_mut().for_each(|fix| fix.is_said = false);
            error
        }
        None => Diagnostic { fix: None, ..error },
    }
}

/// Adds to the fix edits of further keys that the user probably meant for the same kind, such as the `count` of a ring. No error reports
/// these keys, because they are also valid in the table itself.
fn beside(
    error: Diagnostic,
    meant: Option<&MeantKind>,
    way: &[&'static str],
    table: &Table,
    spec: &TableSpec,
) -> Diagnostic {
    let (Some(meant), Rule::ExactlyOne(names), [kind, _]) = (meant, &spec.rule, way) else { return error };
    let is_beside = |entry: &&Entry| {
        let name = &*entry.name.text;
        name != *kind && names.contains(&name) && meant.spec.key(name).is_some()
    };
    table.entries.iter().filter(is_beside).fold(error, |error, entry| {
        let mut error = error.fix(entry.name.span, format!("{kind}.{}", entry.name.text));
        error.fix.iter_mut().for_each(|fix| fix.is_said = false);
        error
    })
}
