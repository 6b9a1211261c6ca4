//! Explains the keys of a document, and completes keys and values.

use serde_json::{Value, json};

use super::document::{Document, keys};
use crate::scene::grammar::{Kind, key_at, keys_inside};

/// The protocol's kind of a completion that is a key.
const PROPERTY_COMPLETION: u32 = 10;
/// The protocol's kind of a completion that is one of several words.
const ENUM_MEMBER: u32 = 20;

fn is_of_key(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || matches!(letter, '_' | '-')
}

/// Explains the key at a place. `None` if there is no key.
pub(super) fn explanation(document: &Document, place: &Value) -> Option<Value> {
    let (number, at) = document.place(place)?;
    let line = document.line(number);
    // The name at the place ends a path.
    let end = at + line.get(at..)?.find(|letter| !is_of_key(letter)).unwrap_or(line.len() - at);
    let before = line.get(..end)?;
    let trimmed = before.trim_start();
    let path = if let Some(header) = trimmed.strip_prefix('[') {
        keys(header.trim_start_matches('['))
    } else {
        if trimmed.contains(['=', '#']) {
            return None;
        }
        [document.table(number), keys(trimmed)].concat()
    };
    let words: Vec<&str> = path.iter().map(String::as_str).collect();
    let key = key_at(&words)?;
    let text = key.to_string();
    // The keys of a table would be too long for a hover.
    let text = text.split("\n\n").next().unwrap_or_default();
    Some(json!({ "contents": { "kind": "markdown", "value": format!("```text\n{}\n```", text.trim_end()) } }))
}

/// Completes the key, the name or the value before a place.
pub(super) fn completions(document: &Document, place: &Value) -> Option<Value> {
    let (number, at) = document.place(place)?;
    let before = document.line(number).get(..at)?.trim_start();
    if let Some(header) = before.strip_prefix('[') {
        let path = keys(header.trim_start_matches('['));
        return Some(of_keys(&path[..path.len().saturating_sub(1)]));
    }
    let table = document.table(number);
    if let Some((key, value)) = before.split_once('=') {
        return of_values(document, &[table, keys(key)].concat(), value);
    }
    if !before.chars().all(|letter| is_of_key(letter) || letter == '.') {
        return None;
    }
    let path = keys(before);
    Some(of_keys(&[&table, &path[..path.len().saturating_sub(1)]].concat()))
}

fn of_keys(path: &[String]) -> Value {
    let words: Vec<&str> = path.iter().map(String::as_str).collect();
    let items: Vec<Value> = keys_inside(&words)
        .iter()
        .map(|key| json!({ "label": key.spec.name, "kind": PROPERTY_COMPLETION, "documentation": key.spec.meaning }))
        .collect();
    json!(items)
}

/// Completes a value of which a part may be written.
fn of_values(document: &Document, path: &[String], written: &str) -> Option<Value> {
    let words: Vec<&str> = path.iter().map(String::as_str).collect();
    let key = key_at(&words)?;
    let mut values = Vec::new();
    collect(document, &key.spec.kind, &mut values);
    let is_quoted = written.contains('"');
    let item = |(word, is_text): &(String, bool)| {
        let label = if *is_text && !is_quoted { format!("\"{word}\"") } else { word.clone() };
        json!({ "label": label, "kind": ENUM_MEMBER })
    };
    Some(json!(values.iter().map(item).collect::<Vec<_>>()))
}

/// Collects the words that a value may be, each with whether it is a string.
fn collect(document: &Document, kind: &Kind, into: &mut Vec<(String, bool)>) {
    match kind {
        Kind::Boolean => into.extend(["true", "false"].map(|word| (word.to_owned(), false))),
        Kind::Choice(words) => into.extend(words().into_iter().map(|word| (word.to_owned(), true))),
        Kind::Reference(collection) => {
            let named = document.text.lines().filter_map(|line| {
                let [table, name] = &keys(line.trim().strip_prefix('[')?.split(']').next()?)[..] else {
                    return None;
                };
                (table == collection.key() && !name.is_empty()).then(|| (name.clone(), true))
            });
            into.extend(named);
        }
        Kind::Either(kinds) => kinds.iter().for_each(|kind| collect(document, kind, into)),
        Kind::List { of, .. } => collect(document, of, into),
        _ => {}
    }
}
