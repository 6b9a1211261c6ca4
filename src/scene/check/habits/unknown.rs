//! Keys that a table does not know.

use super::super::{Context, suggest};
use super::kind::MeantKind;
use super::missing::insertion;
use super::nameless::key_at;
use super::text::{header_end, raw, removal, whole, whole_line};
use super::{key_of, not_built};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::{Key, Rule, SCENE, TableSpec, quoted};
use crate::scene::source::{Entry, Table, Value};

/// What is said of an unknown key, with the text that belongs in its place if that can be told; and the key of the table
/// that was meant.
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
    if let Some(thing) = not_built(word, spec) {
        let error = error.at(entry.name.span, "not built yet").help(thing.help);
        let line = removal(whole(entry), context).filter(|_| thing.can_go);
        return (line.into_iter().fold(error, |error, line| error.fix(line, "")), None);
    }
    let Some(way) = way(word, meant, spec) else {
        let error = match elsewhere(entry, context) {
            Some((way, fix)) if path.starts_with('[') => {
                let error = error.at(entry.name.span, format!("did you mean `{way}`?"));
                fix.into_iter().fold(error, |error, (span, text)| error.fix(span, text))
            }
            _ => error.at(entry.name.span, format!("not a key of {}", spec.noun)).help(known_keys(spec)),
        };
        return (error, None);
    };
    let error = error.at(entry.name.span, format!("did you mean `{}`?", way.join(".")));
    let error = mended(error, entry, &way, table, context);
    (beside(error, meant, &way, table, spec), Some(way[0]))
}

/// The keys of a table, in words.
pub(in crate::scene::check) fn known_keys(spec: &TableSpec) -> String {
    let names: Vec<&str> = spec.keys.iter().map(|key| key.name).collect();
    let s = if names.len() == 1 { "" } else { "s" };
    format!("the key{s} of {}: {}", spec.noun, quoted(&names))
}

/// The way from a table to the key that was meant.
fn way(word: &str, meant: Option<&MeantKind>, spec: &'static TableSpec) -> Option<Vec<&'static str>> {
    if let Some(way) = meant.and_then(|meant| meant.way_to(word)) {
        return Some(way);
    }
    // Of another kind than the one that was meant, it would be wrong beside the others.
    let fits = |way: &Vec<&'static str>| match meant {
        Some(MeantKind { way: kind, .. }) => !way.starts_with(&kind[..kind.len() - 1]) || kind.len() == 1,
        None => true,
    };
    // The keys of the simulation belong there, though a body's trail has a duration, too.
    if spec.key("shape").is_some() && key_of(word, spec).is_none() && of_simulation(word).is_some() {
        return None;
    }
    let own = || key_of(word, spec).map(|key| vec![key.name]);
    own()
        .or_else(|| suggest::deeper(word, spec).filter(fits))
        .or_else(|| suggest::key(word, spec).map(|near| vec![near]))
        .or_else(|| suggest::deeper_also(word, spec).filter(fits))
}

/// The text that belongs in the place of a key, or of its line.
fn mended(
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
            let line = whole_line(whole(entry), context);
            match (&first.node.value, header_end(first.name.span, context), line) {
                // The table has a header of its own, below which the key belongs.
                (Value::Table(_), Some(end), Some(line)) => {
                    let text = format!("\n{} = {}", way[1..].join("."), raw(entry.node.span, context));
                    error.fix(line, "").fix(Span { start: end, end, ..line }, text)
                }
                // The word that names the kind goes: see `mend_word`.
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

/// Beside a key of a kind, a key of the table that is a kind by itself belongs to that kind as well: the `count` of a ring.
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

/// A key that stands in a table which has no such key, and where it belongs: its path, and the pieces of text that move it.
fn elsewhere(entry: &Entry, context: &Context<'_>) -> Option<(String, Vec<(Span, String)>)> {
    let word = &*entry.name.text;
    let way = of_simulation(word).map(|key| vec!["simulation", key.name]);
    let way = way.or_else(|| suggest::deeper(word, &SCENE))?;
    let [table @ ("simulation" | "camera" | "environment" | "output"), key] = way.as_slice() else {
        return None;
    };
    key_at(&way, &SCENE).filter(|key| key.kind.takes(&entry.node.value))?;
    let path = way.join(".");
    let line = removal(whole(entry), context);
    let value = raw(entry.node.span, context);
    let place = match context.tables.get(*table) {
        Some(at) if at.source == entry.name.span.source => {
            insertion(*at, &format!("{key} = {value}"), context)
        }
        Some(_) => None,
        None => Some((Span { start: 0, end: 0, ..entry.name.span }, format!("{path} = {value}\n"))),
    };
    let fix = line.zip(place).map_or(Vec::new(), |(line, place)| vec![(line, String::new()), place]);
    Some((path, fix))
}

/// A key of the simulation that is unlikely to be one of anything else, as « length » and « rate » may be.
fn of_simulation(word: &str) -> Option<&'static Key> {
    const PLAIN: [&str; 5] = ["fps", "dt", "timestep", "time_step", "solver"];
    let key = key_of(word, SCENE.key("simulation")?.kind.table()?)?;
    (key.name == word || PLAIN.contains(&word)).then_some(key)
}
