//! The parts that could not be carried over, one line for each kind.

use std::collections::BTreeSet;

use crate::text::name::{EGO, is_name};

/// Lines on differences from the imported file, in the order in which they were found.
#[derive(Debug, Default)]
pub(in crate::commonroad) struct Notes(Vec<Note>);

#[derive(Debug)]
struct Note {
    count: usize,
    /// The name of the part, singular and plural.
    what: [String; 2],
    /// What was done with it.
    fate: String,
}

impl Notes {
    /// Counts one more part; `what` is its name, singular and plural.
    pub(super) fn one(&mut self, what: [&str; 2], fate: &str) {
        self.several(1, what, fate);
    }

    /// Counts `count` more parts; zero adds no line.
    pub(super) fn several(&mut self, count: usize, what: [&str; 2], fate: &str) {
        let known = self.0.iter_mut().find(|note| note.what == what && note.fate == fate);
        match known {
            Some(note) => note.count += count,
            None if count == 0 => {}
            None => self.0.push(Note { count, what: what.map(str::to_owned), fate: fate.to_owned() }),
        }
    }

    /// The lines: `12 traffic lights: not carried over yet`.
    pub(in crate::commonroad) fn lines(&self) -> Vec<String> {
        let line = |Note { count, what: [one, several], fate }: &Note| {
            format!("{count} {}: {fate}", if *count == 1 { one } else { several })
        };
        self.0.iter().map(line).collect()
    }
}

/// The note for parts that a scenario cannot state yet.
pub(super) const NOT_YET: &str = "not carried over yet";

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
    fn equal_import_notes_are_counted_in_one_line() {
        let mut notes = Notes::default();
        notes.several(0, ["sign", "signs"], NOT_YET);
        notes.one(["light", "lights"], NOT_YET);
        notes.several(2, ["light", "lights"], NOT_YET);
        notes.one(["loop", "loops"], "opened");
        assert_eq!(notes.lines(), ["3 lights: not carried over yet", "1 loop: opened"]);
    }

    #[test]
    fn imported_names_are_valid_and_unique() {
        let mut names = Names::default();
        assert_eq!(names.name("l", "12"), "l12");
        assert_eq!(names.name("l", "12"), "l12-2");
        assert_eq!(names.name("", "ego"), "ego-2");
        assert_eq!(names.name("car-", "A b/ü\u{1f}"), "car-a-b---");
    }
}
