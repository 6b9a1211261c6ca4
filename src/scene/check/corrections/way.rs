//! Guesses which key of a table, or of its inner tables, an unknown key was meant to be.

use super::super::{Context, suggest};
use super::key_of;
use super::kind::MeantKind;
use super::missing::insertion;
use super::text::{raw, removal, whole};
use crate::diagnostic::Span;
use crate::scene::grammar::{KeySpec, Rule, SCENE, TableSpec};
use crate::scene::source::{Entry, Table};

/// Returns the path of keys from a table to the key that the unknown key `entry` was probably meant to be. `None` if no key is similar.
pub(super) fn way(
    entry: &Entry,
    meant: Option<&MeantKind>,
    table: &Table,
    spec: &'static TableSpec,
) -> Option<Vec<&'static str>> {
    let word = &*entry.name.text;
    // An entry whose value is a table can only become a key that takes a table.
    let takes = |way: &Vec<&'static str>| {
        let is_table = entry.node.as_table().is_some();
        let can = |key: &KeySpec| key.kind.table().is_some() || key.kind.takes(&entry.node.value);
        !is_table || key_at(way, spec).is_some_and(can)
    };
    let of_kind = meant.and_then(|meant| meant.path_to(word)).filter(takes);
    if of_kind.is_some() {
        return of_kind;
    }
    // A key of the simulation, such as `duration`, belongs to `[simulation]`, although the `trail` of a body also has this key.
    if spec.key("shape").is_some() && key_of(word, spec).is_none() && of_simulation(word).is_some() {
        return None;
    }
    let fits = |way: &Vec<&'static str>| takes(way) && !is_excluded(way, meant, table, spec);
    // If the table's own key does not take the value, try an inner key of the same name.
    let own = || {
        let own = key_of(word, spec)?;
        let inner = own.kind.table().filter(|_| !own.kind.takes(&entry.node.value));
        let inner = inner.and_then(|inner| inner.key(word)).map(|inner| vec![own.name, inner.name]);
        Some(inner.unwrap_or_else(|| vec![own.name]))
    };
    let deeper = || {
        spec.keys().find_map(|key| {
            let inner = key.kind.table()?;
            let rest = match inner.key(word) {
                Some(found) => vec![found.name],
                None => suggest::deeper(word, inner)?,
            };
            Some(std::iter::once(key.name).chain(rest).collect()).filter(fits)
        })
    };
    own()
        .or_else(deeper)
        .or_else(|| suggest::key(word, spec).map(|near| vec![near]))
        .or_else(|| suggest::deeper_also(word, spec).filter(fits))
}

/// Returns whether a path leads to a kind, such as `shape.box`, although the table already has or means another kind, such as
/// `shape.sphere`.
fn is_excluded(
    way: &[&'static str],
    meant: Option<&MeantKind>,
    table: &Table,
    spec: &'static TableSpec,
) -> bool {
    let is_other = |meant: &MeantKind| match meant.way.split_last() {
        Some((kind, before)) if !before.is_empty() => {
            way.starts_with(before) && way.get(before.len()) != Some(kind)
        }
        _ => false,
    };
    let [first, second, ..] = way else { return false };
    let kinds = spec.key(first).and_then(|key| key.kind.table());
    let present = table.get(first).and_then(|entry| entry.node.as_table());
    let is_there = |names: &[&str], present: &Table| {
        present.entries.iter().any(|entry| &&*entry.name.text != second && names.contains(&&*entry.name.text))
    };
    let is_full = match (kinds.map(|kinds| &kinds.rule), present) {
        (Some(Rule::ExactlyOne(names)), Some(present)) => is_there(names, present),
        _ => false,
    };
    is_full || meant.is_some_and(is_other)
}

/// Returns the key at the end of a path of keys.
pub(super) fn key_at(way: &[&str], spec: &'static TableSpec) -> Option<&'static KeySpec> {
    let (first, rest) = way.split_first()?;
    let key = spec.key(first)?;
    if rest.is_empty() { Some(key) } else { key_at(rest, key.kind.table()?) }
}

/// Finds the table, such as `[simulation]`, to which an unknown key belongs. Returns the path of the key in that table, and the edits that
/// move the entry.
pub(super) fn key_in_other_table(
    entry: &Entry,
    context: &Context<'_>,
) -> Option<(String, Vec<(Span, String)>)> {
    let word = &*entry.name.text;
    let way = of_simulation(word).map(|key| vec!["simulation", key.name]);
    let way = way.or_else(|| suggest::deeper(word, &SCENE))?;
    let [table @ ("simulation" | "camera" | "environment" | "output"), key] = way.as_slice() else {
        return None;
    };
    let is_number = entry.node.as_number().is_some();
    key_at(&way, &SCENE).filter(|key| is_number || key.kind.takes(&entry.node.value))?;
    let path = way.join(".");
    let line = whole(entry).and_then(|it| removal(it, context));
    let value = raw(entry.node.span, context);
    let place = match context.tables.get(*table) {
        Some(at) if at.source() == entry.name.span.source() => {
            insertion(*at, &format!("{key} = {value}"), context)
        }
        Some(_) => None,
        None => Some((entry.name.span.top_of_text(), format!("{path} = {value}\n"))),
    };
    let fix = line.zip(place).map_or(Vec::new(), |(line, place)| vec![(line, String::new()), place]);
    Some((path, fix))
}

/// Returns the key of `[simulation]` with this name. `None` for ambiguous names from other programs, such as `length` and `rate`.
fn of_simulation(word: &str) -> Option<&'static KeySpec> {
    /// The names from other programs that mean only a key of `[simulation]`.
    const UNAMBIGUOUS_KEYS: [&str; 5] = ["fps", "dt", "timestep", "time_step", "solver"];
    let key = key_of(word, SCENE.key("simulation")?.kind.table()?)?;
    (key.name == word || UNAMBIGUOUS_KEYS.contains(&word)).then_some(key)
}
