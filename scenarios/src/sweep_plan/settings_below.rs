//! Settings below a path.

use crate::tree::{TomlNode, TomlValue};

/// The paths of the settings that a value at a path states.
pub(super) fn leaves(path: &str, value: &TomlNode) -> Vec<String> {
    match &value.value {
        TomlValue::Table(table) if !table.is_empty() => {
            table.iter().flat_map(|(key, entry)| leaves(&format!("{path}.{key}"), &entry.node)).collect()
        }
        _ => vec![path.to_owned()],
    }
}

/// Whether a path is another or goes on below it.
pub(super) fn is_within(above: &str, path: &str) -> bool {
    path.strip_prefix(above).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}
