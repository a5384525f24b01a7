//! A replacement of a plan's number of samples.

use crate::format::read::tree::{TomlEntry, TomlNode, TomlValue};
use crate::text::error::{Document, Place};

/// The key of a plan that states its number of samples.
const KEY: &str = "samples";

/// Replaces the number of samples of a plan by that of the flag `--samples`, which errors then name. Returns the text of the
/// plan with only this number changed.
///
/// A table in place of the number is kept: the check refuses it.
pub(super) fn replace(tree: &mut TomlNode, text: &str, samples: u64) -> String {
    let TomlValue::Table(root) = &mut tree.value else { return text.to_owned() };
    let written = samples.to_string();
    let whole = Place::new(&Document::new("--samples", &written, 0), 0..written.len());
    let node = TomlNode { place: whole.clone(), value: TomlValue::Integer(i128::from(samples)) };
    match root.get_mut(KEY) {
        Some(entry) if entry.node.table().is_some() => text.to_owned(),
        Some(entry) => {
            let span = entry.node.place.span.clone();
            entry.node = node;
            match (text.get(..span.start), text.get(span.end..)) {
                (Some(before), Some(behind)) => format!("{before}{written}{behind}"),
                _ => text.to_owned(),
            }
        }
        None => {
            root.insert(KEY.to_owned(), TomlEntry { key: whole, node });
            // The key is added at the beginning, because at the end it would belong to a table. A byte-order mark stays first.
            let (mark, rest) = text.strip_prefix('\u{feff}').map_or(("", text), |rest| ("\u{feff}", rest));
            format!("{mark}{KEY} = {written} # --samples\n{rest}")
        }
    }
}
