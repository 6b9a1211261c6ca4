//! Corrects table headers that lack a name (`[body]`) or the collection's key (`[ball]` instead of `[body.ball]`).

use super::super::validate::as_key;
use super::super::{Context, suggest};
use super::key_of;
use super::kind::is_begun;
use super::text::{header_end, raw, removal, whole};
use super::way::key_at;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::{KeySpec, Kind, Rule, SCENE, TableSpec};
use crate::scene::source::{Entry, Node, Table, Value};

/// Returns the error for a table without the key of its collection (`[ball]` instead of `[body.ball]`), or for a key of a body outside of
/// any body. Also returns the top-level key that was meant.
pub(in crate::scene::check) fn nameless(
    entry: &Entry,
    context: &Context<'_>,
) -> Option<(Diagnostic, &'static str)> {
    let word = &*entry.name.text;
    if let Some(error) = of_known_bodies(entry, context) {
        return Some((error, "body"));
    }
    let fits =
        |way: Vec<&'static str>| key_at(&way, &SCENE).is_some_and(|key| key.kind.takes(&entry.node.value));
    if suggest::key(word, &SCENE).is_some()
        || suggest::deeper(word, &SCENE).is_some_and(fits)
        || suggest::deeper_also(word, &SCENE).is_some()
    {
        return None;
    }
    let (kind, edits) = of_a_kind(entry, context).or_else(|| of_bodies(entry, context)).or_else(|| {
        best(entry.node.as_table()?).map(|kind| (kind, vec![(entry.name.span, format!("{kind}.{word}"))]))
    })?;
    let error = Diagnostic::error(Code::UnknownKey, format!("unknown key `{word}` in the scene"));
    let is_said = edits.len() == 1;
    let error = match edits.as_slice() {
        [(_, text)] => error.at(entry.name.span, format!("did you mean `{text}`?")),
        _ => error.at(entry.name.span, format!("this is a kind of {kind}")),
    };
    let error = edits.into_iter().fold(error, |error, (span, text)| error.fix(span, text));
    Some((if is_said { error.fix_is_said() } else { error }, kind))
}

/// Returns the error for tables of bodies that stand below the key instead of the body: `[trail.ball]` instead of `[body.ball.trail]`.
fn of_known_bodies(entry: &Entry, context: &Context<'_>) -> Option<Diagnostic> {
    let word = &*entry.name.text;
    let table = entry.node.as_table().filter(|table| !table.entries.is_empty())?;
    let key =
        key_of(word, collection("body")?).or_else(|| key_of(&format!("{word}s"), collection("body")?))?;
    let is_body = |entry: &Entry| {
        context.names.bodies.contains_key(&entry.name.text) && key.kind.takes(&entry.node.value)
    };
    if !table.entries.iter().all(is_body) {
        return None;
    }
    let name = as_key(&table.entries[0].name.text);
    let error = Diagnostic::error(Code::UnknownKey, format!("unknown key `{word}` in the scene"))
        .at(entry.name.span, format!("did you mean `body.{name}.{}`?", key.name));
    let edits = renamed(entry, table, "body", Some(key.name), context);
    Some(edits.into_iter().fold(error, |error, (span, text)| error.fix(span, text)))
}

pub(super) type Edits = Vec<(Span, String)>;

/// Returns the top-level keys whose values are named tables, such as `body`, each with the grammar of these tables.
fn collections() -> impl DoubleEndedIterator<Item = (&'static str, &'static TableSpec)> {
    SCENE.keys().filter_map(|key| match key.kind {
        Kind::Named(inner) => Some((key.name, inner)),
        _ => None,
    })
}

fn collection(name: &str) -> Option<&'static TableSpec> {
    collections().find(|(key, _)| *key == name).map(|(_, spec)| spec)
}

/// Corrects a table whose header begins with a kind of force, joint or shape, such as `[drag]`, `[spring.left]` or `[sphere.ball]`.
fn of_a_kind(entry: &Entry, context: &Context<'_>) -> Option<(&'static str, Edits)> {
    let (word, table) = (&*entry.name.text, entry.node.as_table()?);
    let is_kind = |spec: &TableSpec| matches!(&spec.rule, Rule::ExactlyOne(kinds) if kinds.contains(&word));
    let things = collections().filter(|(_, spec)| is_kind(spec));
    for (name, spec) in things {
        let Some(inner) = spec.key(word).and_then(|key| key.kind.table()) else { continue };
        let is_one = |entry: &Entry| {
            let is_key = key_of(&entry.name.text, inner).is_some();
            !is_key && entry.node.as_table().is_some_and(|table| is_begun(inner, table))
        };
        if !table.entries.is_empty() && table.entries.iter().all(is_one) {
            return Some((name, renamed(entry, table, name, Some(word), context)));
        }
        if is_begun(inner, table) {
            return Some((name, vec![(entry.name.span, format!("{name}.{word}.{word}"))]));
        }
    }
    let inner = collection("body")?.key("shape")?.kind.table()?.key(word)?.kind.table()?;
    let is_one = |entry: &Entry| entry.node.as_table().is_some() && key_of(&entry.name.text, inner).is_none();
    let are_named = !table.entries.is_empty() && table.entries.iter().all(is_one);
    let edits = match are_named {
        true => renamed(entry, table, "body", None, context),
        false => vec![(entry.name.span, format!("body.{word}"))],
    };
    Some(("body", edits))
}

/// Corrects the header of a named camera: `[camera.top]` becomes `[view.top]`. The main camera has no name.
pub(super) fn view(entry: &Entry, spec: &TableSpec, context: &Context<'_>) -> Option<Edits> {
    let camera = SCENE.key("camera")?.kind.table()?;
    let table = entry.node.as_table().filter(|_| spec.noun == camera.noun)?;
    let is_camera = |entry: &Entry| key_of(&entry.name.text, camera).is_some();
    if !table.entries.iter().all(is_camera) {
        return None;
    }
    let span = entry.name.span;
    context.sources.before(span).ends_with("[camera.").then_some(())?;
    let place = span.grown("camera.".len(), 0);
    let is_main = matches!(&*entry.name.text, "main" | "default" | "primary");
    let text = if is_main { "camera".to_owned() } else { format!("view.{}", as_key(&entry.name.text)) };
    Some(vec![(place, text)])
}

/// Returns the edits that replace the first word in the headers of named tables by `first`, and that append `kind` to their names.
fn renamed(entry: &Entry, table: &Table, first: &str, kind: Option<&str>, context: &Context<'_>) -> Edits {
    let mut edits = Vec::new();
    for inner in &table.entries {
        let span = inner.name.span;
        let before = context.sources.before(span).strip_suffix('.').unwrap_or_default();
        if before.ends_with(&*entry.name.text) {
            let length = entry.name.text.len();
            edits.push((span.place_before(length + 1).grown(0, length), first.to_owned()));
        }
        edits.extend(kind.map(|kind| (span, format!("{}.{kind}", inner.name.text))));
    }
    edits
}

/// Corrects a key of a body outside of any body: moves the key to `[defaults.body]`, or to an example body if the scene has no bodies.
fn of_bodies(entry: &Entry, context: &Context<'_>) -> Option<(&'static str, Edits)> {
    let key = collection("body")?.key(&entry.name.text)?;
    let (kind, place) =
        if context.names.bodies.is_empty() { ("body", "body.ball") } else { ("defaults", "defaults.body") };
    Some((kind, vec![(entry.name.span, format!("{place}.{}", key.name))]))
}

/// Returns the collection, such as `body`, whose grammar has most of the keys in a table. If several fit equally well, returns the first.
fn best(table: &Table) -> Option<&'static str> {
    let worth = |inner: &'static TableSpec, entry: &Entry| match inner.key(&entry.name.text) {
        Some(_) => 2,
        None => usize::from(suggest::deeper(&entry.name.text, inner).is_some()),
    };
    let fitting = |inner| table.entries.iter().map(|entry| worth(inner, entry)).sum::<usize>();
    let (count, name) =
        collections().map(|(name, inner)| (fitting(inner), name)).rev().max_by_key(|(count, _)| *count)?;
    (count > 0).then_some(name)
}

/// Adds a fix to the error for a table that has the key of its collection but no name, such as `[body]` instead of `[body.ball]`.
pub(in crate::scene::check) fn correct_unnamed(
    error: Diagnostic,
    entry: &Entry,
    inner: &Entry,
    spec: &'static TableSpec,
    context: &Context<'_>,
) -> Diagnostic {
    let (word, key) = (&*entry.name.text, &*inner.name.text);
    let is_thing = |entry: &Entry| spec.key(&entry.name.text).is_some();
    if matches!(&spec.rule, Rule::ExactlyOne(names) if names.contains(&key))
        && inner.node.as_table().is_some()
    {
        return error.fix(inner.name.span, format!("{key}.{key}"));
    }
    let all = entry.node.as_table().is_some_and(|table| table.entries.iter().all(is_thing));
    if all && header_end(entry.name.span, context).is_some() {
        return error.fix(entry.name.span, format!("{word}.{}", name_of(word)));
    }
    // In `clock = "t = ${t}"` below `[label]`, the user gave the name `clock`, but not the key `text`.
    let required: Vec<&KeySpec> = spec.keys().filter(|key| key.required).collect();
    match required.as_slice() {
        [only] if spec.key(key).is_none() && only.kind.takes(&inner.node.value) => {
            error.fix(inner.name.span, format!("{key}.{}", only.name))
        }
        _ => error,
    }
}

/// Corrects an array of tables, `[[body]]`, to tables with names. The `name` in a table becomes the table's name. A table without a `name`
/// gets an example name, with a number if there are several tables.
pub(in crate::scene::check) fn correct_array(
    error: Diagnostic,
    node: &Node,
    word: &str,
    context: &Context<'_>,
) -> Diagnostic {
    let Value::Array(items) = &node.value else { return error };
    let mut edits = Vec::new();
    for (number, item) in items.iter().enumerate() {
        let (Some(table), "[[") = (item.as_table(), raw(item.span, context).get(..2).unwrap_or_default())
        else {
            return error;
        };
        let name = table.get("name").filter(|entry| entry.node.as_str().is_some());
        let text = match name.and_then(|entry| entry.node.as_str()) {
            Some(name) => as_key(name),
            None if items.len() == 1 => name_of(word).to_owned(),
            None => format!("{}{}", name_of(word), number + 1),
        };
        let header = raw(item.span, context).find("]]").map_or(item.span.len(), |end| end + 2);
        edits.push((item.span.part(0..header), format!("[{word}.{text}]")));
        edits.extend(name.and_then(|entry| Some((removal(whole(entry)?, context)?, String::new()))));
    }
    edits.into_iter().fold(error, |error, (span, text)| error.fix(span, text))
}

/// Returns an example name for a table of the collection `word`, such as `ball` for `body`.
fn name_of(word: &str) -> &'static str {
    match word {
        "body" => "ball",
        "force" => "push",
        "material" => "paint",
        "light" => "lamp",
        "label" => "clock",
        "view" => "side",
        _ => "first",
    }
}
