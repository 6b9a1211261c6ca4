//! Finds keys of the scene language by the words that a user writes, and explains them from their descriptions.

use std::collections::VecDeque;
use std::fmt;

use super::{KeySpec, Kind, Rule, SCENE, TableSpec, quoted};
use crate::diagnostic::nearest;

/// The part of a path that stands for any name, as in `body.NAME.mass`.
const NAME_PLACEHOLDER: &str = "NAME";

/// A key of the scene language, and the path that leads to it. It is printed as its explanation.
#[derive(Clone, Debug)]
pub struct FoundKey {
    /// The path, such as `body.NAME.shape.sphere`.
    pub path: String,
    /// The description of the key.
    pub spec: &'static KeySpec,
}

/// A table that a path leads to. `is_named` means that a name comes first: `[body.NAME]`.
type Inside = (&'static TableSpec, bool);

/// Finds the keys that a user means by `words`: a path (`body.mass` or `body.ball.mass`), the end of one (`sphere.radius`), or a single key
/// (`radius`), which may be in several tables.
///
/// # Errors
/// If there is no such key. The error is the path of a similar key, if one is similar enough.
pub fn find_keys(words: &str) -> Result<Vec<FoundKey>, Option<String>> {
    let words: Vec<&str> = words.split('.').map(|word| word.trim_matches(['[', ']', ' '])).collect();
    if let Some(key) = at(&words) {
        return Ok(vec![key]);
    }
    let all = all_keys();
    let ending = |end: &[&str]| -> Vec<FoundKey> {
        let ends = |key: &&FoundKey| {
            let path: Vec<&str> = key.path.split('.').filter(|word| *word != NAME_PLACEHOLDER).collect();
            path.ends_with(end)
        };
        all.iter().filter(ends).cloned().collect()
    };
    let found = ending(&words);
    if !found.is_empty() {
        return Ok(found);
    }
    let Some((last, before)) = words.split_last() else { return Err(None) };
    // A key of the named table comes first, and then any key: by a word of another program, or by a similar word.
    let table = at(before);
    let inside: Vec<FoundKey> =
        table.as_ref().map(|key| keys_in(&key.path, &key.spec.kind)).unwrap_or_default();
    let also = |keys: &[FoundKey]| keys.iter().find(|key| key.spec.also.contains(last)).cloned();
    let similar = |keys: &[FoundKey]| {
        let name = nearest(last, keys.iter().map(|key| key.spec.name))?;
        keys.iter().find(|key| key.spec.name == name).cloned()
    };
    match (also(&inside).or_else(|| similar(&inside)), table) {
        (Some(key), _) => Err(Some(key.path)),
        // `body.ball` is a body of this name.
        (None, Some(table)) if !last.is_empty() && matches!(table.spec.kind, Kind::Named(_)) => {
            Ok(vec![table])
        }
        (None, _) => Err(also(&all).or_else(|| similar(&all)).map(|key| key.path)),
    }
}

/// Returns all keys of the language, those of the scene's own tables first. Each table appears once, at its shortest path.
pub fn all_keys() -> Vec<FoundKey> {
    let mut found: Vec<FoundKey> = Vec::new();
    let mut seen: Vec<&TableSpec> = vec![&SCENE];
    let mut open = VecDeque::from([(String::new(), (&SCENE, false))]);
    while let Some((path, inside)) = open.pop_front() {
        for key in keys_of(&path, inside) {
            for table in tables(&key.spec.kind) {
                // `[defaults]` has tables of the same keys.
                let is_new = !matches!(key.spec.kind, Kind::Partial(_))
                    && !seen.iter().any(|seen| std::ptr::eq(*seen, table.0));
                if is_new {
                    seen.push(table.0);
                    open.push_back((key.path.clone(), table));
                }
            }
            found.push(key);
        }
    }
    found
}

/// Returns the key at a path in a scene, such as `["body", "ball", "mass"]`. `None` if there is no such key, or the path ends in a name.
pub fn key_at(words: &[&str]) -> Option<FoundKey> {
    follow(words, Place { needs_names: true, ..Place::scene() })
}

/// Follows a path as people write it: names may be left out. A word that is no key where a name stands is taken for a name.
fn at(words: &[&str]) -> Option<FoundKey> {
    follow(words, Place::scene())
}

fn follow(words: &[&str], mut place: Place) -> Option<FoundKey> {
    let (last, before) = words.split_last()?;
    if !before.iter().all(|word| place.enter(word)) {
        return None;
    }
    // A misspelled key is no name: the caller suggests the key.
    let is_key = *last == NAME_PLACEHOLDER || place.key(last).is_some();
    (is_key && place.enter(last)).then_some(place.found).flatten()
}

/// Returns the keys of the table at a path, such as `["body", "ball"]`. Empty if there is no such table, or its keys are names.
pub fn keys_inside(words: &[&str]) -> Vec<FoundKey> {
    let mut place = Place { needs_names: true, ..Place::scene() };
    if !words.iter().all(|word| place.enter(word)) {
        return Vec::new();
    }
    let tables = place.inside.iter().filter(|(_, is_named)| !is_named);
    tables.flat_map(|&table| keys_of(&place.path, table)).collect()
}

/// A place in the scene: the tables that can stand there, the path to them, and the key that leads there.
struct Place {
    inside: Vec<Inside>,
    path: String,
    found: Option<FoundKey>,
    /// Whether a name comes before the keys of a named table. If not, it may be left out.
    needs_names: bool,
}

impl Place {
    fn scene() -> Place {
        Place { inside: vec![(&SCENE, false)], path: String::new(), found: None, needs_names: false }
    }

    fn key(&self, word: &str) -> Option<FoundKey> {
        let tables = self.inside.iter().filter(|(_, is_named)| !(self.needs_names && *is_named));
        tables.flat_map(|&table| keys_of(&self.path, table)).find(|key| key.spec.name == word)
    }

    /// Follows a key, or a name where names stand. Returns false if the word is neither.
    fn enter(&mut self, word: &str) -> bool {
        if let Some(key) = self.key(word) {
            self.inside = tables(&key.spec.kind);
            self.path.clone_from(&key.path);
            self.found = Some(key);
            return true;
        }
        self.inside.retain(|(_, is_named)| *is_named);
        self.inside.iter_mut().for_each(|(_, is_named)| *is_named = false);
        self.path = format!("{}.{NAME_PLACEHOLDER}", self.path);
        !self.inside.is_empty()
    }
}

/// Returns the keys of all tables that can stand at `path`, where the language asks for a value of `kind`.
fn keys_in(path: &str, kind: &'static Kind) -> Vec<FoundKey> {
    tables(kind).into_iter().flat_map(|table| keys_of(path, table)).collect()
}

fn keys_of(path: &str, (table, is_named): Inside) -> Vec<FoundKey> {
    let name = if is_named { format!(".{NAME_PLACEHOLDER}") } else { String::new() };
    let dot = if path.is_empty() { "" } else { "." };
    let key = |spec: &'static KeySpec| FoundKey { path: format!("{path}{name}{dot}{}", spec.name), spec };
    table.keys().map(key).collect()
}

fn tables(kind: &'static Kind) -> Vec<Inside> {
    match kind {
        Kind::Table(table) | Kind::Partial(table) => vec![(table, false)],
        Kind::Named(table) | Kind::Variables(table) => vec![(table, true)],
        Kind::Either(kinds) => kinds.iter().flat_map(tables).collect(),
        Kind::List { of, .. } => tables(of),
        _ => Vec::new(),
    }
}

impl fmt::Display for FoundKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let KeySpec { kind, unit, default, meaning, required, .. } = self.spec;
        let mut line = |label: &str, text: &str| match text {
            "" => Ok(()),
            text => writeln!(f, "{label:<9} {text}"),
        };
        line("key", &self.path)?;
        line("meaning", meaning)?;
        line("value", &kind.in_words())?;
        line("unit", unit)?;
        line("default", if *required { "none: the key is required" } else { "" })?;
        line("default", &if *required { String::new() } else { default.in_words() })?;
        for (table, _) in tables(kind) {
            writeln!(f)?;
            match &table.rule {
                Rule::Any => {}
                Rule::ExactlyOne(names) => writeln!(f, "exactly one of {}", quoted(names))?,
                Rule::AtMostOne(groups) => {
                    groups.iter().try_for_each(|names| writeln!(f, "at most one of {}", quoted(names)))?;
                }
            }
            let width = table.keys().map(|key| key.name.len()).max().unwrap_or(0);
            for key in table.keys {
                writeln!(f, "  {:width$}  {}", key.name, key.meaning)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(words: &str) -> Vec<String> {
        find_keys(words).unwrap_or_default().into_iter().map(|key| key.path).collect()
    }

    #[test]
    fn a_key_is_found_by_its_path_with_or_without_a_name() {
        for words in
            ["body.restitution", "body.ball.restitution", "[body.NAME.restitution]", "body.NAME.restitution"]
        {
            assert_eq!(paths(words), ["body.NAME.restitution"], "{words}");
        }
        assert_eq!(paths("simulation.gravity"), ["simulation.gravity"]);
        assert_eq!(paths("body.ball.shape.sphere.radius"), ["body.NAME.shape.sphere.radius"]);
        assert_eq!(paths("body"), ["body"]);
        assert_eq!(paths("body.NAME"), ["body"]);
        assert_eq!(paths("material.brass"), ["material"]);
    }

    #[test]
    fn in_a_scene_each_table_has_its_name() {
        let path = |words: &[&str]| key_at(words).map(|key| key.path);
        assert_eq!(path(&["joint", "rod", "rod", "between"]).as_deref(), Some("joint.NAME.rod.between"));
        assert_eq!(path(&["body", "mass", "mass"]).as_deref(), Some("body.NAME.mass"));
        assert_eq!(path(&["joint", "rod"]), None);
        let names = |words: &[&str]| keys_inside(words).iter().map(|key| key.spec.name).collect::<Vec<_>>();
        assert!(names(&["body", "ball"]).contains(&"mass") && names(&["body"]).is_empty());
        assert!(names(&[]).contains(&"body"));
    }

    #[test]
    fn the_end_of_a_path_is_enough() {
        assert_eq!(paths("gravity"), ["simulation.gravity"]);
        assert_eq!(paths("sphere.radius")[0], "body.NAME.shape.sphere.radius");
        assert!(paths("radius").len() > 3);
    }

    #[test]
    fn an_unknown_key_suggests_one_of_its_table() {
        let near = |words| find_keys(words).err().flatten();
        assert_eq!(near("body.restitusion").as_deref(), Some("body.NAME.restitution"));
        assert_eq!(near("body.bounciness").as_deref(), Some("body.NAME.restitution"));
        assert_eq!(near("simulation.gravty").as_deref(), Some("simulation.gravity"));
        assert_eq!(near("gravty").as_deref(), Some("simulation.gravity"));
        for words in ["", ".", "..", "xyzzy", "body.", "body..mass.", "simulation.step.mass"] {
            assert!(find_keys(words).is_err(), "{words}");
        }
    }

    #[test]
    fn every_key_is_found_by_its_path_and_explained() {
        let all = all_keys();
        assert!(all.len() > 200, "{}", all.len());
        for key in all {
            assert_eq!(paths(&key.path), [&*key.path]);
            let text = key.to_string();
            assert!(text.contains(key.spec.meaning) && !text.contains("\n\n\n"), "{text}");
        }
    }
}
