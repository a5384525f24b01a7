//! Unique ids of elements.

use std::collections::BTreeSet;

/// Ids that are taken.
#[derive(Clone, Debug, Default)]
pub(super) struct Ids(BTreeSet<u64>);

/// The first id of an element without its own.
const FIRST: u64 = 1;

impl Ids {
    /// The ids in a file.
    pub(super) fn taken(ids: impl Iterator<Item = u64>) -> Ids {
        Ids(ids.collect())
    }

    /// Returns the wanted id if it is free, otherwise one above all others.
    pub(super) fn give(&mut self, wanted: Option<u64>) -> u64 {
        let free = || self.0.last().map_or(FIRST, |last| last.saturating_add(1));
        let id = wanted.filter(|id| *id > 0 && !self.0.contains(id)).unwrap_or_else(free);
        self.0.insert(id);
        id
    }
}

/// The number at the end of a name, as in `car-12` and `l12`.
pub(super) fn number_in(name: &str) -> Option<u64> {
    let digits = name.trim_start_matches(|letter: char| !letter.is_ascii_digit());
    let last = name.rsplit(|letter: char| !letter.is_ascii_digit()).next().filter(|last| !last.is_empty());
    last.unwrap_or(digits).parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_unique_and_as_requested_if_free() {
        let mut ids = Ids::taken([3, 7].into_iter());
        assert_eq!([ids.give(Some(5)), ids.give(Some(3)), ids.give(None)], [5, 8, 9]);
        assert_eq!(Ids::default().give(None), FIRST);
        assert_eq!(["car-12", "l3", "a2b", "front"].map(number_in), [Some(12), Some(3), None, None]);
    }
}
