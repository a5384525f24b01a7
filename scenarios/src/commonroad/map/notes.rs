//! What could not be carried over, a line for each kind of thing.

/// Lines on what differs from the imported file, in the order in which they came up.
#[derive(Debug, Default)]
pub(in crate::commonroad) struct Notes(Vec<Note>);

#[derive(Debug)]
struct Note {
    count: usize,
    /// What it is, of one and of several.
    what: [String; 2],
    /// What became of it.
    fate: String,
}

impl Notes {
    /// Counts one more thing; `what` is its word for one and for several.
    pub(super) fn one(&mut self, what: [&str; 2], fate: &str) {
        self.several(1, what, fate);
    }

    /// Counts some more of them; nothing where there are none.
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

/// What becomes of things that a scenario has no words for yet.
pub(super) const NOT_YET: &str = "not carried over yet";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_things_are_counted_in_one_line() {
        let mut notes = Notes::default();
        notes.several(0, ["sign", "signs"], NOT_YET);
        notes.one(["light", "lights"], NOT_YET);
        notes.several(2, ["light", "lights"], NOT_YET);
        notes.one(["loop", "loops"], "opened");
        assert_eq!(notes.lines(), ["3 lights: not carried over yet", "1 loop: opened"]);
    }
}
