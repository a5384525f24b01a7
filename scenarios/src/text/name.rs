//! The form of a name, which becomes part of paths: of recordings, and of `--set`.
//!
//! It is stated here once. The schema's pattern, the check and the words of an error follow from it.

use std::ops::RangeInclusive;

/// The name that makes a vehicle the ego.
pub(crate) const EGO: &str = "ego";

/// The characters of a name, and what they are called.
const CHARACTERS: [(RangeInclusive<char>, &str); 4] =
    [('a'..='z', "lower-case letters"), ('0'..='9', "digits"), ('_'..='_', "`_`"), ('-'..='-', "`-`")];

/// How many characters a name has at most; it has at least one.
const MAX_CHARACTERS: usize = 64;

pub(crate) fn is_name(text: &str) -> bool {
    let fits = |character: char| CHARACTERS.iter().any(|(range, _)| range.contains(&character));
    (1..=MAX_CHARACTERS).contains(&text.chars().count()) && text.chars().all(fits)
}

/// The form as a regular expression, for the schema.
pub(crate) fn pattern() -> String {
    let written = |(range, _): &(RangeInclusive<char>, &str)| match (range.start(), range.end()) {
        (first, last) if first == last => first.to_string(),
        (first, last) => format!("{first}-{last}"),
    };
    let class: String = CHARACTERS.iter().map(written).collect();
    format!("^[{class}]{{1,{MAX_CHARACTERS}}}$")
}

/// The form in words, for errors.
pub(crate) fn in_words() -> String {
    let [most @ .., last] = CHARACTERS.map(|(_, words)| words);
    format!("a name has 1 to {MAX_CHARACTERS} {} or {last}", most.join(", "))
}

/// Whether a name fits a pattern, in which `*` stands for any characters but `/`.
pub(crate) fn fits(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((start, rest)) => name.strip_prefix(start).is_some_and(|name| {
            let reach = name.find('/').unwrap_or(name.len());
            (0..=reach).any(|end| name.is_char_boundary(end) && fits(rest, &name[end..]))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_pattern_its_description_and_its_check_agree() {
        assert_eq!(pattern(), "^[a-z0-9_-]{1,64}$");
        assert_eq!(in_words(), "a name has 1 to 64 lower-case letters, digits, `_` or `-`");
        for name in ["ego", "front-2", "_", &"a".repeat(64)] {
            assert!(is_name(name), "{name}");
        }
        for other in ["", "Ego", "a b", "ä", "a.b", "a{", &"a".repeat(65)] {
            assert!(!is_name(other), "{other}");
        }
    }

    #[test]
    fn a_star_in_a_pattern_matches_any_part_of_a_name() {
        for (pattern, name, expected) in [
            ("lane-change/*", "lane-change/front-nice", true),
            ("*/nice", "intersection/nice", true),
            ("*/nice", "lane-change/front-nice", false),
            ("*nice", "intersection/nice", false),
            ("*/*-nice", "lane-change/front-nice", true),
            ("lane-change", "lane-change/front-nice", false),
        ] {
            assert_eq!(fits(pattern, name), expected, "{pattern} {name}");
        }
    }
}
