//! The path from a table to the key that an unknown one was meant to be.

use super::super::{Context, suggest};
use super::key_of;
use super::kind::MeantKind;
use super::missing::insertion;
use super::text::{raw, removal, whole};
use crate::diagnostic::Span;
use crate::scene::grammar::{Key, Rule, SCENE, TableSpec};
use crate::scene::source::{Entry, Table};

/// The way from a table to the key that was meant.
pub(super) fn way(
    entry: &Entry,
    meant: Option<&MeantKind>,
    table: &Table,
    spec: &'static TableSpec,
) -> Option<Vec<&'static str>> {
    let word = &*entry.name.text;
    // A table never belongs where none can stand.
    let takes = |way: &Vec<&'static str>| {
        let is_table = entry.node.as_table().is_some();
        let can = |key: &Key| key.kind.table().is_some() || key.kind.takes(&entry.node.value);
        !is_table || key_at(way, spec).is_some_and(can)
    };
    let of_kind = meant.and_then(|meant| meant.way_to(word)).filter(takes);
    if of_kind.is_some() {
        return of_kind;
    }
    // The keys of the simulation belong there, though a body's trail has a duration, too.
    if spec.key("shape").is_some() && key_of(word, spec).is_none() && of_simulation(word).is_some() {
        return None;
    }
    let fits = |way: &Vec<&'static str>| takes(way) && !is_excluded(way, meant, table, spec);
    // A table that does not take the value may hold a key of this very name that does.
    let own = || {
        let own = key_of(word, spec)?;
        let inner = own.kind.table().filter(|_| !own.kind.takes(&entry.node.value));
        let inner = inner.and_then(|inner| inner.key(word)).map(|inner| vec![own.name, inner.name]);
        Some(inner.unwrap_or_else(|| vec![own.name]))
    };
    let deeper = || {
        spec.keys.iter().find_map(|key| {
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

/// Whether a path leads to another kind than the present or intended one: the two exclude each other.
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

/// The key that a way leads to.
pub(super) fn key_at(way: &[&str], spec: &'static TableSpec) -> Option<&'static Key> {
    let (first, rest) = way.split_first()?;
    let key = spec.key(first)?;
    if rest.is_empty() { Some(key) } else { key_at(rest, key.kind.table()?) }
}

/// A key that stands in a table which has no such key, and where it belongs: its path, and the pieces of text that move it.
pub(super) fn elsewhere(entry: &Entry, context: &Context<'_>) -> Option<(String, Vec<(Span, String)>)> {
    let word = &*entry.name.text;
    let way = of_simulation(word).map(|key| vec!["simulation", key.name]);
    let way = way.or_else(|| suggest::deeper(word, &SCENE))?;
    let [table @ ("simulation" | "camera" | "environment" | "output"), key] = way.as_slice() else {
        return None;
    };
    let is_number = entry.node.as_number().is_some();
    key_at(&way, &SCENE).filter(|key| is_number || key.kind.takes(&entry.node.value))?;
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
