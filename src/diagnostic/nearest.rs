//! Finds the known word that a user probably meant by an unknown word.

/// The maximum length, in characters, of an unknown word for which a similar word is searched. It limits the cost; real names are shorter.
const MAX_LENGTH: usize = 64;

/// Returns the candidate with the smallest edit distance from an unknown word. `None` if all candidates are too different.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = word.to_lowercase();
    let distance = |candidate: &str| strsim::damerau_levenshtein(&folded, &candidate.to_lowercase());
    // As in rustc, up to a third of the letters may differ, or one letter in a word of fewer than three letters.
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
