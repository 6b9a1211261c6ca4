//! "Did you mean …?"

use crate::scene::grammar::{TableSpec, quoted};

/// The best of the candidates for a word that is none of them, if one is near enough.
pub(super) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = word.to_lowercase();
    let distance = |candidate: &str| strsim::damerau_levenshtein(&folded, &candidate.to_lowercase());
    // A third of the letters may differ, as rustc has it; of two letters, one.
    let most = (word.chars().count() / 3).max(1);
    candidates
        .into_iter()
        .map(|candidate| (distance(candidate), candidate))
        .filter(|&(distance, _)| distance <= most)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// The key of a table that an unknown one was meant to be.
pub(super) fn key(word: &str, table: &TableSpec) -> Option<&'static str> {
    let folded = word.to_lowercase().replace('-', "_");
    let names = || table.keys.iter().map(|key| key.name);
    let same = table.keys.iter().find(|key| key.name == folded || key.also.contains(&folded.as_str()));
    same.map(|key| key.name).or_else(|| nearest(&folded, names()))
}

/// What to say of an unknown word, given those that are known.
pub(super) fn label<'a>(word: &str, known: impl Iterator<Item = &'a str> + Clone, noun: &str) -> String {
    match nearest(word, known.clone()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => expected(&known.collect::<Vec<_>>(), noun),
    }
}

/// The words that were expected; of many, that there are many.
fn expected(known: &[&str], noun: &str) -> String {
    match known {
        [] => format!("the scene has no {noun}"),
        known if known.len() <= 12 => format!("expected one of {}", quoted(known)),
        known => format!("expected the name of one of {} {noun}s", known.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::grammar::SCENE;

    #[test]
    fn near_words_are_found_and_far_ones_are_not() {
        let words = ["radius", "size", "length"];
        assert_eq!(nearest("raduis", words), Some("radius"));
        assert_eq!(nearest("Radius", words), Some("radius"));
        assert_eq!(nearest("colour", words), None);
        assert_eq!(nearest("", words), None);
    }

    #[test]
    fn the_words_of_other_programs_lead_to_the_key() {
        assert_eq!(key("bodies", &SCENE), Some("body"));
        assert_eq!(key("cammera", &SCENE), Some("camera"));
        assert_eq!(key("xyzzy", &SCENE), None);
    }
}
