//! Finds the known word that is most similar to an unknown word, for messages such as "did you mean …?".

pub(super) use crate::diagnostic::nearest;
use crate::scene::grammar::{TableSpec, quoted};

/// The maximum number of comparisons between unknown and known names in one scene. This many comparisons take a tenth of a second. A scene
/// with more unknown names has other problems than spelling.
pub(super) const MAX_COMPARISONS: usize = 200_000;

/// Returns the key of a table that an unknown key was probably meant to be. `None` if no key is similar.
pub(super) fn key(word: &str, table: &TableSpec) -> Option<&'static str> {
    let folded = word.to_lowercase().replace('-', "_");
    let names = || table.keys().map(|key| key.name);
    let same = table.keys().find(|key| key.name == folded || key.also.contains(&folded.as_str()));
    same.map(|key| key.name).or_else(|| nearest(&folded, names()))
}

/// Returns the path to a key of an inner table, such as `shape.sphere.radius` for `radius` in a body.
pub(super) fn deeper(word: &str, table: &'static TableSpec) -> Option<Vec<&'static str>> {
    table.keys().find_map(|key| {
        let inner = key.kind.table()?;
        let mut way = match inner.key(word) {
            Some(found) => vec![found.name],
            None => deeper(word, inner)?,
        };
        way.insert(0, key.name);
        Some(way)
    })
}

/// Returns the path to a key of an inner table for a name from another program, such as `material.color` for `colour` in a body.
pub(super) fn deeper_also(word: &str, table: &'static TableSpec) -> Option<Vec<&'static str>> {
    let folded = word.to_lowercase();
    table.keys().find_map(|key| {
        let inner = key.kind.table()?;
        let found = inner.keys().find(|key| key.name == folded || key.also.contains(&folded.as_str()))?;
        Some(vec![key.name, found.name])
    })
}

/// Returns the label for an unknown name. `known` are the names that the scene declares, and `everywhere` those that exist in every scene.
/// `noun` and `plural` say what the names stand for.
pub(super) fn for_unknown_name(
    word: &str,
    known: &[&str],
    everywhere: &[&str],
    noun: &str,
    plural: &str,
) -> String {
    match (nearest(word, known.iter().chain(everywhere).copied()), known) {
        (Some(near), _) => format!("did you mean `{near}`?"),
        (None, []) => format!("the scene declares no {plural}"),
        (None, [only]) => format!("the only {noun} of the scene is `{only}`"),
        (None, known) if known.len() <= 12 => format!("there are {}", quoted(known)),
        (None, known) => format!("none of the {} {plural} is called so", known.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::grammar::SCENE;

    #[test]
    fn a_key_of_a_table_inside_is_found() {
        assert_eq!(deeper("gravity", &SCENE), Some(vec!["simulation", "gravity"]));
        assert_eq!(deeper("tile", &SCENE), Some(vec!["environment", "ground", "tile"]));
        assert_eq!(deeper("radius", &SCENE), None, "bodies have names");
    }

    #[test]
    fn the_words_of_other_programs_lead_to_the_key() {
        assert_eq!(key("bodies", &SCENE), Some("body"));
        assert_eq!(key("cammera", &SCENE), Some("camera"));
        assert_eq!(key("xyzzy", &SCENE), None);
    }
}
