//! Suggests corrections for wrong keys and values, as text that can replace the mistake.

mod ends;
mod gravity;
mod joint;
mod key_group;
mod kind;
mod launch;
mod missing;
mod nameless;
mod not_built;
mod owner;
mod radians;
mod table;
mod text;
mod unknown;
mod value;
mod vector;
mod way;
mod word;

pub(super) use self::gravity::gravity;
pub(super) use self::kind::{correct_word, meant_kind};
pub(super) use self::missing::{correct_kind, correct_missing, insertion};
pub(super) use self::nameless::{correct_array, correct_unnamed, nameless};

pub(super) use self::key_group::key_groups;
pub(super) use self::owner::Owner;
pub(super) use self::radians::radians;
pub(super) use self::text::{before, is_file};
pub(super) use self::unknown::{known_keys, unknown};
pub(super) use self::value::{color_for_material, correct_value};
pub(super) use self::word::other_word;

pub(super) use self::not_built::is_word_to_come;

use self::not_built::not_built;
use crate::scene::grammar::{KeySpec, TableSpec, quoted};

/// Returns the key with this name in the grammar of a table. The name may also be one that other programs use for the key.
fn key_of(word: &str, spec: &'static TableSpec) -> Option<&'static KeySpec> {
    let folded = word.to_lowercase();
    let is_it = |key: &&KeySpec| key.name == folded || key.also.contains(&folded.as_str());
    spec.keys().find(is_it)
}

/// Joins words in backquotes with commas and `and`: `a`, `b` and `c`.
pub(super) fn quoted_and(words: &[&str]) -> String {
    match words {
        [first @ .., last] if !first.is_empty() => format!("{} and `{last}`", quoted(first)),
        words => quoted(words),
    }
}
