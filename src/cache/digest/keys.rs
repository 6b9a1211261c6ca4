//! Tests that each key of the scene language changes the digest of a run, unless it only draws.
//!
//! The scenes in `tests/keys` contain all keys. The test replaces one value at a time by other values, checks the scene, and compares its
//! digest with that of the original scene. A new key needs a line in one of these scenes, in which its value changes the run. If the key only
//! draws, it also needs a line in `keys/drawn.rs`.

mod document;
mod drawn;
mod other;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use self::document::{Document, Id, KeyInFile};
use self::other::others;
use crate::scene::grammar::{Kind, SCENE, TableSpec};

/// The largest number of bodies of a scene of the gallery that is tried. Scenes with more bodies take too long to check many times.
const MAX_BODIES: usize = 50;
/// For each key that only draws, the test replaces at most this many values of the gallery, each by at most this many others.
const MAX_TRIES: usize = 3;

/// The effect of other values of a key on the digest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Effect {
    /// No other value is valid.
    Untried,
    /// No tried value changes the digest.
    Equal,
    /// At least one value changes the digest.
    Different,
}

/// Returns all tables of the language.
fn tables() -> Vec<&'static TableSpec> {
    fn add(table: &'static TableSpec, found: &mut Vec<&'static TableSpec>) {
        if !found.iter().any(|known| std::ptr::eq(*known, table)) {
            found.push(table);
            table.keys().for_each(|key| add_inside(&key.kind, found));
        }
    }
    fn add_inside(kind: &'static Kind, found: &mut Vec<&'static TableSpec>) {
        match kind {
            Kind::Table(table) | Kind::Named(table) | Kind::Partial(table) | Kind::Variables(table) => {
                add(table, found);
            }
            Kind::Either(kinds) => kinds.iter().for_each(|kind| add_inside(kind, found)),
            Kind::List { of, .. } => add_inside(of, found),
            _ => {}
        }
    }
    let mut found = Vec::new();
    add(&SCENE, &mut found);
    found
}

/// Returns true if the lists in `keys/drawn.rs` contain a key or its table.
fn only_draws((noun, name): Id) -> bool {
    let is_listed = |(table, keys): &(&str, &[&str])| *table == noun && keys.contains(&name);
    drawn::TABLES_THAT_DRAW.contains(&noun) || drawn::KEYS_THAT_DRAW.iter().any(is_listed)
}

/// Reads the scenes of a folder of the project.
fn documents(folder: &str) -> Vec<Document> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|end| end == "toml"));
    paths.sort();
    paths.par_iter().map(|path| Document::read(path)).collect()
}

/// Tries other values of a key until one changes the digest. If the key only draws, a few values are tried.
fn effect(place: &KeyInFile<'_>) -> Effect {
    let digests = others(place).into_iter().filter_map(|other| place.digest_with(other.as_deref()));
    let most = if only_draws(place.id()) { MAX_TRIES } else { usize::MAX };
    let mut effect = Effect::Untried;
    for digest in digests.take(most) {
        if digest != place.document.digest {
            return Effect::Different;
        }
        effect = Effect::Equal;
    }
    effect
}

/// Returns all values of the scenes in `tests/keys`, and a few values of each key that only draws from the gallery.
fn places<'a>(own: &'a [Document], gallery: &'a [Document]) -> Vec<KeyInFile<'a>> {
    let mut places: Vec<KeyInFile<'a>> = own.iter().flat_map(Document::places).collect();
    let mut counts: BTreeMap<Id, usize> = BTreeMap::new();
    for place in gallery.iter().filter(|scene| scene.bodies <= MAX_BODIES).flat_map(Document::places) {
        let count = counts.entry(place.id()).or_default();
        if only_draws(place.id()) && *count < MAX_TRIES {
            *count += 1;
            places.push(place);
        }
    }
    places
}

#[test]
fn each_key_changes_the_digest_unless_it_only_draws() {
    let (own, gallery) = (documents("tests/keys"), documents("scenes"));
    let places = places(&own, &gallery);
    let effects: Vec<Effect> = places.par_iter().map(effect).collect();
    let mut wrong = BTreeSet::new();
    let mut found: BTreeMap<Id, Effect> = BTreeMap::new();
    for (place, &effect) in places.iter().zip(&effects) {
        // A table changes the digest if a key in it does.
        for id in &place.ids {
            let known = found.entry(*id).or_insert(Effect::Untried);
            *known = effect.max(*known);
        }
        match effect {
            Effect::Different if only_draws(place.id()) => {
                wrong.insert(format!("{place} is a key that only draws, but it changes the digest"));
            }
            Effect::Equal if !only_draws(place.id()) && !place.is_table() => {
                wrong.insert(format!(
                    "{place} does not change the digest: add it to `digest.rs`. If it only draws, add it to `keys/drawn.rs`. \
                     If it does not change the run of this scene, move it to a scene whose run it changes"
                ));
            }
            _ => {}
        }
    }
    let ids = tables().into_iter().flat_map(|table| table.keys().map(|key| (table.noun, key.name)));
    let mut counts: BTreeMap<Effect, usize> = BTreeMap::new();
    for id in ids {
        let effect = found.get(&id).copied();
        *counts.entry(effect.unwrap_or(Effect::Untried)).or_default() += 1;
        let (noun, name) = id;
        let problem = match effect {
            None => "has no value in the scenes of `tests/keys`",
            Some(Effect::Untried) => "has no other valid value in the scenes of `tests/keys`",
            Some(Effect::Equal) if !only_draws(id) => "never changes the digest",
            Some(Effect::Different) if only_draws(id) => "only draws, but a key in it changes the digest",
            Some(_) => continue,
        };
        wrong.insert(format!("the key `{name}` of {noun} {problem}"));
    }
    println!("{counts:?}, {} values", places.len());
    assert!(wrong.is_empty(), "{}", wrong.into_iter().collect::<Vec<_>>().join("\n"));
}

#[test]
fn the_lists_name_keys_that_exist_and_nouns_tell_tables_apart() {
    let nouns: Vec<&str> = tables().iter().map(|table| table.noun).collect();
    assert_eq!(nouns.iter().collect::<BTreeSet<_>>().len(), nouns.len());
    for noun in drawn::TABLES_THAT_DRAW {
        assert!(nouns.contains(noun), "{noun}");
    }
    for (noun, keys) in drawn::KEYS_THAT_DRAW {
        let table = tables().into_iter().find(|table| table.noun == *noun);
        for key in *keys {
            assert!(table.is_some_and(|table| table.key(key).is_some()), "`{key}` of {noun}");
        }
    }
}
