//! The word that was meant.

/// Longer words are no names that anyone types.
const MAX_LENGTH: usize = 64;

/// The best of the candidates for a word that is none of them, if one is near enough.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = word.to_lowercase();
    let distance = |candidate: &str| strsim::damerau_levenshtein(&folded, &candidate.to_lowercase());
    // A third of the letters may differ, as rustc has it; of two letters, one.
    let length = word.chars().count();
    let most = (length / 3).max(1);
    let comparable =
        |candidate: &&str| length <= MAX_LENGTH && candidate.chars().count().abs_diff(length) <= most;
    candidates
        .into_iter()
        .filter(comparable)
        .map(|candidate| (distance(candidate), candidate))
        .filter(|&(distance, _)| distance <= most)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_words_are_found_and_far_ones_are_not() {
        let words = ["radius", "size", "length"];
        assert_eq!(nearest("raduis", words), Some("radius"));
        assert_eq!(nearest("Radius", words), Some("radius"));
        assert_eq!(nearest("colour", words), None);
        assert_eq!(nearest("", words), None);
    }
}
