//! Merging of a file with the one that it extends, and of a flag with the file.
//!
//! Tables merge key by key, and the later value wins; lists are replaced, except those whose schema names a key to merge by
//! (`[[vehicle]]`: `name`). Two rules save a variant from undoing its parent: if a table names another `kind`, keys unknown to this kind
//! are dropped; and of two keys that exclude each other, the later one removes the earlier one.

use crate::format::json_schema::SchemaNode;
use crate::format::read::tree::{Table, TomlEntry, TomlNode, TomlValue};

/// Merges `over` into `under`, key by key; `schema` describes the table, if the format knows it.
pub(crate) fn merge_tables(schema: Option<SchemaNode>, mut under: Table, over: Table) -> Table {
    if let Some(new) = kind(&over).filter(|new| kind(&under) != Some(new)) {
        let table = schema.and_then(|table| table.of_kind(new));
        under.retain(|key, _| table.is_some_and(|table| table.property(key).is_some()));
    }
    let own_kind = kind(&over).or(kind(&under));
    let table = schema.map(|table| own_kind.and_then(|kind| table.of_kind(kind)).unwrap_or(table));
    for (one, other) in table.into_iter().flat_map(SchemaNode::exclusions).flat_map(|(a, b)| [(a, b), (b, a)]) {
        if over.contains_key(one) && !over.contains_key(other) {
            under.remove(other);
        }
    }
    for (key, entry) in over {
        let property = table.and_then(|table| table.property(&key));
        let merged = match under.remove(&key) {
            Some(below) => TomlEntry { key: entry.key, node: merge_nodes(property, below.node, entry.node) },
            None => entry,
        };
        under.insert(key, merged);
    }
    under
}

fn kind(table: &Table) -> Option<&str> {
    table.get("kind")?.node.text()
}

fn merge_nodes(schema: Option<SchemaNode>, under: TomlNode, over: TomlNode) -> TomlNode {
    let merge_key = schema.and_then(SchemaNode::merge_key);
    let value = match (under.value, over.value, merge_key) {
        (TomlValue::Table(under), TomlValue::Table(over), _) => TomlValue::Table(merge_tables(schema, under, over)),
        (TomlValue::Array(under), TomlValue::Array(over), Some(key)) => {
            TomlValue::Array(merge_entries(schema.and_then(SchemaNode::entries), key, under, over))
        }
        (_, over, _) => over,
    };
    TomlNode { place: over.place, value }
}

/// Merges two lists of tables, entries with the same value of `key` together. A second such entry is kept, for the
/// check to refuse.
fn merge_entries(schema: Option<SchemaNode>, key: &str, under: Vec<TomlNode>, over: Vec<TomlNode>) -> Vec<TomlNode> {
    let name = |node: &TomlNode| Some(node.table()?.get(key)?.node.text()?.to_owned());
    let mut merged: Vec<Option<TomlNode>> = under.into_iter().map(Some).collect();
    let mut laid_over = vec![false; merged.len()];
    for node in over {
        let same_name = |below: &Option<TomlNode>| {
            let below = below.as_ref().and_then(name);
            below.is_some() && below == name(&node)
        };
        match merged[..laid_over.len()].iter().position(same_name) {
            Some(at) if !laid_over[at] => {
                laid_over[at] = true;
                let below = merged[at].take();
                merged[at] = below.map(|below| merge_nodes(schema, below, node));
            }
            _ => merged.push(Some(node)),
        }
    }
    merged.into_iter().flatten().collect()
}
