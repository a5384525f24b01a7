//! Pieces of XML.

use std::collections::BTreeSet;
use std::fmt::Write;

use interplay_planners::State;

/// Decimal places of lengths \[m\] and angles \[rad\].
const DIGITS: i32 = 6;

/// A number as it is written.
pub(super) fn number(value: f64) -> f64 {
    let factor = 10_f64.powi(DIGITS);
    let rounded = (factor * value).round() / factor;
    // Write `0` instead of `-0`.
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// A text without characters that XML reserves or forbids.
pub(super) fn escaped(text: &str) -> String {
    let mut written = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '<' => written.push_str("&lt;"),
            '>' => written.push_str("&gt;"),
            '&' => written.push_str("&amp;"),
            '"' => written.push_str("&quot;"),
            letter if letter.is_control() => written.push(' '),
            letter => written.push(letter),
        }
    }
    written
}

pub(super) fn point([x_m, y_m]: [f64; 2]) -> String {
    format!("<point><x>{}</x><y>{}</y></point>", number(x_m), number(y_m))
}

/// A state at a step of time, without the element around it.
pub(super) fn state(state: &State, place: [f64; 2], time: i64) -> String {
    let [heading_rad, speed_mps] = [state.heading_rad, state.speed_mps].map(number);
    format!(
        "<position>{}</position><orientation><exact>{heading_rad}</exact></orientation><time><exact>{time}</exact></time>\
         <velocity><exact>{speed_mps}</exact></velocity>",
        point(place)
    )
}

/// A bound of a lanelet.
pub(super) fn bound(name: &str, points: &[[f64; 2]]) -> String {
    let mut written = format!("    <{name}>\n");
    for place in points {
        // Writing to a text cannot fail.
        let _ = writeln!(written, "      {}", point(*place));
    }
    let _ = writeln!(written, "    </{name}>");
    written
}

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
    fn xml_texts_are_escaped_and_numbers_short() {
        assert_eq!(escaped("a<b & \"c\"\u{0}"), "a&lt;b &amp; &quot;c&quot; ");
        assert_eq!([number(-1e-9), number(1.234_567_89)].map(|value| value.to_string()), ["0", "1.234568"]);
    }

    #[test]
    fn ids_are_unique_and_as_requested_if_free() {
        let mut ids = Ids::taken([3, 7].into_iter());
        assert_eq!([ids.give(Some(5)), ids.give(Some(3)), ids.give(None)], [5, 8, 9]);
        assert_eq!(Ids::default().give(None), FIRST);
        assert_eq!(["car-12", "l3", "a2b", "front"].map(number_in), [Some(12), Some(3), None, None]);
    }
}
