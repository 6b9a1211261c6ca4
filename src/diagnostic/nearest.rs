//! Finds the word that was probably meant.

/// The longest word that is compared: nobody types longer names.
const MAX_LENGTH: usize = 64;

/// The candidate nearest to an unknown word, if one is near enough.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = word.to_lowercase();
    let distance = |candidate: &str| strsim::damerau_levenshtein(&folded, &candidate.to_lowercase());
    // A third of the letters may differ, as in rustc; of two letters, one.
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
