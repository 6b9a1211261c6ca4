//! Compares the tree of a scene with the grammar. Reports all errors that can be found without interpreting the scene.

use super::corrections::Owner;
use super::{Context, corrections, read, sdl, suggest};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::{Bound, Collection, KeySpec, Kind, Rule, SCENE, TableSpec, quoted};
use crate::scene::sdl::Where;
use crate::scene::source::{Entry, Node, Table, Value};
use crate::scene::{Include, MATERIALS};

/// Reports every unknown key, missing key and wrong value in a scene.
pub(super) fn validate(root: &Table, context: &mut Context<'_>) {
    table(root, &SCENE, None, "the scene", context);
}

/// Validates a table against its grammar `spec`. `at` is the source span that names the table, and `path` is the table's name in
/// diagnostics.
fn table(table: &Table, spec: &'static TableSpec, at: Option<Span>, path: &str, context: &mut Context<'_>) {
    if let Some(error) = corrections::gravity(table, spec, at, path, context) {
        context.diagnostics.push(error);
        return;
    }
    // The known keys that the unknown keys were meant to be. Do not report these known keys as missing.
    let mut meant = Vec::new();
    let before = context.diagnostics.len();
    let kind = corrections::meant_kind(table, spec, path);
    meant.extend(kind.iter().filter(|kind| kind.word.is_some()).map(|kind| kind.way[0]));
    let mut said = Vec::new();
    let has_unknown = table.entries.iter().any(|entry| spec.key(&entry.name.text).is_none());
    let found = if has_unknown {
        corrections::key_groups(table, spec, kind.as_ref(), path, context)
    } else {
        Vec::new()
    };
    for group in found {
        context.diagnostics.push(group.error);
        meant.push(group.key);
        said.extend(group.spans);
    }
    let mut is_something_else = false;
    for entry in table.entries.iter().filter(|entry| !said.contains(&entry.name.span)) {
        if let Some(key) = spec.key(&entry.name.text) {
            let before = context.diagnostics.len();
            corrections::radians(&entry.node, key, spec, context);
            value(&entry.node, &key.kind, Some(entry), path, context);
            if path == "the scene" && context.has_errors(before) {
                context.forces_are_wrong |= key.name == "force";
                context.bodies_are_wrong |= matches!(key.name, "body" | "defaults" | "variables");
            }
        } else {
            let nameless = if path == "the scene" { corrections::nameless(entry, context) } else { None };
            let (error, key) = match nameless {
                Some((error, key)) => (error, Some(key)),
                None => corrections::unknown(entry, kind.as_ref(), table, spec, path, context),
            };
            context.forces_are_wrong |= path == "the scene" && key.is_none_or(|key| key == "force");
            is_something_else |= key.is_none();
            meant.extend(key);
            context.diagnostics.push(error);
        }
    }
    if let Some(kind) = &kind {
        corrections::correct_word(kind, table, at, before, context);
    }
    let is_whole = !context.is_partial;
    for key in spec.keys().filter(|key| is_whole && key.required && table.get(key.name).is_none()) {
        if !meant.contains(&key.name) {
            let error = corrections::correct_missing(missing_key(key, at, path), key, at, context);
            context.diagnostics.push(error);
        }
    }
    // If an unknown key may be a misspelled kind, such as `sphre`, do not also report that the kind is missing.
    if !is_something_else || !matches!(spec.rule, Rule::ExactlyOne(_)) {
        rule(table, spec, &meant, at, path, context);
    }
}

fn missing_key(key: &KeySpec, at: Option<Span>, path: &str) -> Diagnostic {
    let message = format!("`{}` is missing in {path}", key.name);
    let error = Diagnostic::error(Code::MissingKey, message);
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

fn rule(
    table: &Table,
    spec: &'static TableSpec,
    meant: &[&str],
    at: Option<Span>,
    path: &str,
    context: &mut Context<'_>,
) {
    let present =
        |names: &[&str]| table.entries.iter().filter(|e| names.contains(&&*e.name.text)).collect::<Vec<_>>();
    match &spec.rule {
        Rule::Any => {}
        Rule::AtMostOne(groups) => {
            let mut said: Vec<Span> = Vec::new();
            for entries in groups.iter().map(|names| present(names)).filter(|entries| entries.len() > 1) {
                // Report each key only once, although the groups overlap.
                if !entries.iter().any(|entry| said.contains(&entry.name.span)) {
                    said.extend(entries.iter().map(|entry| entry.name.span));
                    context.diagnostics.push(exclusive(&entries, path));
                }
            }
        }
        Rule::ExactlyOne(names) => match present(names).as_slice() {
            [_] => {}
            [] if context.is_partial || names.iter().any(|name| meant.contains(name)) => {}
            [] => {
                let message = format!("{} needs one of {}", spec.noun, quoted(names));
                let error = Diagnostic::error(Code::MissingKey, message);
                let error = match at {
                    Some(span) => error.at(span, format!("{path} says none of them")),
                    None => error,
                };
                context.diagnostics.push(corrections::correct_kind(error, table, spec, at, path, context));
            }
            entries => context.diagnostics.push(exclusive(entries, path)),
        },
    }
}

fn exclusive(entries: &[&Entry], path: &str) -> Diagnostic {
    let names: Vec<&str> = entries.iter().map(|entry| &*entry.name.text).collect();
    let message = format!("{} exclude each other in {path}", corrections::quoted_and(&names));
    let error = Diagnostic::error(Code::ExclusiveKeys, message);
    // Treat the first key as right, and label the later keys as superfluous.
    let (first, rest) = (entries[0], &entries[1..]);
    let error =
        rest.iter().fold(error, |error, entry| error.at(entry.name.span, "only one of them can hold"));
    error.at(first.name.span, "the other is here")
}

fn value(node: &Node, kind: &'static Kind, entry: Option<&Entry>, path: &str, context: &mut Context<'_>) {
    if matches!(node.value, Value::Invalid) {
        return;
    }
    let before = context.diagnostics.len();
    of_kind(node, kind, entry, path, context);
    corrections::correct_value(before, node, kind, entry, context);
}

fn of_kind(node: &Node, kind: &'static Kind, entry: Option<&Entry>, path: &str, context: &mut Context<'_>) {
    if let (Kind::File | Kind::Include | Kind::Asset, Some(name), Some(folder)) =
        (kind, node.as_str(), context.folder)
    {
        context.sources.note_file(folder.join(name));
    }
    match kind {
        Kind::Text if node.as_str().is_none() => context.diagnostics.push(read::wrong_type(node, kind)),
        Kind::Boolean if !matches!(node.value, Value::Boolean(_)) => {
            context.diagnostics.push(read::wrong_type(node, kind));
        }
        Kind::Text | Kind::Boolean => {}
        Kind::Number(bound) => keep(read::number(node, *bound), context),
        Kind::Timed(bound) => keep(read::timed(node, *bound), context),
        Kind::Varying(bound) => keep(read::varying(node, *bound), context),
        Kind::VaryingNumbers(_, bound) => keep_all(read::varying_point(node, *bound), context),
        Kind::Sampled(bound) => keep(read::drawn(node, *bound), context),
        Kind::TimedNumbers(_, bound) => keep_all(read::timed_vector(node, *bound), context),
        Kind::OfBody(names) => keep(read::of_body(node, names), context),
        Kind::ListOfBody(_, names) => keep_all(read::list_of_body(node, names), context),
        Kind::File if node.as_str().is_none() => context.diagnostics.push(read::wrong_type(node, kind)),
        Kind::File => keep(super::asset::asset(node, context.folder, context.trust), context),
        Kind::Integer(low, high) => keep(read::integer(node, *low, *high), context),
        Kind::Numbers(4, bound) => keep_all(read::numbers::<4>(node, *bound), context),
        Kind::Numbers(2, bound) => keep_all(read::numbers::<2>(node, *bound), context),
        Kind::Numbers(_, bound) => keep_all(read::numbers::<3>(node, *bound), context),
        Kind::Formulas(count) => keep_all(read::formulas(node, *count), context),
        Kind::Direction(4) => keep_all(read::direction::<4>(node), context),
        Kind::Direction(_) => keep_all(read::direction::<3>(node), context),
        Kind::Color => keep_all(read::color(node), context),
        Kind::Colors => keep_all(read::colors(node), context),
        Kind::Identifier => keep(read::identifier(node), context),
        Kind::Sdl(place) => {
            sdl::check(node, *place, context);
            // Only the SDL of the whole scene has values.
            if *place == Where::Top {
                return;
            }
            let text = node.as_str().unwrap_or_default();
            context.diagnostics.extend(super::povray::value_in_sdl(text, node.span, &context.sources));
        }
        Kind::Include if node.as_str().is_none() => context.diagnostics.push(read::wrong_type(node, kind)),
        Kind::Include => match super::povray::include(node, context.folder, context.trust) {
            Ok(Include::Text { name, text }) => sdl::check_include(&name, &text, node.span, context),
            Ok(Include::Standard(_)) => {}
            Err(error) => context.diagnostics.push(error),
        },
        Kind::Asset if node.as_str().is_none() => context.diagnostics.push(read::wrong_type(node, kind)),
        Kind::Asset => match super::asset::asset(node, context.folder, context.trust) {
            Ok(asset) => sdl::check_asset(&asset.name, node.span, context),
            Err(error) => context.diagnostics.push(error),
        },
        Kind::Choice(words) => choice(node, kind, &words(), entry, context),
        Kind::Reference(collection) => reference(node, kind, *collection, entry, context),
        Kind::List { of, .. } => match read::list(node, kind) {
            Ok(items) => {
                // Validate each source span once: copies of a body share one item of the source text.
                let groups = items.chunk_by(|one, next| one.span == next.span);
                groups.for_each(|group| value(&group[0], of, None, path, context));
            }
            Err(error) => context.diagnostics.push(error),
        },
        Kind::Table(spec) => match node.as_table() {
            Some(inner) if is_known(inner, context) => {}
            Some(inner) => table(inner, spec, at(node, entry), &inner_path(entry, path), context),
            None => {
                context.diagnostics.push(read::wrong_type(node, kind).help(corrections::known_keys(spec)));
            }
        },
        Kind::Partial(spec) => match node.as_table() {
            Some(inner) => {
                let before = context.diagnostics.len();
                context.is_partial = true;
                table(inner, spec, at(node, entry), &inner_path(entry, path), context);
                context.is_partial = false;
                context.once(before, "", node.span);
            }
            None => {
                context.diagnostics.push(read::wrong_type(node, kind).help(corrections::known_keys(spec)));
            }
        },
        Kind::Variables(spec) => match node.as_table() {
            Some(inner) => {
                let path = inner_path(entry, path);
                for entry in &inner.entries {
                    match entry.node.as_table() {
                        Some(variable) => {
                            table(
                                variable,
                                spec,
                                Some(entry.name.span),
                                &inner_path(Some(entry), &path),
                                context,
                            );
                        }
                        None => value(&entry.node, &Kind::Number(Bound::Any), None, &path, context),
                    }
                }
            }
            None => context.diagnostics.push(read::wrong_type(node, kind)),
        },
        Kind::Named(spec) => named(node, spec, entry, context),
        Kind::Either(kinds) => match kinds.iter().find(|kind| kind.takes(&node.value)) {
            Some(kind) => value(node, kind, entry, path, context),
            None => context.diagnostics.push(read::wrong_type(node, kind)),
        },
    }
}

/// Returns whether this table has already been validated for another copy of the same body. Marks the table as validated.
fn is_known(table: &Table, context: &mut Context<'_>) -> bool {
    table.entries.address().is_some_and(|address| !context.validated.insert((address, context.is_partial)))
}

/// Returns the source span that names a table: the span of its key, or of the table itself if it has no key.
fn at(node: &Node, entry: Option<&Entry>) -> Option<Span> {
    Some(entry.map_or(node.span, |entry| entry.name.span))
}

/// Returns the name of an inner table in diagnostics. For example, `shape` in `[body.ball]` is called `shape` of [body.ball], and a
/// `sphere` in this shape is called `sphere` of [body.ball].
fn inner_path(entry: Option<&Entry>, path: &str) -> String {
    let Some(entry) = entry else { return path.to_owned() };
    if path == "the scene" {
        return format!("[{}]", entry.name.text);
    }
    // Split at the first occurrence of " of ": only keys of the grammar precede it, while the name after it is arbitrary.
    let table = match path.split_once("` of ") {
        Some((_, table)) if path.starts_with('`') => table,
        _ => path,
    };
    format!("`{}` of {table}", entry.name.text)
}

fn named(node: &Node, spec: &'static TableSpec, sort: Option<&Entry>, context: &mut Context<'_>) {
    let word = sort.map_or("", |entry| &*entry.name.text);
    let Some(tables) = node.as_table() else {
        let found = node.in_words();
        let message = format!("expected tables with names, as in `[{word}.NAME]`, found {found}");
        let error = Diagnostic::error(Code::WrongType, message).at(node.span, "");
        context.diagnostics.push(corrections::correct_array(error, node, word, context));
        return;
    };
    // Keys of one table without a name need one name.
    let mut is_unnamed_said = false;
    for entry in &tables.entries {
        let original = match word {
            "body" => context.groups.original(&entry.name.text),
            _ => context.groups.original_link(&entry.name.text),
        };
        let shown = original.unwrap_or(&entry.name.text);
        let path = format!("[{word}.{}]", as_key(shown));
        let before = context.diagnostics.len();
        match entry.node.table().as_deref() {
            Some(inner)
                if context.has_too_many_wrong_copies(&entry.name.text) || is_known(inner, context) => {}
            Some(inner) if !is_unnamed(entry, inner, spec) => {
                table(inner, spec, Some(entry.name.span), &path, context);
                let owner = Owner { table: inner, spec, at: entry.name.span, path: &path };
                owner.correct_deep(before, context);
                if word == "force" && context.has_errors(before) {
                    context.wrong_forces.insert(entry.name.text.clone());
                }
                context.once(before, &entry.name.text, entry.name.span);
            }
            None if matches!(entry.node.value, Value::Invalid) => {}
            _ if is_unnamed_said && spec.key(&entry.name.text).is_some() => {}
            _ => {
                is_unnamed_said |= spec.key(&entry.name.text).is_some();
                let name = &entry.name.text;
                let message = format!("`{name}` stands in [{word}], where only tables with names do");
                let help = format!("name a {word} with `[{word}.NAME]`, and write `{name}` below it");
                let label = format!("of which {word}?");
                let error =
                    Diagnostic::error(Code::UnnamedTable, message).at(entry.name.span, label).help(help);
                context.diagnostics.push(match sort {
                    Some(sort) => corrections::correct_unnamed(error, sort, entry, spec, context),
                    None => error,
                });
            }
        }
    }
}

/// Returns whether `entry` of a collection's table is a key of a member instead of a named member, such as `shape` directly below the
/// header `[body]`. Then the header lacks a name, as in `[body.ball]`.
fn is_unnamed(entry: &Entry, inner: &Table, spec: &TableSpec) -> bool {
    let Some(key) = spec.key(&entry.name.text) else { return false };
    let tables = match &key.kind {
        Kind::Either(kinds) => kinds,
        kind => std::slice::from_ref(kind),
    };
    let holds = |spec: &TableSpec| inner.entries.iter().all(|entry| spec.key(&entry.name.text).is_some());
    let fits = |kind: &Kind| matches!(kind, Kind::Table(inner) if holds(inner));
    !inner.entries.is_empty() && tables.iter().any(fits) && !holds(spec)
}

/// Formats a name as a key in a TOML header, with quotes if necessary.
pub(super) fn as_key(name: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    if !name.is_empty() && name.chars().all(is_bare) { name.to_owned() } else { format!("\"{name}\"") }
}

fn choice(node: &Node, kind: &Kind, words: &[&str], entry: Option<&Entry>, context: &mut Context<'_>) {
    match node.as_str() {
        None => context.diagnostics.push(read::wrong_type(node, kind)),
        Some(word) if words.contains(&word) => {}
        Some(word) => {
            let noun = entry.map_or("word", |entry| &*entry.name.text);
            let error = Diagnostic::error(Code::UnknownName, format!("unknown {noun} `{word}`"));
            let known = match words {
                [only] => format!("there is `{only}`"),
                words => format!("there are {}", quoted(words)),
            };
            if let ([only], true) = (words, corrections::is_word_to_come(noun, word)) {
                let error = error.at(node.span, "not built yet").help(known);
                context.diagnostics.push(error.fix(node.span, format!("\"{only}\"")));
                return;
            }
            let other = corrections::other_word(word, words);
            context.diagnostics.push(match other.or_else(|| suggest::nearest(word, words.iter().copied())) {
                Some(near) => error
                    .at(node.span, format!("did you mean `{near}`?"))
                    .help(known)
                    .fix(node.span, format!("\"{near}\""))
                    .fix_is_said(),
                None => error.at(node.span, known),
            });
        }
    }
}

fn reference(
    node: &Node,
    kind: &Kind,
    collection: Collection,
    entry: Option<&Entry>,
    context: &mut Context<'_>,
) {
    let Some(word) = node.as_str() else {
        context.diagnostics.push(read::wrong_type(node, kind));
        return;
    };
    let names = context.names.get(collection);
    let library: Vec<&str> = match collection {
        Collection::Body | Collection::Target | Collection::Joint | Collection::Force => Vec::new(),
        Collection::Material => MATERIALS.iter().map(|material| material.name).collect(),
    };
    let is_body = matches!(collection, Collection::Body | Collection::Target);
    if collection == Collection::Target && context.names.emitters.contains(word) {
        return;
    }
    if names.contains_key(word) || library.contains(&word) || is_body && context.groups.may_hold(word) {
        return;
    }
    let has_emitters = collection == Collection::Target && !context.names.emitters.is_empty();
    let noun = if has_emitters { "body or emitter" } else { collection.key() };
    let copies = context.groups.ends(collection, word);
    let is_body_for_joint = collection == Collection::Joint && context.names.bodies.contains_key(word);
    let label = if is_body_for_joint {
        format!("`{word}` is a body; name the joint that holds it")
    } else if let Some([first, last]) = copies {
        format!("its copies are `{first}` to `{last}`")
    } else if names.len() + library.len() > context.comparisons {
        String::new()
    } else {
        let mut known: Vec<&str> = names.keys().map(AsRef::as_ref).collect();
        known.sort_unstable_by_key(|name| names[*name]);
        if has_emitters {
            let mut emitters: Vec<&str> = context.names.emitters.iter().map(AsRef::as_ref).collect();
            emitters.sort_unstable();
            known.extend(emitters);
        }
        context.comparisons = context.comparisons.saturating_sub(known.len() + library.len());
        suggest::for_unknown_name(word, &known, &library, noun, collection.plural())
    };
    let error = Diagnostic::error(Code::UnknownName, format!("there is no {noun} `{word}`"));
    let near = label.strip_prefix("did you mean `").and_then(|rest| rest.strip_suffix("`?"));
    // Do not suggest a fix for a single letter, which is similar to every other letter.
    let is_word = word.chars().nth(1).is_some() && !label.contains(['"', '\\']);
    let near = near.map(|near| format!("\"{near}\"")).filter(|_| is_word);
    let is_near = label.starts_with("did you mean");
    let point = word.split_once('.').map(|(body, _)| body);
    let point = point.filter(|body| is_body && context.names.bodies.contains_key(*body));
    let label = match point {
        Some(body) => format!(
            "a point of `{body}` is `{{ body = \"{body}\", at = [0, 0.5, 0] }}`, in the body's own axes"
        ),
        None => label,
    };
    let error = error.at(node.span, label);
    let error = match near {
        Some(near) => error.fix(node.span, near).fix_is_said(),
        None if library.is_empty() || is_near => error,
        None => error.help(format!("names of the library need no table: {}", quoted(&library))),
    };
    context.diagnostics.push(match collection {
        Collection::Body | Collection::Target | Collection::Joint | Collection::Force => error,
        Collection::Material => corrections::color_for_material(error, word, node, entry),
    });
}

fn keep<T>(result: Result<T, Diagnostic>, context: &mut Context<'_>) {
    context.diagnostics.extend(result.err());
}

fn keep_all<T>(result: Result<T, Vec<Diagnostic>>, context: &mut Context<'_>) {
    context.diagnostics.extend(result.err().into_iter().flatten());
}
