//! Scaled defaults of the schema, for keys that a table does not state.

use serde_json::{Map, Value as Json};

use super::similarity::factor;
use crate::format::json_schema::SchemaNode;

/// Writes the scaled default of every key that a table does not state, including tables below it. A table whose `kind` is
/// open is left as it is.
pub(super) fn fill(schema: SchemaNode, table: &mut Map<String, Json>, scale: f64) {
    let of_kind = |kind: &str| schema.of_kind(kind);
    let schema = match (schema.kinds().is_empty(), table.get("kind").and_then(Json::as_str).and_then(of_kind)) {
        (true, _) => schema,
        (false, Some(schema)) => schema,
        (false, None) => return,
    };
    for (key, property) in schema.properties() {
        fill_key(key, property, table, scale);
    }
}

pub(super) fn fill_key(key: &str, property: SchemaNode, table: &mut Map<String, Json>, scale: f64) {
    match (table.get_mut(key), property.default()) {
        (Some(Json::Object(below)), _) if !property.holds_paths() => fill(property, below, scale),
        (Some(_), _) | (None, None) => {}
        (None, Some(default)) => {
            table.insert(key.to_owned(), scaled(property, default, scale));
        }
    }
}

/// A value with each number scaled by its unit.
pub(super) fn scaled(schema: SchemaNode, value: &Json, scale: f64) -> Json {
    match value {
        Json::Number(number) => {
            let unit = schema.keyword("x-unit").and_then(Json::as_str);
            let scaled = number.as_f64().zip(unit).map(|(number, unit)| number * factor(unit, scale));
            scaled.map_or_else(|| value.clone(), Json::from)
        }
        Json::Object(below) => {
            let kind = below.get("kind").and_then(Json::as_str).and_then(|kind| schema.of_kind(kind));
            let schema = kind.unwrap_or(schema);
            let entry = |(key, value): (&String, &Json)| {
                let property = schema.property(key);
                (key.clone(), property.map_or_else(|| value.clone(), |property| scaled(property, value, scale)))
            };
            Json::Object(below.iter().map(entry).collect())
        }
        Json::Null | Json::Bool(_) | Json::String(_) | Json::Array(_) => value.clone(),
    }
}
