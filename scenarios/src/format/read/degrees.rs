//! Angles in files are degrees: `steering_max_deg`. Scenarios hold radians.
//!
//! Each key of the schema that ends with `_rad` has a twin that ends with `_deg`, unless the format already has that key. The twin is an
//! ordinary key of the file; before a scenario is made from the file, its value replaces that of the key in radians. Keys in radians are
//! accepted for one more version, with a remark that states the replacement. Some angles equal no number of degrees bit for bit; these
//! are written and read in radians without a remark, so that a written drive is the same drive.

use serde_json::{Map, Value as Json, json};

use crate::format::json_schema::{SchemaNode, TWIN_OF, in_degrees, rounded};
use crate::format::read::tree::{TomlNode, TomlValue};
use crate::text::error::Fault;

/// A change of a table that its schema describes.
type TableChange<'a> = &'a dyn Fn(SchemaNode, &mut Map<String, Json>);

/// Changes every table of a value, the outer ones first.
fn change_tables(schema: SchemaNode, value: &mut Json, change: TableChange<'_>) {
    match value {
        Json::Object(table) => change_table(schema, table, change),
        Json::Array(items) => {
            if let Some(schema) = schema.entries() {
                items.iter_mut().for_each(|item| change_tables(schema, item, change));
            }
        }
        Json::Null | Json::Bool(_) | Json::Number(_) | Json::String(_) => {}
    }
}

/// Changes a table, and every one in it.
fn change_table(schema: SchemaNode, table: &mut Map<String, Json>, change: TableChange<'_>) {
    let kind = table.get("kind").and_then(Json::as_str).and_then(|kind| schema.of_kind(kind));
    let schema = kind.unwrap_or(schema);
    change(schema, table);
    for (key, property) in schema.properties() {
        if let Some(below) = table.get_mut(key) {
            change_tables(property, below, change);
        }
    }
}

/// Replaces the degrees of every twin by radians.
pub(crate) fn to_radians(schema: SchemaNode, value: &mut Json) {
    change_tables(schema, value, &|schema, table| {
        for (key, property) in schema.properties() {
            let radians = property.keyword(TWIN_OF).and_then(Json::as_str);
            if let Some((radians, stated)) = radians.zip(table.get(key)) {
                let angle = stated.as_f64().map(f64::to_radians);
                table.remove(key);
                table.insert(radians.to_owned(), json!(angle));
            }
        }
    });
}

/// Replaces radians by degrees, wherever a number of degrees gives the same angle to the last bit.
pub(crate) fn to_degrees(schema: SchemaNode, table: &mut Map<String, Json>) {
    change_table(schema, table, &|schema, table| {
        for (key, _) in schema.properties().filter(|(_, property)| property.is_deprecated()) {
            let degrees = table.get(key).and_then(Json::as_f64).and_then(exact);
            if let Some((twin, degrees)) = in_degrees(key).zip(degrees) {
                table.remove(key);
                table.insert(twin, json!(degrees));
            }
        }
    });
}

/// The shortest number of degrees that gives this angle to the last bit; `None` for about one angle in ten.
fn exact(radians: f64) -> Option<f64> {
    let nearest = radians.to_degrees();
    let neighbours = [nearest, nearest.next_up(), nearest.next_down()];
    let mut all = std::iter::once(rounded(nearest)).chain(neighbours);
    all.find(|degrees| degrees.to_radians().to_bits() == radians.to_bits())
}

/// A remark for each key in radians that is stated, with the value in degrees.
pub(crate) fn remarks(tree: &TomlNode, schema: SchemaNode) -> Vec<Fault> {
    let mut found = Vec::new();
    collect(schema, tree, &mut found);
    found
}

fn collect(schema: SchemaNode, node: &TomlNode, found: &mut Vec<Fault>) {
    match &node.value {
        TomlValue::Table(table) => {
            let kind = table.get("kind").and_then(|entry| entry.node.text()).and_then(|kind| schema.of_kind(kind));
            let schema = kind.unwrap_or(schema);
            for (key, entry) in table {
                let Some(property) = schema.property(key) else { continue };
                let radians = entry.node.to_json().as_f64();
                let radians = radians.filter(|radians| exact(*radians).is_some());
                if let (true, Some(twin), Some(radians)) = (property.is_deprecated(), in_degrees(key), radians) {
                    let message = format!("`{key}` is in radians, which the next version will refuse");
                    let help = format!("write `{twin} = {}`", rounded(radians.to_degrees()));
                    found.push(Fault::at(&entry.key, "in radians", message).help(help));
                } else {
                    collect(property, &entry.node, found);
                }
            }
        }
        TomlValue::Array(items) => {
            if let Some(schema) = schema.entries() {
                items.iter().for_each(|item| collect(schema, item, found));
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Registry;

    #[test]
    fn keys_in_degrees_replace_keys_in_radians() {
        let mut stated = json!({ "vehicle": [{ "limits": { "steering_max_deg": 30.0 } }] });
        to_radians(Registry::standard().complete(), &mut stated);
        let limits = &stated["vehicle"][0]["limits"];
        assert_eq!(limits, &json!({ "steering_max_rad": 30.0_f64.to_radians() }));
    }

    #[test]
    fn angles_written_in_degrees_read_back_bit_identical() {
        let schema = Registry::standard().complete();
        let angles = (-3000..3000).map(|angle| f64::from(angle) * 0.001_047_197_551).chain([60.0_f64.to_radians()]);
        let mut in_degrees = 0;
        for radians in angles {
            let mut stated = json!({ "vehicle": [{ "limits": { "steering_max_rad": radians } }] });
            to_degrees(schema, stated.as_object_mut().expect("a table"));
            in_degrees += usize::from(stated["vehicle"][0]["limits"]["steering_max_deg"].is_f64());
            to_radians(schema, &mut stated);
            let read = stated["vehicle"][0]["limits"]["steering_max_rad"].as_f64();
            assert_eq!(read.map(f64::to_bits), Some(radians.to_bits()));
        }
        assert!(in_degrees > 5000, "{in_degrees}");
    }
}
