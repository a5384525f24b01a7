//! `[defaults]`: keys for all vehicles of a file, merged under each of them.

use crate::format::json_schema::SchemaNode;
use crate::format::read::merge::merge_tables;
use crate::format::read::tree::{Table, TomlNode, TomlValue};
use crate::resolve::check::shape;
use crate::text::error::Fault;

/// The tree with `[defaults]` merged under every vehicle. The table itself stays.
///
/// # Errors
/// The faults of `[defaults]`, once instead of once for every vehicle.
pub(crate) fn with_defaults(mut tree: TomlNode, schema: SchemaNode) -> Result<TomlNode, Vec<Fault>> {
    let TomlValue::Table(root) = &mut tree.value else { return Ok(tree) };
    let Some(defaults) = root.get("defaults").map(|entry| entry.node.clone()) else { return Ok(tree) };
    let faults = shape::check_table(&defaults, "defaults", schema);
    if !faults.is_empty() {
        return Err(faults);
    }
    let TomlValue::Table(defaults) = defaults.value else { return Ok(tree) };
    let schema = schema.property("vehicle").and_then(SchemaNode::entries);
    let Some(TomlValue::Array(vehicles)) = root.get_mut("vehicle").map(|entry| &mut entry.node.value) else {
        return Ok(tree);
    };
    for vehicle in vehicles {
        if let TomlValue::Table(own) = &mut vehicle.value {
            let under = fitting(defaults.clone(), own);
            *own = merge_tables(schema, under, std::mem::take(own));
        }
    }
    Ok(tree)
}

/// The defaults for a vehicle: without a driver of another kind than its own.
fn fitting(mut defaults: Table, vehicle: &Table) -> Table {
    let kind = |table: &Table| Some(table.get("driver")?.node.table()?.get("kind")?.node.text()?.to_owned());
    if kind(vehicle).is_some_and(|own| kind(&defaults).is_some_and(|other| other != own)) {
        defaults.remove("driver");
    }
    defaults
}
