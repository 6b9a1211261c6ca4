//! A tree held against the description of the language: everything that can be said without knowing what a
//! scene is about.

use super::{Context, read, sdl, suggest};
use crate::diagnostic::{Diagnostic, Span};
use crate::scene::grammar::{Collection, Key, Kind, Rule, SCENE, TableSpec, quoted};
use crate::scene::source::{Entry, Node, Table, Value};

/// Reports every key and value of a scene that the language does not know.
pub(super) fn validate(root: &Table, context: &mut Context<'_>) {
    table(root, &SCENE, None, "the scene", context);
}

/// Validates a table; `at` is where it is named, `path` how messages call it.
fn table(table: &Table, spec: &'static TableSpec, at: Option<Span>, path: &str, context: &mut Context<'_>) {
    for entry in &table.entries {
        match spec.key(&entry.name.text) {
            Some(key) => value(&entry.node, &key.kind, Some(entry), path, context),
            None => context.diagnostics.push(unknown_key(entry, spec, path)),
        }
    }
    for key in spec.keys.iter().filter(|key| key.required && table.get(key.name).is_none()) {
        context.diagnostics.push(missing_key(key, at, path));
    }
    rule(table, spec, at, path, context);
}

fn unknown_key(entry: &Entry, spec: &TableSpec, path: &str) -> Diagnostic {
    let name = &entry.name.text;
    let message = format!("unknown key `{name}` in {path}");
    let names: Vec<&str> = spec.keys.iter().map(|key| key.name).collect();
    match suggest::key(name, spec) {
        Some(near) => {
            Diagnostic::error("unknown-key", message).at(entry.name.span, format!("did you mean `{near}`?"))
        }
        None => Diagnostic::error("unknown-key", message)
            .at(entry.name.span, format!("not a key of {}", spec.noun))
            .help(format!("{} knows {}", spec.noun, quoted(&names))),
    }
}

fn missing_key(key: &Key, at: Option<Span>, path: &str) -> Diagnostic {
    let message = format!("`{}` is missing in {path}", key.name);
    let error = Diagnostic::error("missing-key", message);
    let error = match at {
        Some(span) => error.at(span, format!("needs `{}`", key.name)),
        None => error,
    };
    let unit = if key.unit.is_empty() { String::new() } else { format!(", in {}", key.unit) };
    error.help(format!("`{}` is {}{unit}: {}", key.name, key.kind.in_words(), lower_first(key.meaning)))
}

fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| first.to_lowercase().chain(chars).collect())
}

fn rule(table: &Table, spec: &TableSpec, at: Option<Span>, path: &str, context: &mut Context<'_>) {
    let present = |names: &[&str]| {
        table.entries.iter().filter(|e| names.contains(&e.name.text.as_str())).collect::<Vec<_>>()
    };
    match &spec.rule {
        Rule::Any => {}
        Rule::AtMostOne(groups) => {
            let mut said = Vec::new();
            for entries in groups.iter().map(|names| present(names)).filter(|entries| entries.len() > 1) {
                let pair = (entries[0].name.span, entries[1].name.span);
                if !said.contains(&pair) {
                    said.push(pair);
                    context.diagnostics.push(exclusive(&entries, path));
                }
            }
        }
        Rule::ExactlyOne(names) => match present(names).as_slice() {
            [_] => {}
            [] => {
                let message = format!("{} needs one of {}", spec.noun, quoted(names));
                let error = Diagnostic::error("missing-key", message);
                context.diagnostics.push(match at {
                    Some(span) => error.at(span, format!("{path} says none of them")),
                    None => error,
                });
            }
            entries => context.diagnostics.push(exclusive(entries, path)),
        },
    }
}

fn exclusive(entries: &[&Entry], path: &str) -> Diagnostic {
    let names: Vec<&str> = entries.iter().map(|entry| entry.name.text.as_str()).collect();
    let message = format!("{} exclude each other in {path}", quoted(&names));
    let error = Diagnostic::error("exclusive-keys", message);
    // The first is right as far as anyone can tell; the later ones are too many.
    let (first, rest) = (entries[0], &entries[1..]);
    let error =
        rest.iter().fold(error, |error, entry| error.at(entry.name.span, "only one of them can hold"));
    error.at(first.name.span, "the other is here")
}

fn value(node: &Node, kind: &'static Kind, entry: Option<&Entry>, path: &str, context: &mut Context<'_>) {
    if matches!(node.value, Value::Invalid) {
        return;
    }
    match kind {
        Kind::Text if node.as_str().is_none() => context.diagnostics.push(read::wrong_type(node, kind)),
        Kind::Boolean if !matches!(node.value, Value::Boolean(_)) => {
            context.diagnostics.push(read::wrong_type(node, kind));
        }
        Kind::Text | Kind::Boolean => {}
        Kind::Number(bound) => keep(read::number(node, *bound), context),
        Kind::Integer(low, high) => keep(read::integer(node, *low, *high), context),
        Kind::Numbers(4, bound) => keep_all(read::numbers::<4>(node, *bound), context),
        Kind::Numbers(_, bound) => keep_all(read::numbers::<3>(node, *bound), context),
        Kind::Direction(4) => keep_all(read::direction::<4>(node), context),
        Kind::Direction(_) => keep_all(read::direction::<3>(node), context),
        Kind::Color => keep_all(read::color(node), context),
        Kind::Identifier => keep(read::identifier(node), context),
        Kind::Sdl => keep(sdl::read(node, context.trust), context),
        Kind::Include => match node.as_str() {
            None => context.diagnostics.push(read::wrong_type(node, kind)),
            Some(_) => keep(super::povray::include(node, context.folder, context.trust), context),
        },
        Kind::Choice(words) => choice(node, kind, &words(), entry, context),
        Kind::Reference(collection) => reference(node, kind, *collection, context),
        Kind::List { of, .. } => match read::list(node, kind) {
            Ok(items) => items.iter().for_each(|item| value(item, of, None, path, context)),
            Err(error) => context.diagnostics.push(error),
        },
        Kind::Table(spec) => match node.as_table() {
            Some(inner) => table(inner, spec, at(node, entry), &inner_path(entry, path), context),
            None => context.diagnostics.push(read::wrong_type(node, kind)),
        },
        Kind::Named(spec) => named(node, kind, spec, entry, context),
        Kind::Either(kinds) => match kinds.iter().find(|kind| fits(node, kind)) {
            Some(kind) => value(node, kind, entry, path, context),
            None => context.diagnostics.push(read::wrong_type(node, kind)),
        },
    }
}

/// Where a table is named: by its key if it has one.
fn at(node: &Node, entry: Option<&Entry>) -> Option<Span> {
    Some(entry.map_or(node.span, |entry| entry.name.span))
}

/// `[body.ball]` → `shape` of [body.ball] → `sphere` of [body.ball].
fn inner_path(entry: Option<&Entry>, path: &str) -> String {
    let Some(entry) = entry else { return path.to_owned() };
    if path == "the scene" {
        return format!("[{}]", entry.name.text);
    }
    let table = path.rsplit_once(" of ").map_or(path, |(_, table)| table);
    format!("`{}` of {table}", entry.name.text)
}

fn named(
    node: &Node,
    kind: &Kind,
    spec: &'static TableSpec,
    entry: Option<&Entry>,
    context: &mut Context<'_>,
) {
    let word = entry.map_or("", |entry| entry.name.text.as_str());
    let Some(tables) = node.as_table() else {
        context.diagnostics.push(read::wrong_type(node, kind));
        return;
    };
    for entry in &tables.entries {
        let path = format!("[{word}.{}]", entry.name.text);
        match entry.node.as_table() {
            Some(inner) => table(inner, spec, Some(entry.name.span), &path, context),
            None if matches!(entry.node.value, Value::Invalid) => {}
            None => {
                let name = &entry.name.text;
                let message = format!("`{name}` stands in [{word}], where only tables with names do");
                let help = format!("name {} with `[{word}.NAME]`, and write `{name}` below it", spec.noun);
                context
                    .diagnostics
                    .push(Diagnostic::error("unnamed-table", message).at(entry.name.span, "").help(help));
            }
        }
    }
}

fn choice(node: &Node, kind: &Kind, words: &[&str], entry: Option<&Entry>, context: &mut Context<'_>) {
    match node.as_str() {
        None => context.diagnostics.push(read::wrong_type(node, kind)),
        Some(word) if words.contains(&word) => {}
        Some(word) => {
            let noun = entry.map_or("word", |entry| entry.name.text.as_str());
            let label = suggest::label(word, words.iter().copied(), noun);
            let message = format!("unknown {noun} `{word}`");
            let error = Diagnostic::error("unknown-name", message).at(node.span, label);
            context.diagnostics.push(error.help(format!("there are {}", quoted(words))));
        }
    }
}

fn reference(node: &Node, kind: &Kind, collection: Collection, context: &mut Context<'_>) {
    let Some(word) = node.as_str() else {
        context.diagnostics.push(read::wrong_type(node, kind));
        return;
    };
    let names = context.names.get(collection);
    if names.contains_key(word) {
        return;
    }
    let noun = collection.key();
    let mut known: Vec<&str> = names.keys().map(String::as_str).collect();
    known.sort_unstable_by_key(|name| names[*name]);
    let label = suggest::label(word, known.into_iter(), noun);
    let message = format!("there is no {noun} `{word}`");
    context.diagnostics.push(Diagnostic::error("unknown-name", message).at(node.span, label));
}

/// Whether a value is of the TOML type that a kind is written in.
fn fits(node: &Node, kind: &Kind) -> bool {
    match kind {
        Kind::Text | Kind::Sdl | Kind::Identifier | Kind::Include | Kind::Choice(_) | Kind::Reference(_) => {
            matches!(node.value, Value::String(_))
        }
        Kind::Boolean => matches!(node.value, Value::Boolean(_)),
        Kind::Number(_) => matches!(node.value, Value::Integer(_) | Value::Float(_) | Value::String(_)),
        Kind::Integer(..) => matches!(node.value, Value::Integer(_)),
        Kind::Numbers(..) | Kind::Direction(_) | Kind::List { .. } => matches!(node.value, Value::Array(_)),
        Kind::Color => matches!(node.value, Value::Array(_) | Value::String(_)),
        Kind::Table(_) | Kind::Named(_) => matches!(node.value, Value::Table(_)),
        Kind::Either(kinds) => kinds.iter().any(|kind| fits(node, kind)),
    }
}

fn keep<T>(result: Result<T, Diagnostic>, context: &mut Context<'_>) {
    context.diagnostics.extend(result.err());
}

fn keep_all<T>(result: Result<T, Vec<Diagnostic>>, context: &mut Context<'_>) {
    context.diagnostics.extend(result.err().into_iter().flatten());
}
