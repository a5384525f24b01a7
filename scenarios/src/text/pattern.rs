//! Patterns of names.

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
