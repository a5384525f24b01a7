//! Suggests the known word that an unknown one was probably meant to be, for errors about keys, names and words.

/// The candidate with the fewest edits from `word`, if they are few enough for a typing error.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // A word of this length is not a misspelling, and computing the distance would take long.
    if word.len() > 100 {
        return None;
    }
    // A word in different case, such as `IDM` for `idm`, is the same word.
    let lower = word.to_lowercase();
    let scored =
        candidates.into_iter().map(|candidate| (strsim::osa_distance(&lower, &candidate.to_lowercase()), candidate));
    let (edits, best) = scored.min_by_key(|(edits, _)| *edits)?;
    let tolerated = 1 + word.len().max(best.len()) / 3;
    (edits <= tolerated && edits < best.len()).then_some(best)
}

/// `did you mean …?` if a candidate is similar, otherwise the list of all candidates.
pub fn suggestion(word: &str, what: &str, candidates: &[impl AsRef<str>]) -> String {
    match nearest(word, candidates.iter().map(AsRef::as_ref)) {
        Some(best) => format!("did you mean `{best}`?"),
        None => format!("{what}: {}", listed(candidates)),
    }
}

/// A number of things, such as `1 zone` or `3 zones`.
pub fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// The words in backticks, separated by commas.
pub fn listed(words: &[impl AsRef<str>]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{}`", word.as_ref())).collect();
    quoted.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspelt_words_are_corrected_and_unrelated_words_are_not() {
        assert_eq!(nearest("sped_mps", ["speed_mps", "x_m"]), Some("speed_mps"));
        assert_eq!(nearest("fornt", ["front", "rear"]), Some("front"));
        assert_eq!(nearest("IDM", ["human", "idm", "game"]), Some("idm"), "capitals are no edits");
        assert_eq!(nearest("elephant", ["x_m", "y_m"]), None);
        assert_eq!(nearest("a", ["x"]), None);
        assert_eq!(nearest("anything", []), None);
    }
}
