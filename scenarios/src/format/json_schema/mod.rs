//! The JSON Schema of a scenario file, which editors use for completion and the loader for checks.
//!
//! It is generated from [`ScenarioFile`](crate::ScenarioFile). The field of a setting states its description, type and default, and as
//! `schemars` attributes its bounds, its example, and
//!
//! - `x-unit`: the unit of a number whose key does not end with one ([`interplay_common::units`]),
//! - `x-excludes`: keys that may not stand beside it,
//! - `x-concerns`: `vehicles` or `building`, for keys that mean nothing without them,
//! - `x-mechanism`: the mechanism of a planner that it switches off, with the value that does so,
//! - `x-paths`: its keys are paths of other settings,
//! - `x-radians`: the key in radians whose value it gives in degrees (`twins`),
//! - `x-merge-by`: the key by which a variant's entries of a list are merged with its parent's.
//!
//! The schema of a registry describes a whole scenario, including all that it extends. [`of_file`] describes one file, which may omit
//! required keys that its parent states.

mod node;

use interplay_common::json_schema::kind_of;
use interplay_common::units::unit_of;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value as Json, json};

pub(crate) use node::{Concern, SchemaNode, TWIN_OF, in_degrees, rounded};

/// The schema of a type of files, as the check reads it.
pub(crate) fn generated<T: JsonSchema>() -> Json {
    generated_with::<T, 0>(|_| [])
}

/// The same with further kinds; `foreign` returns their schemas, each list with the name of the definition that it extends.
pub(crate) fn generated_with<T: JsonSchema, const N: usize>(
    foreign: impl FnOnce(&mut SchemaGenerator) -> [(&'static str, Vec<Json>); N],
) -> Json {
    let mut generator = SchemaSettings::draft2020_12().into_generator();
    let mut schema = generator.root_schema_for::<T>().to_value();
    let foreign = foreign(&mut generator);
    if let Some(definitions) = schema["$defs"].as_object_mut() {
        for (name, definition) in generator.take_definitions(true) {
            definitions.entry(name).or_insert(definition);
        }
    }
    for (definition, further) in foreign {
        if let Some(kinds) = schema["$defs"][definition]["oneOf"].as_array_mut() {
            kinds.extend(further);
        }
    }
    polish(&mut schema);
    schema
}

/// The schema of one file, which need not repeat what it extends; `whole` is that of a whole scenario.
pub(crate) fn of_file(whole: &Json) -> Json {
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

/// What `$ref` refers to, if there is one.
fn resolved<'a>(root: &'a Json, schema: &'a Json) -> &'a Json {
    let name = schema.get("$ref").and_then(Json::as_str).and_then(|path| path.strip_prefix("#/$defs/"));
    name.and_then(|name| root.get("$defs")?.get(name)).unwrap_or(schema)
}

/// Adapts the schema to TOML and to readers: no nulls, which TOML cannot write; descriptions without the escapes of doc
/// comments; one for each `kind`; and units.
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
            if let Some(properties) = object.get_mut("properties").and_then(Json::as_object_mut) {
                properties.iter_mut().for_each(|(key, property)| state_unit(key, property));
                node::add_twins(properties);
                state_exclusions(properties);
            }
        }
        Json::Array(items) => items.iter_mut().for_each(polish),
        _ => {}
    }
}

/// Gives a number its unit, as `x-unit` and at the end of its description.
fn state_unit(key: &str, property: &mut Json) {
    let is_number = |schema: &Json| schema.get("type").is_some_and(|word| word == "number");
    if !is_number(property) && !property.get("items").is_some_and(is_number) {
        return;
    }
    let stated = property.get("x-unit").and_then(Json::as_str).or_else(|| unit_of(key));
    let Some(unit) = stated.map(str::to_owned) else { return };
    if let Some(Json::String(description)) = property.get_mut("description")
        && !description.contains('[')
    {
        *description = format!("{} [{unit}].", description.trim_end_matches('.'));
    }
    property["x-unit"] = json!(unit);
}

/// Adds to the description of a key which others may not stand beside it.
fn state_exclusions(properties: &mut Map<String, Json>) {
    let excluded = |property: &Json| property.get("x-excludes").and_then(Json::as_array).cloned().unwrap_or_default();
    let pairs: Vec<(String, String)> = properties
        .iter()
        .flat_map(|(one, property)| excluded(property).into_iter().map(|other| (one.clone(), other)))
        .filter_map(|(one, other)| Some((one, other.as_str()?.to_owned())))
        .collect();
    for (key, property) in properties {
        let beside = |(one, other): &(String, String)| {
            let other = if one == key { Some(other) } else { Some(one).filter(|_| other == key) };
            other.map(|other| format!("`{other}`"))
        };
        let others: Vec<String> = pairs.iter().filter_map(beside).collect();
        if let Some(Json::String(description)) = property.get_mut("description").filter(|_| !others.is_empty()) {
            let (last, before) =
                others.split_last().map_or((String::new(), &others[..]), |(last, b)| (last.clone(), b));
            let separator = if before.is_empty() { "" } else { " or " };
            *description += &format!(" Not together with {}{separator}{last}.", before.join(", "));
        }
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

/// The skeleton of a schema: only its required keys, and the tables below it.
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
    fn a_description_of_a_key_states_its_unit_once() {
        let mut schema = json!({ "properties": {
            "speed_mps": { "type": "number", "description": "How fast it drives." },
            "gap_m": { "type": "number", "description": "Gap to the next \\[m\\]; 0 is none." },
            "weight": { "type": "number", "description": "What it costs.", "x-unit": "1/m²" },
        } });
        polish(&mut schema);
        let property = |key: &str| schema["properties"][key].clone();
        assert_eq!(property("speed_mps")["description"], "How fast it drives [m/s].");
        assert_eq!(property("gap_m")["description"], "Gap to the next [m]; 0 is none.");
        assert_eq!(property("weight")["description"], "What it costs [1/m²].");
        assert_eq!((&property("gap_m")["x-unit"], &property("weight")["x-unit"]), (&json!("m"), &json!("1/m²")));
    }
}
