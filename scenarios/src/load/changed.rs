//! The tree of the scenario that is run for a counterfactual.
//!
//! It is the tree of the scenario itself, including what it extends and the flags, changed by `planner` and then by `set`,
//! with the counterfactual's expectations in place of its own. It is then checked like any other.

use std::sync::Arc;

use crate::format::json_schema::SchemaNode;
use crate::format::read::overrides::{lay_paths, lay_planner};
use crate::format::read::tree::{Table, TomlEntry, TomlNode, TomlValue};
use crate::format::registry::Registry;
use crate::model::scenario::Scenario;
use crate::text::error::{Document, Fault, Place};

/// The rank of a counterfactual's keys: like a flag, they are blamed before the file that they change.
const RANK: usize = 0;

/// The tree of a counterfactual; `stated` is its table and `schema` that of a whole scenario.
///
/// # Errors
/// For paths that do not exist, and for keys that a counterfactual cannot change.
pub(crate) fn tree(of: &TomlNode, stated: &Table, schema: SchemaNode) -> Result<TomlNode, Vec<Fault>> {
    let TomlValue::Table(root) = &of.value else { return Ok(of.clone()) };
    let mut root = root.clone();
    for key in ["counterfactual", "expect", "figure"] {
        root.remove(key);
    }
    let stated = ranked_table(stated.clone(), &mut Vec::new());
    if let Some(planner) = stated.get("planner") {
        if !root.contains_key("vehicle") {
            let fault = Fault::at(&planner.key, "for vehicles only", "`planner` is stated, but there are no vehicles");
            return Err(vec![fault]);
        }
        lay_planner(&mut root, planner.node.clone(), schema).map_err(|fault| vec![fault])?;
    }
    if let Some(TomlValue::Table(set)) = stated.get("set").map(|entry| entry.node.value.clone()) {
        let faults: Vec<Fault> = set.iter().filter_map(|(key, entry)| refused(key, entry)).collect();
        let faults = if faults.is_empty() { lay_paths(&mut root, set, schema) } else { faults };
        if !faults.is_empty() {
            return Err(faults);
        }
    }
    if let Some(expect) = stated.get("expect") {
        root.insert("expect".to_owned(), without_comparisons(expect.clone(), schema));
    }
    Ok(TomlNode { place: of.place.clone(), value: TomlValue::Table(root) })
}

/// The faults of the counterfactuals of a scenario that cannot be run: those of their own keys, and none of the scenario's.
/// `assemble` makes a scenario from a tree.
pub(super) fn faults(
    registry: &Registry,
    of: &TomlNode,
    assemble: impl Fn(&TomlNode) -> Result<Scenario, Vec<Fault>>,
) -> Vec<Fault> {
    let Some(TomlValue::Array(stated)) = of.at("counterfactual").map(|node| &node.value) else { return Vec::new() };
    let mut own = Vec::new();
    for node in stated {
        let (Some(table), file) = (node.table(), &node.place.document.name) else { continue };
        let run = tree(of, table, registry.complete()).and_then(|changed| assemble(&changed));
        let is_own = |fault: &Fault| {
            fault.place().is_some_and(|place| place.document.rank == RANK && place.document.name == *file)
        };
        let name = node.label().unwrap_or_default();
        let found = run.err().into_iter().flatten().filter(is_own);
        own.extend(found.map(|fault| fault.in_counterfactual(name)));
    }
    own
}

/// A fault if `set` changes a key that is not a condition of a run.
fn refused(key: &str, entry: &TomlEntry) -> Option<Fault> {
    let first = key.split('.').next().unwrap_or_default().trim();
    let help = match first {
        "expect" => "state what is expected of a counterfactual in its `[counterfactual.expect]`",
        "counterfactual" => "write another `[[counterfactual]]`",
        "extends" => "write a scenario of its own that extends the other file",
        _ => return None,
    };
    Some(Fault::at(&entry.key, "cannot be changed", format!("a counterfactual cannot change `{first}`")).help(help))
}

/// The keys of expectations that any run may have.
fn without_comparisons(mut expect: TomlEntry, schema: SchemaNode) -> TomlEntry {
    let known = schema.property("expect");
    if let TomlValue::Table(table) = &mut expect.node.value {
        table.retain(|key, _| known.and_then(|known: SchemaNode| known.property(key)).is_some());
    }
    expect
}

/// The same table in documents of the rank of a counterfactual; `documents` are those made so far, each with its original.
fn ranked_table(table: Table, documents: &mut Vec<[Arc<Document>; 2]>) -> Table {
    let mut ranked_entry = |entry: TomlEntry| TomlEntry {
        key: ranked_place(&entry.key, documents),
        node: ranked_node(entry.node, documents),
    };
    table.into_iter().map(|(key, entry)| (key, ranked_entry(entry))).collect()
}

fn ranked_node(node: TomlNode, documents: &mut Vec<[Arc<Document>; 2]>) -> TomlNode {
    let place = ranked_place(&node.place, documents);
    let value = match node.value {
        TomlValue::Table(table) => TomlValue::Table(ranked_table(table, documents)),
        TomlValue::Array(items) => {
            TomlValue::Array(items.into_iter().map(|item| ranked_node(item, documents)).collect())
        }
        other => other,
    };
    TomlNode { place, value }
}

fn ranked_place(place: &Place, documents: &mut Vec<[Arc<Document>; 2]>) -> Place {
    let known = documents.iter().find(|[original, _]| Arc::ptr_eq(original, &place.document));
    let document = match known {
        Some([_, ranked]) => Arc::clone(ranked),
        None => {
            let ranked = place.document.ranked(RANK);
            documents.push([Arc::clone(&place.document), Arc::clone(&ranked)]);
            ranked
        }
    };
    Place { document, span: place.span.clone() }
}
