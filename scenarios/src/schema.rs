//! The JSON Schema of a scenario file: what editors complete from, and what the loader checks against.
//!
//! It is generated from [`Scenario`], then tightened by [`BOUNDS`], the ranges within which the planners' own settings
//! make sense, and given the units and examples of [`words`]. [`complete`] describes a whole scenario, all that it extends included. [`schema`] describes one file,
//! which may leave to its parent whatever it does not state.

mod words;

use std::sync::LazyLock;

use schemars::generate::SchemaSettings;
use serde_json::{Map, Value as Json, json};

use crate::Scenario;

/// What a name must look like, since it becomes part of paths.
pub(crate) const NAME_PATTERN: &str = "^[a-z0-9_-]{1,64}$";

/// Keywords of JSON Schema with their bounds.
type Keywords = &'static [(&'static str, f64)];

/// Ranges of the planners' settings: table (a definition, or the kind of a driver), key, bounds. Lengths are at least a
/// millimetre, so that nothing is divided by almost nothing.
const BOUNDS: &[(&str, &str, Keywords)] = &[
    ("Body", "front_m", &[("minimum", 0.001)]),
    ("Body", "rear_m", &[("minimum", 0.001)]),
    ("Body", "width_m", &[("minimum", 0.001)]),
    ("Body", "front_axle_m", &[("minimum", 0.001)]),
    ("Body", "rear_axle_m", &[("minimum", 0.001)]),
    ("SafetyEllipse", "along_m", &[("minimum", 0.001)]),
    ("SafetyEllipse", "across_m", &[("minimum", 0.001)]),
    ("Limits", "acceleration_min_mps2", &[("exclusiveMaximum", 0.0)]),
    ("Limits", "acceleration_max_mps2", &[("exclusiveMinimum", 0.0)]),
    ("Limits", "steering_max_rad", &[("exclusiveMinimum", 0.0), ("maximum", 1.5)]),
    ("Limits", "speed_min_mps", &[("minimum", 0.0)]),
    ("Limits", "speed_max_mps", &[("exclusiveMinimum", 0.0)]),
    ("human", "safety_weight", &[("minimum", 0.0)]),
    ("human", "following_weight", &[("minimum", 0.0)]),
    ("negotiation", "beta", &[("exclusiveMinimum", 0.0), ("exclusiveMaximum", 1.0)]),
    ("negotiation", "gamma", &[("minimum", 0.0)]),
    ("negotiation", "epsilon", &[("minimum", 0.0)]),
    ("negotiation", "patience_steps", &[("minimum", 1.0)]),
    ("negotiation", "clear_lead_m", &[("minimum", 0.0)]),
    ("negotiation", "settled_steps", &[("minimum", 1.0)]),
    ("negotiation", "ego_normaliser", &[("exclusiveMinimum", 0.0)]),
    ("negotiation", "other_normaliser", &[("exclusiveMinimum", 0.0)]),
    ("negotiation", "weight_floor", &[("minimum", 0.0), ("maximum", 1.0)]),
    ("Zone", "capacity_kj_per_k", &[("exclusiveMinimum", 0.0)]),
    ("Zone", "limit_kw", &[("minimum", 0.0)]),
    ("Zone", "solar_aperture_m2", &[("minimum", 0.0)]),
    ("Wall", "resistance_k_per_kw", &[("exclusiveMinimum", 0.0)]),
    ("Wall", "capacity_kj_per_k", &[("exclusiveMinimum", 0.0)]),
];

static COMPLETE: LazyLock<Json> = LazyLock::new(|| {
    let generator = SchemaSettings::draft2020_12().into_generator();
    let mut schema = generator.into_root_schema_for::<Scenario>().to_value();
    for (table, key, bounds) in BOUNDS {
        if let Some(property) = properties_of(&mut schema, table).and_then(|properties| properties.get_mut(*key)) {
            for (keyword, bound) in *bounds {
                property[*keyword] = json!(bound);
            }
        }
    }
    for (table, key, unit) in words::UNITS {
        let property = properties_of(&mut schema, table).and_then(|properties| properties.get_mut(*key));
        if let Some(Json::String(description)) = property.and_then(|property| property.get_mut("description")) {
            *description = format!("{} [{unit}].", description.trim_end_matches('.'));
        }
    }
    for (table, key, example) in words::examples() {
        let property = properties_of(&mut schema, table).and_then(|properties| properties.get_mut(key));
        if let Some(property) = property {
            property["examples"] = json!([example]);
        }
    }
    polish(&mut schema);
    schema
});

/// The schema of a whole scenario, all that it extends included.
pub(crate) fn complete() -> &'static Json {
    &COMPLETE
}

/// The JSON Schema of a scenario file, for editors. A file that extends another need not repeat what that one states.
pub fn schema() -> Json {
    let whole = complete();
    let mut schema = whole.clone();
    let mut required = requirements(whole, whole).unwrap_or_else(|| json!({}));
    drop_requirements(&mut schema);
    if let Some(properties) = schema.get_mut("properties").and_then(Json::as_object_mut) {
        properties.insert("extends".to_owned(), extends());
    }
    required["not"] = json!({ "required": ["extends"] });
    schema["title"] = json!("Interplay scenario");
    schema["anyOf"] = json!([{ "required": ["extends"] }, required]);
    schema
}

fn extends() -> Json {
    json!({
        "type": "string",
        "examples": ["lane-change/front-nice"],
        "description": "Another scenario from which this one differs only in what it states: a file relative to this \
                        one, or the name of an embedded scenario. Tables merge key by key, vehicles by name.",
    })
}

/// The properties of a definition, of the tagged table of that kind, or, without a name, of the file itself.
fn properties_of<'a>(schema: &'a mut Json, table: &str) -> Option<&'a mut Map<String, Json>> {
    if table.is_empty() {
        return schema.get_mut("properties")?.as_object_mut();
    }
    let definitions = schema.get_mut("$defs")?.as_object_mut()?;
    let definition = if definitions.contains_key(table) {
        definitions.get_mut(table)?
    } else {
        let tagged = definitions.values_mut().filter_map(|schema| schema.get_mut("oneOf")?.as_array_mut());
        tagged.flatten().find(|kind| kind_of(kind) == Some(table))?
    };
    definition.get_mut("properties")?.as_object_mut()
}

/// The `kind` that an alternative of a tagged table requires.
pub(crate) fn kind_of(alternative: &Json) -> Option<&str> {
    alternative.get("properties")?.get("kind")?.get("const")?.as_str()
}

/// The keys that a table of this `kind` may have.
pub(crate) fn keys_of_kind(kind: &str) -> Option<impl Iterator<Item = &'static str>> {
    let definitions = complete().get("$defs")?.as_object()?;
    let mut alternatives = definitions.values().filter_map(|schema| schema.get("oneOf")?.as_array()).flatten();
    let alternative = alternatives.find(|one| kind_of(one) == Some(kind))?;
    Some(alternative.get("properties")?.as_object()?.keys().map(String::as_str))
}

/// What `$ref` refers to, if there is one.
pub(crate) fn resolved<'a>(root: &'a Json, schema: &'a Json) -> &'a Json {
    let name = schema.get("$ref").and_then(Json::as_str).and_then(|path| path.strip_prefix("#/$defs/"));
    name.and_then(|name| root.get("$defs")?.get(name)).unwrap_or(schema)
}

/// Makes the schema speak TOML: no nulls, which TOML cannot write; descriptions without the escapes of doc comments, and
/// one for each `kind`.
fn polish(schema: &mut Json) {
    match schema {
        Json::Object(object) => {
            object.retain(|_, value| !value.is_null());
            drop_nothing(object);
            if object.get("properties").is_some_and(Json::is_object) {
                object.entry("additionalProperties").or_insert(json!(false));
            }
            if let Some(Json::String(description)) = object.get_mut("description") {
                *description = description.replace("\\[", "[").replace("\\]", "]").replace('\n', " ");
            }
            if let Some(kind) = object.get_mut("kind").and_then(Json::as_object_mut)
                && kind.contains_key("const")
            {
                kind.entry("description").or_insert_with(|| json!("Chooses what this table describes."));
            }
            object.values_mut().for_each(polish);
        }
        Json::Array(items) => items.iter_mut().for_each(polish),
        _ => {}
    }
}

/// Takes the alternative "null" from a schema: an optional key is one that may be absent.
fn drop_nothing(schema: &mut Map<String, Json>) {
    if let Some(Json::Array(types)) = schema.get_mut("type") {
        types.retain(|word| word != "null");
        if let [only] = types.as_slice() {
            let only = only.clone();
            schema.insert("type".to_owned(), only);
        }
    }
    if let Some(Json::Array(alternatives)) = schema.get_mut("anyOf") {
        alternatives.retain(|one| one.get("type").is_none_or(|word| word != "null"));
        if let [Json::Object(only)] = alternatives.as_slice() {
            let only = only.clone();
            schema.remove("anyOf");
            schema.extend(only);
        }
    }
}

/// The skeleton of a schema: only which keys are required, and of which tables below.
fn requirements(root: &Json, schema: &Json) -> Option<Json> {
    let schema = resolved(root, schema);
    let mut skeleton = Map::new();
    if let Some(required) = schema.get("required") {
        skeleton.insert("required".to_owned(), required.clone());
    } else if schema.as_object().is_some_and(is_tagged) {
        skeleton.insert("required".to_owned(), json!(["kind"]));
    }
    if let Some(properties) = schema.get("properties").and_then(Json::as_object) {
        let below = properties.iter().filter_map(|(key, schema)| Some((key.clone(), requirements(root, schema)?)));
        let below: Map<String, Json> = below.collect();
        if !below.is_empty() {
            skeleton.insert("properties".to_owned(), Json::Object(below));
        }
    }
    if let Some(items) = schema.get("items").and_then(|items| requirements(root, items)) {
        skeleton.insert("items".to_owned(), items);
    }
    (!skeleton.is_empty()).then_some(Json::Object(skeleton))
}

/// Removes `required` everywhere. A tagged table may then leave its `kind` to the parent, so that more than one
/// alternative can fit.
fn drop_requirements(schema: &mut Json) {
    match schema {
        Json::Object(object) => {
            if object.get("required").is_some_and(Json::is_array) {
                object.remove("required");
            }
            if is_tagged(object)
                && let Some(alternatives) = object.remove("oneOf")
            {
                object.insert("anyOf".to_owned(), alternatives);
            }
            object.values_mut().for_each(drop_requirements);
        }
        Json::Array(items) => items.iter_mut().for_each(drop_requirements),
        _ => {}
    }
}

/// Whether a schema describes tables of several kinds.
fn is_tagged(schema: &Map<String, Json>) -> bool {
    let alternatives = schema.get("oneOf").and_then(Json::as_array);
    alternatives.is_some_and(|all| all.iter().any(|one| kind_of(one).is_some()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bound_belongs_to_a_key() {
        let mut schema = complete().clone();
        for (table, key, bounds) in BOUNDS {
            let properties = properties_of(&mut schema, table).unwrap_or_else(|| panic!("no table {table}"));
            let property = properties.get(*key).unwrap_or_else(|| panic!("no key {key} in {table}"));
            for (keyword, bound) in *bounds {
                assert_eq!(property.get(*keyword), Some(&json!(bound)), "{table}.{key}");
            }
        }
    }

    #[test]
    fn every_unit_and_every_example_belongs_to_a_key() {
        let mut schema = complete().clone();
        for (table, key, unit) in words::UNITS {
            let property = &properties_of(&mut schema, table).unwrap_or_else(|| panic!("no table {table}"))[*key];
            let said = property["description"].as_str().unwrap_or_default();
            assert_eq!(said.matches(&format!("[{unit}]")).count(), 1, "{table}.{key} states its unit already: {said}");
        }
        let units = words::UNITS.iter().map(|(table, key, _)| (*table, *key));
        for (table, key) in units.chain(words::examples().into_iter().map(|(table, key, _)| (table, key))) {
            let properties = properties_of(&mut schema, table).unwrap_or_else(|| panic!("no table {table}"));
            assert!(properties.contains_key(key), "no key {key} in {table}");
        }
    }

    #[test]
    fn a_variant_may_leave_out_what_a_complete_file_must_state() {
        let file = schema();
        let definitions = file["$defs"].to_string();
        assert!(!definitions.contains("required"), "{definitions}");
        let [variant, whole] = file["anyOf"].as_array().expect("two cases").as_slice() else { panic!("two cases") };
        assert_eq!(variant, &json!({ "required": ["extends"] }));
        assert_eq!(whole["not"], *variant);
        assert_eq!(whole["required"], complete()["required"]);
        let vehicle = &whole["properties"]["vehicle"]["items"];
        assert_eq!(vehicle["required"], json!(["name", "start"]));
        assert_eq!(vehicle["properties"]["start"]["required"], json!(["x_m", "y_m", "speed_mps"]));
        assert_eq!(vehicle["properties"]["driver"]["required"], json!(["kind"]));
    }
}
