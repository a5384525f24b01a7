//! How a file is laid over the one that it extends, and a flag over the file.
//!
//! Tables merge key by key, the later one winning; lists are replaced, except `[[vehicle]]`, whose entries merge by
//! `name`. Two rules keep a variant from having to undo its parent: where a table names another `kind`, the keys that this
//! kind does not know are dropped, and of two keys that exclude each other the later one removes the earlier.

use crate::schema;
use crate::tree::{Entry, Node, Table, Value};

/// Keys of which only one may be present.
const EXCLUSIVE: [(&str, &str); 6] = [
    ("lane", "y_m"),
    ("style", "safety_weight"),
    ("preset", "grid"),
    ("preset", "zone"),
    ("grid", "zone"),
    ("no_collision", "collisions"),
];

/// Lays one table over another.
pub(crate) fn merge_tables(mut under: Table, over: Table) -> Table {
    if let Some(new) = kind(&over).filter(|new| kind(&under) != Some(new)) {
        let known: Vec<&str> = schema::keys_of_kind(new).into_iter().flatten().collect();
        under.retain(|key, _| known.contains(&key.as_str()));
    }
    for (one, other) in EXCLUSIVE.iter().flat_map(|(a, b)| [(a, b), (b, a)]) {
        if over.contains_key(*one) && !over.contains_key(*other) {
            under.remove(*other);
        }
    }
    for (key, entry) in over {
        let merged = match under.remove(&key) {
            Some(below) => Entry { key: entry.key, node: merge_nodes(&key, below.node, entry.node) },
            None => entry,
        };
        under.insert(key, merged);
    }
    under
}

fn kind(table: &Table) -> Option<&str> {
    table.get("kind")?.node.text()
}

fn merge_nodes(key: &str, under: Node, over: Node) -> Node {
    let value = match (under.value, over.value) {
        (Value::Table(under), Value::Table(over)) => Value::Table(merge_tables(under, over)),
        (Value::Array(under), Value::Array(over)) if key == "vehicle" => Value::Array(merge_named(under, over)),
        (_, over) => over,
    };
    Node { place: over.place, value }
}

/// Lays lists of named tables over each other. A second entry of the same name is kept, for the check to refuse.
fn merge_named(under: Vec<Node>, over: Vec<Node>) -> Vec<Node> {
    let mut merged: Vec<Option<Node>> = under.into_iter().map(Some).collect();
    let mut laid_over = vec![false; merged.len()];
    for node in over {
        let same_name =
            |below: &Option<Node>| below.as_ref().and_then(Node::label).is_some_and(|name| Some(name) == node.label());
        match merged[..laid_over.len()].iter().position(same_name) {
            Some(at) if !laid_over[at] => {
                laid_over[at] = true;
                let below = merged[at].take();
                merged[at] = below.map(|below| merge_nodes("", below, node));
            }
            _ => merged.push(Some(node)),
        }
    }
    merged.into_iter().flatten().collect()
}
