//! Names of lanes and vehicles from the ids of the imported file.

use std::collections::BTreeSet;

use crate::text::name::{EGO, is_name};

/// The names in use. Ids may be any text; names use few characters and are unique.
#[derive(Debug, Default)]
pub(super) struct Names(BTreeSet<String>);

/// The most characters of an id that become part of a name.
const MAX_ID: usize = 40;

impl Names {
    /// A new name from a word and an id.
    pub(super) fn name(&mut self, word: &str, id: &str) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() || c == '_' { c.to_ascii_lowercase() } else { '-' };
        let id: String = id.chars().take(MAX_ID).map(plain).collect();
        let wanted = format!("{word}{id}");
        let numbered = (2..).map(|number| format!("{wanted}-{number}"));
        let mut names = [wanted.clone()].into_iter().chain(numbered);
        let free = names.find(|name| name != EGO && !self.0.contains(name)).unwrap_or(wanted);
        debug_assert!(is_name(&free), "{free}");
        self.0.insert(free.clone());
        free
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imported_names_are_valid_and_unique() {
        let mut names = Names::default();
        assert_eq!(names.name("l", "12"), "l12");
        assert_eq!(names.name("l", "12"), "l12-2");
        assert_eq!(names.name("", "ego"), "ego-2");
        assert_eq!(names.name("car-", "A b/ü\u{1f}"), "car-a-b---");
    }
}
